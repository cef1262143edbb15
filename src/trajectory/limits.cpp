#include "screwline/trajectory/limits.h"

#include <cmath>
#include <limits>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"

namespace screwline {
namespace {

constexpr char kLower[] = "lower_position_limits";
constexpr char kUpper[] = "upper_position_limits";

const char* orderName(int order) {
  constexpr const char* kNames[] = {"position", "velocity", "acceleration", "jerk"};
  return kNames[order];
}

void requireSize(const VectorX& values, int joints, const std::string& field) {
  if (values.size() == joints) return;
  throw InputError(AnswerCode::kInvalidGoal, field + " has " + std::to_string(values.size()) +
                                                 " values, the robot has " + std::to_string(joints) + " joints");
}

std::string limitRange() {
  return number(kLeastLimit) + " to " + number(kGreatestLimit) + ", or infinite";
}

void validateOrder(const VectorX& values, int joints, const std::string& field) {
  requireSize(values, joints, field);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (std::isinf(values[i]) && values[i] > 0.0) continue;
    if (values[i] >= kLeastLimit && values[i] <= kGreatestLimit) continue;
    throw InputError(AnswerCode::kInvalidGoal, indexed(field, static_cast<std::size_t>(i)) + " is " +
                                                   number(values[i]) + ", it must be positive: " + limitRange());
  }
}

void validateBound(const VectorX& values, double unreachable, const std::string& field) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i]) && values[i] != unreachable) continue;
    throw InputError(AnswerCode::kInvalidGoal, indexed(field, static_cast<std::size_t>(i)) + " is " +
                                                   number(values[i]) + ", it must be a number or " +
                                                   number(-unreachable) + " (none)");
  }
}

void requireFactor(double factor, const std::string& field) {
  if (factor > 0.0 && factor <= 1.0) return;
  throw InputError(AnswerCode::kInvalidGoal, field + " is " + number(factor) + ", it must lie in (0, 1]");
}

VectorX scaledOrder(const VectorX& values, double factor, const std::string& order) {
  const std::string scaling = order + "_scaling";
  requireFactor(factor, scaling);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (values[i] * factor >= kLeastLimit) continue;
    throw InputError(AnswerCode::kInvalidGoal, scaling + " is " + number(factor) + ", it brings " +
                                                   indexed(order + "_limits", static_cast<std::size_t>(i)) + " (" +
                                                   number(values[i]) + ") below the least of " + number(kLeastLimit));
  }
  return values * factor;
}

}  // namespace

Limits Limits::unlimited(int joints) {
  const VectorX none = VectorX::Constant(joints, std::numeric_limits<double>::infinity());
  return {none, none, none, {}, {}};
}

double Limits::bound(int joint, int order) const {
  if (order == 1) return velocity[joint];
  return order == 2 ? acceleration[joint] : jerk[joint];
}

LimitUse tightestUse(const JointTrajectory& trajectory, const Limits& limits) {
  LimitUse tightest;
  for (int joint = 0; joint < trajectory.joints(); ++joint) {
    const JointExtrema extrema = trajectory.extrema(joint);
    for (int order = 1; order <= 3; ++order) {
      const double peak = extrema.peak(order);
      const double bound = limits.bound(joint, order);
      if (!std::isfinite(peak)) continue;
      const double ratio = peak / bound;
      const double stretch = order == 1 ? ratio : order == 2 ? std::sqrt(ratio) : std::cbrt(ratio);
      if (stretch > tightest.stretch) tightest = {joint, order, peak, bound, stretch};
    }
  }
  return tightest;
}

std::string describe(const LimitUse& use) {
  return "joint " + std::to_string(use.joint) + " would reach " + orderName(use.order) + " " + number(use.value) +
         ", its limit is " + number(use.bound);
}

void validateLimits(const Limits& limits, int joints) {
  validateOrder(limits.velocity, joints, "velocity_limits");
  validateOrder(limits.acceleration, joints, "acceleration_limits");
  validateOrder(limits.jerk, joints, "jerk_limits");
  if (limits.lower.size() == 0 && limits.upper.size() == 0) return;
  requireSize(limits.lower, joints, kLower);
  requireSize(limits.upper, joints, kUpper);
  validateBound(limits.lower, std::numeric_limits<double>::infinity(), kLower);
  validateBound(limits.upper, -std::numeric_limits<double>::infinity(), kUpper);
  for (int i = 0; i < joints; ++i) {
    if (limits.lower[i] <= limits.upper[i]) continue;
    throw InputError(AnswerCode::kInvalidGoal,
                     indexed(kLower, static_cast<std::size_t>(i)) + " is " + number(limits.lower[i]) + ", above " +
                         indexed(kUpper, static_cast<std::size_t>(i)) + ", " + number(limits.upper[i]));
  }
}

Limits scaledLimits(const Limits& limits, double velocity_scaling, double acceleration_scaling, double jerk_scaling) {
  return {scaledOrder(limits.velocity, velocity_scaling, "velocity"),
          scaledOrder(limits.acceleration, acceleration_scaling, "acceleration"),
          scaledOrder(limits.jerk, jerk_scaling, "jerk"), limits.lower, limits.upper};
}

}  // namespace screwline
