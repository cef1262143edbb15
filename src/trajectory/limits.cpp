#include "screwline/trajectory/limits.h"

#include <cmath>
#include <limits>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"

namespace screwline {
namespace {

const char* orderName(int order) {
  constexpr const char* kNames[] = {"position", "velocity", "acceleration", "jerk"};
  return kNames[order];
}

void requireSize(const VectorX& values, int joints, const std::string& field) {
  if (values.size() == joints) return;
  throw InputError(AnswerCode::kInvalidGoal, field + " has " + std::to_string(values.size()) +
                                                 " values, the robot has " + std::to_string(joints) + " joints");
}

void validatePositive(const VectorX& values, int joints, const std::string& field) {
  requireSize(values, joints, field);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (values[i] > 0.0) continue;
    throw InputError(AnswerCode::kInvalidGoal, indexed(field, static_cast<std::size_t>(i)) + " is " +
                                                   number(values[i]) + ", it must be positive");
  }
}

void requireFactor(double factor, const std::string& field) {
  if (factor > 0.0 && factor <= 1.0) return;
  throw InputError(AnswerCode::kInvalidGoal, field + " is " + number(factor) + ", it must lie in (0, 1]");
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
  validatePositive(limits.velocity, joints, "velocity_limits");
  validatePositive(limits.acceleration, joints, "acceleration_limits");
  validatePositive(limits.jerk, joints, "jerk_limits");
  if (limits.lower.size() == 0 && limits.upper.size() == 0) return;
  requireSize(limits.lower, joints, "lower position bound");
  requireSize(limits.upper, joints, "upper position bound");
  for (int i = 0; i < joints; ++i) {
    if (limits.lower[i] <= limits.upper[i]) continue;
    throw InputError(AnswerCode::kInvalidGoal, "joint " + std::to_string(i) + " has the position bounds " +
                                                   number(limits.lower[i]) + " to " + number(limits.upper[i]));
  }
}

Limits scaledLimits(const Limits& limits, double velocity_scaling, double acceleration_scaling, double jerk_scaling) {
  requireFactor(velocity_scaling, "velocity_scaling");
  requireFactor(acceleration_scaling, "acceleration_scaling");
  requireFactor(jerk_scaling, "jerk_scaling");
  Limits scaled = limits;
  scaled.velocity *= velocity_scaling;
  scaled.acceleration *= acceleration_scaling;
  scaled.jerk *= jerk_scaling;
  return scaled;
}

}  // namespace screwline
