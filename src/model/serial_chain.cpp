#include "screwline/model/serial_chain.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "screwline/exception.h"
#include "screwline/spatial/screw.h"

namespace screwline {
namespace {

constexpr double kUnitTolerance = 1e-9;

std::string text(double value) {
  std::ostringstream out;
  out.precision(12);
  out << value;
  return out.str();
}

void require(bool holds, const std::string& message) {
  if (!holds) throw ModelError(message);
}

bool isBounded(const Pose& X) {
  return X.R.allFinite() && X.p.allFinite() && X.p.cwiseAbs().maxCoeff() <= kMaxMagnitude;
}

void checkLimits(const Joint& joint) {
  const JointLimits& limits = joint.limits;
  const std::string who = "joint '" + joint.name + "': ";
  require(!std::isnan(limits.lower) && !std::isnan(limits.upper), who + "position limits are not numbers");
  require(limits.lower <= limits.upper,
          who + "lower limit " + text(limits.lower) + " is above upper limit " + text(limits.upper));
  const std::pair<const char*, double> rates[] = {
      {"velocity", limits.velocity}, {"acceleration", limits.acceleration}, {"jerk", limits.jerk}};
  for (const auto& [what, value] : rates)
    require(value > 0.0, who + what + " limit " + text(value) + " is not above 0");
}

void checkJoints(const ChainDescription& description) {
  const std::size_t count = description.joints.size();
  const std::string who = "chain '" + description.name + "': ";
  require(count > 0,
          who + "no moving joint between '" + description.base_link + "' and '" + description.tip_link + "'");
  require(count <= kMaxJoints && description.axes.size() <= kMaxJoints,
          who + std::to_string(std::max(count, description.axes.size())) + " joints, at most " +
              std::to_string(kMaxJoints) + " are served");
  std::set<std::string> names;
  for (const Joint& joint : description.joints) {
    require(!joint.name.empty(), who + "a joint has no name");
    require(names.insert(joint.name).second, who + "joint name '" + joint.name + "' is repeated");
    checkLimits(joint);
  }
}

void checkAxes(const ChainDescription& description) {
  std::set<int> driven;
  for (std::size_t i = 0; i < description.axes.size(); ++i) {
    const Axis& axis = description.axes[i];
    require(axis.source >= 0 && axis.source < static_cast<int>(description.joints.size()),
            "axis " + std::to_string(i) + ": no joint drives it");
    const Joint& joint = description.joints[static_cast<std::size_t>(axis.source)];
    const std::string who = "joint '" + joint.name + "': ";
    require(axis.direction.allFinite() && std::abs(axis.direction.norm() - 1.0) <= kUnitTolerance,
            who + "axis is not a unit vector");
    require(axis.point.allFinite() && axis.point.cwiseAbs().maxCoeff() <= kMaxMagnitude,
            who + "axis position is not finite or beyond " + text(kMaxMagnitude) + " m");
    require(std::isfinite(axis.multiplier) && axis.multiplier != 0.0, who + "multiplier is 0 or not finite");
    driven.insert(axis.source);
  }
  require(driven.size() == description.joints.size(), "chain '" + description.name + "': a joint drives no axis");
}

double lengthOf(const ChainDescription& description) {
  double length = 1e-6;
  Vector3 previous = description.axes.front().point;
  for (const Axis& axis : description.axes) {
    if (axis.prismatic) continue;
    length = std::max(length, (axis.point - previous).norm());
    previous = axis.point;
  }
  return std::max(length, (description.home.p - previous).norm());
}

Matrix6X screwAxesOf(const ChainDescription& description) {
  Matrix6X screws = Matrix6X::Zero(6, static_cast<Eigen::Index>(description.joints.size()));
  for (const Axis& axis : description.axes) {
    screws.col(axis.source) +=
        axis.multiplier * (axis.prismatic ? prismaticScrew(axis.direction) : revoluteScrew(axis.direction, axis.point));
  }
  return screws;
}

}  // namespace

const char* toString(JointType type) {
  switch (type) {
    case JointType::kRevolute:
      return "revolute";
    case JointType::kContinuous:
      return "continuous";
    case JointType::kPrismatic:
      return "prismatic";
  }
  return "unknown";
}

SerialChain::SerialChain(ChainDescription description) : description_(std::move(description)) {
  checkJoints(description_);
  checkAxes(description_);
  require(isBounded(description_.home),
          "chain '" + description_.name + "': the tip's pose is not finite or beyond " + text(kMaxMagnitude) + " m");
  for (const Link& link : description_.links) {
    require(
        isBounded(link.home) && link.axis_count >= 0 && link.axis_count <= static_cast<int>(description_.axes.size()),
        "link '" + link.name + "': its pose is not finite, or it hangs on no axis");
  }
  require(findLink(description_.tip_link) != nullptr,
          "chain '" + description_.name + "': tip link '" + description_.tip_link + "' is not one of its links");
  // Without a mimic, the k-th axis belongs to the k-th joint; IK and the golden conventions rely on it.
  has_mimic_ = description_.axes.size() != description_.joints.size();
  for (std::size_t i = 0; !has_mimic_ && i < description_.axes.size(); ++i) {
    has_mimic_ = description_.axes[i].source != static_cast<int>(i) || description_.axes[i].multiplier != 1.0;
  }
  kernel_ = compileChain(description_.axes, description_.home);
  screw_axes_ = screwAxesOf(description_);
  characteristic_length_ = lengthOf(description_);
  if (!description_.dh) description_.dh = modifiedDhOf(description_.axes, description_.home);
}

std::vector<std::string> SerialChain::jointNames() const {
  std::vector<std::string> names;
  for (const Joint& joint : joints()) names.push_back(joint.name);
  return names;
}

const Link* SerialChain::findLink(const std::string& link_name) const {
  const auto found =
      std::find_if(links().begin(), links().end(), [&](const Link& link) { return link.name == link_name; });
  return found == links().end() ? nullptr : &*found;
}

VectorX SerialChain::lower() const {
  VectorX bound(size());
  for (int i = 0; i < size(); ++i) bound[i] = joint(i).limits.lower;
  return bound;
}

VectorX SerialChain::upper() const {
  VectorX bound(size());
  for (int i = 0; i < size(); ++i) bound[i] = joint(i).limits.upper;
  return bound;
}

VectorX SerialChain::clamped(const VectorX& q) const {
  return q.cwiseMax(lower()).cwiseMin(upper());
}

ChainDescription SerialChain::description() const {
  ChainDescription description = description_;
  description.dh.reset();
  return description;
}

SerialChain SerialChain::withTip(const Link& link) const {
  ChainDescription description = description_;
  require(link.axis_count == static_cast<int>(axes().size()),
          "link '" + link.name + "' is not rigidly beyond the last joint '" + joints().back().name + "'");
  description.tip_link = link.name;
  description.home = link.home;
  if (description.dh) {
    description.dh->tool_transform = description.dh->tool_transform * (home().inverse() * link.home);
  }
  return SerialChain(std::move(description));
}

void requireConfiguration(const SerialChain& chain, const ConstVectorRef& q, const std::string& field) {
  if (q.size() != chain.size()) {
    throw InputError(AnswerCode::kInvalidRobotState, field + " has " + std::to_string(q.size()) + " values, chain '" +
                                                         chain.name() + "' has " + std::to_string(chain.size()) +
                                                         " joints");
  }
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (std::isfinite(q[i]) && std::abs(q[i]) <= kMaxMagnitude) continue;
    throw InputError(AnswerCode::kInvalidRobotState, field + " of joint '" + chain.joint(static_cast<int>(i)).name +
                                                         "' is " + text(q[i]) + ", it must be finite and at most " +
                                                         text(kMaxMagnitude) + " in magnitude");
  }
}

}  // namespace screwline
