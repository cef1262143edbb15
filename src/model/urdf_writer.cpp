#include <algorithm>
#include <cmath>

#include "screwline/exception.h"
#include "screwline/model/dh_reader.h"
#include "screwline/spatial/rotation.h"
#include "text.h"

namespace screwline {
namespace {

/// The shortest text that is read back as the same number.
std::string number(double value) {
  for (int digits = 15; digits < 17; ++digits) {
    const std::string text = numberText(value + 0.0, digits);
    if (numberOf(text) == value) return text;
  }
  return numberText(value, 17);
}

/// A value without the rounding of the frames that were multiplied: 0.1 for 0.09999999999999999, pi/2 for its
/// neighbours.
double tidy(double value) {
  constexpr double kFrameRounding = 1e-15;
  constexpr double kDecimals = 1e12;
  for (const double nearest :
       {std::round(value * kDecimals) / kDecimals, std::round(value / kPi * 12.0) * (kPi / 12.0)}) {
    if (std::abs(value - nearest) < kFrameRounding) return nearest;
  }
  return value;
}

std::string numbers(const Vector3& v) {
  return number(tidy(v.x())) + " " + number(tidy(v.y())) + " " + number(tidy(v.z()));
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

/// Turns about the fixed x, y, z axes. Roll is taken after yaw and pitch, so that the three give R back at pitch =
/// +-pi/2 too.
Vector3 rollPitchYaw(const Matrix3& R) {
  const double yaw = std::hypot(R(0, 0), R(1, 0)) < 1e-12 ? 0.0 : std::atan2(R(1, 0), R(0, 0));
  const double s = std::sin(yaw);
  const double c = std::cos(yaw);
  const double pitch = std::atan2(-R(2, 0), c * R(0, 0) + s * R(1, 0));
  const double roll = std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1));
  return {roll, pitch, yaw};
}

std::string origin(const Pose& X) {
  return "<origin xyz=\"" + numbers(X.p) + "\" rpy=\"" + numbers(rollPitchYaw(X.R)) + "\"/>";
}

/// The pose whose z axis points along the unit vector `direction`.
Pose along(const Vector3& direction, const Vector3& p) {
  Pose X{Matrix3::Identity(), p};
  X.R.col(2) = direction;
  X.R.col(0) = anyPerpendicular(direction);
  X.R.col(1) = direction.cross(X.R.col(0));
  return X;
}

double distanceToLine(const Axis& axis, const Vector3& p) {
  return (p - axis.point).cross(axis.direction).norm();
}

class UrdfWriter {
 public:
  explicit UrdfWriter(const SerialChain& chain) : chain_(chain), thickness_(0.06 * chain.characteristicLength()) {}

  std::string write() {
    out_ = "<?xml version=\"1.0\"?>\n<robot name=\"" + escaped(chain_.name()) + "\">\n";
    chooseCarriers();
    nameJoints();
    for (const Link& link : chain_.links()) {
      if (carriers_[static_cast<std::size_t>(link.axis_count)].name != link.name) writeFixed(link);
    }
    for (std::size_t i = 0; i < carriers_.size(); ++i) writeCarrier(i);
    for (std::size_t i = 0; i < chain_.axes().size(); ++i) writeJoint(i);
    return out_ + "</robot>\n";
  }

 private:
  /// One link after each axis carries the next joint and what is fixed to it. Its origin lies on the axis, as URDF
  /// asks; where no link of the chain does, one is made up.
  void chooseCarriers() {
    carriers_.push_back(*chain_.findLink(chain_.baseLink()));
    for (std::size_t i = 0; i < chain_.axes().size(); ++i) {
      const Axis& axis = chain_.axes()[i];
      const int count = static_cast<int>(i) + 1;
      const auto fits = [&](const Link& link) {
        const double tolerance = 1e-14 * std::max(1.0, link.home.p.norm());
        return link.axis_count == count && (axis.prismatic || distanceToLine(axis, link.home.p) <= tolerance);
      };
      const auto found = std::find_if(chain_.links().begin(), chain_.links().end(), fits);
      if (found != chain_.links().end()) {
        carriers_.push_back(*found);
      } else {
        carriers_.push_back({freeLinkName("axis_" + std::to_string(count)), count, along(axis.direction, axis.point)});
      }
    }
  }

  std::string freeLinkName(std::string name) const {
    while (chain_.findLink(name) != nullptr) name += "_";
    return name;
  }

  /// The first axis that moves just as a joint bears its name; the others mimic it.
  void nameJoints() {
    driver_.assign(chain_.joints().size(), -1);
    for (std::size_t i = 0; i < chain_.axes().size(); ++i) {
      const Axis& axis = chain_.axes()[i];
      const auto source = static_cast<std::size_t>(axis.source);
      const bool same = axis.multiplier == 1.0 && axis.prismatic != chain_.joints()[source].isRevolute();
      if (same && driver_[source] < 0) driver_[source] = static_cast<int>(i);
    }
    for (std::size_t j = 0; j < driver_.size(); ++j) {
      if (driver_[j] >= 0) continue;
      throw ModelError("joint '" + chain_.joints()[j].name + "': no axis moves as it does, URDF cannot say that");
    }
  }

  void writeFixed(const Link& link) {
    const Link& carrier = carriers_[static_cast<std::size_t>(link.axis_count)];
    out_ += "  <link name=\"" + escaped(link.name) + "\"/>\n";
    out_ += "  <joint name=\"" + escaped(freeJointName(link.name + "_fixed")) + "\" type=\"fixed\">\n";
    writePlace(carrier, link);
    out_ += "  </joint>\n";
  }

  void writePlace(const Link& parent, const Link& child) {
    out_ += "    <parent link=\"" + escaped(parent.name) + "\"/>\n    <child link=\"" + escaped(child.name) + "\"/>\n";
    out_ += "    " + origin(parent.home.inverse() * child.home) + "\n";
  }

  /// A link with a cylinder (revolute) or a box (prismatic) about its axis, and a bar to where the next axis or the tip
  /// is.
  void writeCarrier(std::size_t i) {
    const Link& link = carriers_[i];
    out_ += "  <link name=\"" + escaped(link.name) + "\">\n";
    if (i > 0) {
      const Axis& axis = chain_.axes()[i - 1];
      const std::string size = number(thickness_);
      const Pose X = link.home.inverse() * along(axis.direction, link.home.p);
      writeVisual(X, axis.prismatic ? "<box size=\"" + size + " " + size + " " + number(2.0 * thickness_) + "\"/>"
                                    : cylinder(0.5 * thickness_, 1.5 * thickness_));
    }
    const Vector3 end = i + 1 < carriers_.size() ? carriers_[i + 1].home.p : chain_.home().p;
    const Vector3 bar = link.home.inverse() * end;
    if (bar.norm() > 1e-9) {
      writeVisual(along(bar.normalized(), 0.5 * bar), cylinder(0.25 * thickness_, bar.norm()));
    }
    out_ += "  </link>\n";
  }

  static std::string cylinder(double radius, double length) {
    return "<cylinder radius=\"" + number(radius) + "\" length=\"" + number(length) + "\"/>";
  }

  void writeVisual(const Pose& X, const std::string& shape) {
    out_ += "    <visual>\n      " + origin(X) + "\n      <geometry>" + shape + "</geometry>\n    </visual>\n";
  }

  void writeJoint(std::size_t i) {
    const Axis& axis = chain_.axes()[i];
    const Joint& source = chain_.joint(axis.source);
    const bool drives = driver_[static_cast<std::size_t>(axis.source)] == static_cast<int>(i);
    const std::string type = drives                                  ? toString(source.type)
                             : axis.prismatic                        ? "prismatic"
                             : source.type == JointType::kContinuous ? "continuous"
                                                                     : "revolute";
    const std::string name = drives ? source.name : freeJointName(source.name + "_mimic_" + std::to_string(i + 1));
    out_ += "  <joint name=\"" + escaped(name) + "\" type=\"" + type + "\">\n";
    writePlace(carriers_[i], carriers_[i + 1]);
    out_ += "    <axis xyz=\"" + numbers(carriers_[i + 1].home.R.transpose() * axis.direction) + "\"/>\n";
    writeLimit(source.limits, drives ? 1.0 : axis.multiplier, type);
    if (!drives) {
      out_ += "    <mimic joint=\"" + escaped(source.name) + "\" multiplier=\"" + number(axis.multiplier) + "\"/>\n";
    }
    out_ += "  </joint>\n";
  }

  /// Effort is not known, and written 0. A mimic's bounds are a little wider than its source's, so that rounding takes
  /// nothing away.
  void writeLimit(const JointLimits& limits, double multiplier, const std::string& type) {
    const double slack = multiplier == 1.0 ? 0.0 : 1e-12;
    double lower = limits.lower * multiplier;
    double upper = limits.upper * multiplier;
    if (multiplier < 0.0) std::swap(lower, upper);
    lower = std::max(lower - slack * std::abs(lower), -kMaxMagnitude);
    upper = std::min(upper + slack * std::abs(upper), kMaxMagnitude);
    out_ += "    <limit ";
    if (type != "continuous") out_ += "lower=\"" + number(lower) + "\" upper=\"" + number(upper) + "\" ";
    out_ += "velocity=\"" + number(limits.velocity * std::abs(multiplier) * (1.0 + slack)) + "\" effort=\"0\"/>\n";
  }

  std::string freeJointName(std::string name) {
    const auto taken = [&](const Joint& joint) { return joint.name == name; };
    while (std::any_of(chain_.joints().begin(), chain_.joints().end(), taken)) name += "_";
    return name;
  }

  const SerialChain& chain_;
  const double thickness_;
  std::vector<Link> carriers_;  ///< After 0, 1, ... axes.
  std::vector<int> driver_;     ///< By joint: the axis that bears its name.
  std::string out_;
};

}  // namespace

std::string toUrdf(const SerialChain& chain) {
  return UrdfWriter(chain).write();
}

}  // namespace screwline
