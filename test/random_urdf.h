#ifndef SCREWLINE_TEST_RANDOM_URDF_H
#define SCREWLINE_TEST_RANDOM_URDF_H

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "property/model_random.h"

namespace screwline {
namespace test {

/// A random URDF document with a chain of 1 to 8 moving joints between the links "first" and "last": general geometry,
/// or special in the ways that arms are (axes parallel, at right angles, meeting, in line, lengths of zero, spherical
/// groups), with fixed and mimic joints, joint names and elements in any order, other links beside.
class RandomUrdf {
 public:
  static constexpr int kStyles = 7;

  explicit RandomUrdf(unsigned seed) : random_(seed) {
    const int count = random_.integer(1, 8);
    style_ = random_.integer(0, kStyles - 1);
    has_mimic_ = random_.chance(0.12);
    Pose base;
    if (random_.chance(0.4)) base = random_.pose();
    for (Axis& axis : axes(count)) {
      axis.direction = (base.R * axis.direction).normalized();
      axis.point = base * axis.point;
      addMovingJoint(axis);
    }
    for (int k = random_.integer(0, 2); k > 0; --k) addFixedJoint(at_ * random_.pose());
    finish();
  }

  const std::string& text() const { return text_; }
  /// Degrees of freedom, first to last.
  const std::vector<std::string>& names() const { return names_; }
  bool hasMimic() const { return !mimics_.empty(); }
  std::string style() const {
    static const char* const names[kStyles] = {"general",     "special pairs",  "lattice", "spherical group",
                                               "two spheres", "parallel group", "planar"};
    return names[style_];
  }
  RandomModel& random() { return random_; }

  /// Value of any joint of the document, a mimic one included, where names()[i] has value q[i].
  double valueOf(const std::string& joint, const VectorX& q) const {
    const auto mimic = mimics_.find(joint);
    if (mimic != mimics_.end())
      return mimic->second.multiplier * valueOf(mimic->second.source, q) + mimic->second.offset;
    const auto place = std::find(names_.begin(), names_.end(), joint) - names_.begin();
    return q[place];
  }

 private:
  struct Mimic {
    std::string source;
    double multiplier = 1.0;
    double offset = 0.0;
  };

  static std::string numbers(const Vector3& v) {
    std::ostringstream out;
    out.precision(17);
    out << v.x() << " " << v.y() << " " << v.z();
    return out.str();
  }

  /// Roll, pitch, yaw; exact to rounding at a pitch of pi/2 as well.
  static Vector3 rpyOf(const Matrix3& R) {
    const double sine = std::hypot(R(0, 0), R(1, 0));
    const double yaw = sine > 1e-12 ? std::atan2(R(1, 0), R(0, 0)) : 0.0;
    const Matrix3 rest = rotationAbout(Vector3::UnitZ(), -yaw) * R;
    return {std::atan2(-rest(1, 2), rest(1, 1)), std::atan2(-R(2, 0), sine), yaw};
  }

  std::string freshName(const std::string& what) {
    static const char* const words[] = {"shoulder", "arm", "z", "Wrist", "lift_", "a.b", "joint-", "roll"};
    return words[random_.integer(0, 7)] + what + std::to_string(random_.integer(0, 999)) + "_" +
           std::to_string(elements_.size());
  }

  double step() { return random_.chance(0.4) ? 0.0 : 0.1 * random_.integer(-5, 5); }
  Vector3 latticeDirection() { return (random_.chance(0.5) ? 1.0 : -1.0) * Vector3::Unit(random_.integer(0, 2)); }

  Axis latticeAxis(const Vector3& from) {
    Axis axis;
    axis.prismatic = random_.chance(0.15);
    axis.direction = latticeDirection();
    axis.point = from + Vector3(step(), step(), step());
    return axis;
  }

  /// Turns through one point, neighbours not parallel.
  void appendSphere(const Vector3& center, std::size_t count, std::vector<Axis>& axes) {
    const bool square = random_.chance(0.6);
    Vector3 direction = random_.chance(0.5) ? latticeDirection() : random_.direction();
    const Vector3 first = direction;
    for (std::size_t i = 0; i < count; ++i) {
      Axis axis;
      axis.direction = direction;
      axis.point = center;
      axes.push_back(axis);
      const Vector3 across = anyPerpendicular(direction);
      direction = square ? (i % 2 == 1 ? first : across)
                         : Vector3(across + random_.uniform(-1.5, 1.5) * direction).normalized();
    }
  }

  void appendParallel(const Vector3& from, std::size_t count, std::vector<Axis>& axes) {
    Axis axis;
    axis.direction = random_.chance(0.5) ? latticeDirection() : random_.direction();
    axis.point = from;
    for (std::size_t i = 0; i < count; ++i) {
      axes.push_back(axis);
      axes.back().prismatic = random_.chance(0.1);
      if (random_.chance(0.3)) axes.back().direction = -axis.direction;
      const Vector3 across = anyPerpendicular(axis.direction);
      axis.point += random_.uniform(0.2, 0.7) * (rotationAbout(axis.direction, random_.uniform(-kPi, kPi)) * across);
    }
  }

  std::vector<Axis> planarAxes(std::size_t count) {
    std::vector<Axis> result;
    Vector3 point = Vector3::Zero();
    const int normal = random_.integer(0, 2);
    for (std::size_t i = 0; i < count; ++i) {
      Axis axis;
      axis.prismatic = random_.chance(0.3);
      axis.direction =
          random_.chance(axis.prismatic ? 0.3 : 1.0) ? Vector3::Unit(normal) : Vector3::Unit((normal + 1) % 3);
      axis.point = point;
      point += Vector3(step(), step(), step());
      result.push_back(axis);
    }
    return result;
  }

  std::vector<Axis> axes(int joints) {
    const auto count = static_cast<std::size_t>(joints);
    if (style_ == 0) {
      std::vector<Axis> result(count);
      for (Axis& axis : result) {
        axis.prismatic = random_.chance(0.15);
        axis.direction = random_.direction();
        axis.point = random_.point();
      }
      return result;
    }
    if (style_ == 1) return random_.axes(joints);
    if (style_ == 6) return planarAxes(count);
    std::vector<Axis> result;
    const std::size_t group = std::min<std::size_t>(3, count);
    const auto place = static_cast<std::size_t>(random_.integer(0, static_cast<int>(count - group)));
    const bool general = random_.chance(0.4);
    while (result.size() < count) {
      const Vector3 from = result.empty() ? Vector3::Zero() : result.back().point;
      const bool at_end = result.size() + group == count;
      if (style_ == 3 && result.size() == place) {
        appendSphere(from + Vector3(step(), step(), step()), group, result);
      } else if (style_ == 4 && (result.empty() || at_end)) {
        appendSphere(from + Vector3(step(), step(), step()), group, result);
      } else if (style_ == 5 && result.size() == place) {
        appendParallel(from, group, result);
      } else if (general && style_ != 2) {
        result.push_back({random_.chance(0.1), random_.direction(), random_.point(), 0, 1.0});
      } else {
        result.push_back(latticeAxis(from));
      }
    }
    return result;
  }

  /// Links: the frame of the next one, which lies on the axis anywhere and turned anyhow.
  void addMovingJoint(const Axis& axis) {
    if (random_.chance(0.15)) addFixedJoint(at_ * random_.pose());
    Pose X;
    if (random_.chance(0.5)) {
      X.R = frameAlong(axis.direction);
    } else {
      X.R = random_.pose().R;
    }
    X.p = axis.point;
    if (random_.chance(0.2)) X.p += random_.uniform(-0.5, 0.5) * axis.direction;
    const std::string name = freshName("J");
    const Vector3 local = X.R.transpose() * axis.direction;
    std::string inside = "<axis xyz=\"" + numbers(random_.chance(0.3) ? Vector3(3.0 * local) : local) + "\"/>";
    const bool driven = has_mimic_ && !names_.empty() && random_.chance(0.3);
    const bool endless = !axis.prismatic && random_.chance(0.3);
    if (!endless) inside += limits(axis.prismatic);
    if (driven) {
      Mimic mimic;
      mimic.source = names_[static_cast<std::size_t>(random_.integer(0, static_cast<int>(names_.size()) - 1))];
      mimic.multiplier = random_.chance(0.5) ? -1.0 : 0.5 * random_.integer(1, 3);
      mimic.offset = 0.25 * random_.integer(-1, 1);
      std::ostringstream out;
      out << "<mimic joint=\"" << mimic.source << "\" multiplier=\"" << mimic.multiplier << "\" offset=\""
          << mimic.offset << "\"/>";
      inside += out.str();
      mimics_[name] = mimic;
    } else {
      names_.push_back(name);
    }
    addJoint(name, axis.prismatic ? "prismatic" : endless ? "continuous" : "revolute", X, inside);
  }

  /// A driven joint must not narrow its driver to nothing: its own range is wide.
  std::string limits(bool prismatic) {
    double lower = prismatic ? random_.uniform(-0.5, 0.0) : random_.uniform(-kPi, -0.5);
    double upper = prismatic ? random_.uniform(0.2, 0.8) : random_.uniform(0.5, kPi);
    if (has_mimic_) lower = -(upper = 40.0);
    if (!prismatic && random_.chance(0.15)) lower = -(upper = kTwoPi);
    std::ostringstream out;
    out.precision(17);
    out << "<limit lower=\"" << lower << "\" upper=\"" << upper << "\" velocity=\"1.5\" effort=\"10\"/>";
    return out.str();
  }

  Matrix3 frameAlong(const Vector3& z) {
    Matrix3 R;
    R.col(2) = z;
    R.col(0) = anyPerpendicular(z);
    R.col(1) = z.cross(R.col(0));
    return R;
  }

  void addFixedJoint(const Pose& X) { addJoint(freshName("F"), "fixed", X, ""); }

  void addJoint(const std::string& name, const std::string& type, const Pose& X, const std::string& inside) {
    const Pose origin = at_.inverse() * X;
    const std::string child = freshName("link");
    elements_.push_back("<joint type=\"" + type + "\" name=\"" + name + "\"><origin rpy=\"" + numbers(rpyOf(origin.R)) +
                        "\" xyz=\"" + numbers(origin.p) + "\"/><parent link=\"" + link_ + "\"/><child link=\"" + child +
                        "\"/>" + inside + "</joint>");
    elements_.push_back("<link name=\"" + child + "\"/>");
    at_ = X;
    link_ = child;
    if (random_.chance(0.1)) {
      const std::string side = freshName("side");
      elements_.push_back("<link name=\"" + side + "\"/><joint name=\"" + side +
                          "\" type=\"continuous\"><parent link=\"" + child + "\"/><child link=\"" + side +
                          "\"/></joint>");
    }
  }

  void finish() {
    elements_.push_back("<link name=\"first\"/>");
    elements_.push_back("<link name=\"last\"/><joint name=\"end\" type=\"fixed\"><parent link=\"" + link_ +
                        "\"/><child link=\"last\"/></joint>");
    for (std::size_t i = elements_.size() - 1; i > 0; --i)
      std::swap(elements_[i], elements_[static_cast<std::size_t>(random_.integer(0, static_cast<int>(i)))]);
    text_ = "<?xml version=\"1.0\"?>\n<robot name=\"random\">\n";
    for (const std::string& element : elements_) text_ += element + "\n";
    text_ += "</robot>\n";
  }

  RandomModel random_;
  int style_ = 0;
  bool has_mimic_ = false;
  Pose at_;
  std::string link_ = "first";
  std::vector<std::string> elements_;
  std::vector<std::string> names_;
  std::map<std::string, Mimic> mimics_;
  std::string text_;
};

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_RANDOM_URDF_H
