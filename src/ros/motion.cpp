#include "screwline/ros/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "screwline/exception.h"
#include "screwline/trajectory/state_to_state.h"
#include "screwline/trajectory/verify.h"

namespace screwline {
namespace ros_bridge {
namespace {

constexpr double kRest = 1e-9;  // rad/s (m/s) and per s^2

MotionState stateAtRest(const VectorX& position) {
  return {position, VectorX::Zero(position.size()), VectorX::Zero(position.size())};
}

VectorX endOf(const JointTrajectory& trajectory) {
  TrajectoryPoint point(trajectory.joints());
  trajectory.sample(trajectory.duration(), point);
  return point.position;
}

/// Position bounds as given trajectories are held to them: a place that is only rounded past a bound is in reach.
Limits roomy(Limits limits) {
  limits.lower.array() -= kSamePlace;
  limits.upper.array() += kSamePlace;
  return limits;
}

/// What the limits are where the state itself is beyond them: it is brought back, and until then exceeds them.
Limits widenedTo(const JointTrajectory& lead, const MotionState& present, Limits limits) {
  for (int j = 0; j < limits.joints(); ++j) {
    const EndState start{present.position[j], present.velocity[j], present.acceleration[j]};
    if (checkState(start, axisLimits(limits, j), true).fault == StateFault::kNone) continue;
    const JointExtrema extrema = lead.extrema(j);
    limits.velocity[j] = std::max(limits.velocity[j], extrema.velocity);
    limits.acceleration[j] = std::max(limits.acceleration[j], std::abs(present.acceleration[j]));
  }
  return limits;
}

JointTrajectory bridge(const MotionState& present, const MotionState& goal, const Limits& limits) {
  const Limits bounds = roomy(limits);
  JointTrajectory lead = timeOptimalBridge(present, goal, bounds);
  const auto broken = verifyTrajectory(lead, widenedTo(lead, present, bounds),
                                       {{0.0, present.position}, {lead.duration(), goal.position}});
  if (broken) throw Exception("internal error: the way from the present state failed its check: " + *broken);
  return lead;
}

/// The lead, or none where the limits allow none.
std::optional<JointTrajectory> leadTo(const MotionState& goal, const MotionState& present, const Limits& limits) {
  try {
    return bridge(present, goal, limits);
  } catch (const InputError& error) {
    if (error.code() != AnswerCode::kLimitsInfeasible) throw;
    return std::nullopt;
  }
}

Limits withoutJerk(Limits limits) {
  limits.jerk.setConstant(std::numeric_limits<double>::infinity());
  return limits;
}

}  // namespace

Motion Motion::resting(const VectorX& position) {
  PiecewisePolynomial rest(static_cast<int>(position.size()), 0, {0.0, 0.0}, 3);
  for (int j = 0; j < rest.joints; ++j) rest.at(0, 0, j) = position[j];
  return Motion(JointTrajectory::piecewise(std::move(rest)));
}

void Motion::sample(double t, TrajectoryPoint& point) const {
  if (t < lead_.duration()) {
    lead_.sample(t, point);
  } else {
    main_.sample(t < duration() ? t - lead_.duration() : main_.duration(), point);
  }
}

void Motion::sample(const PathInstant& instant, TrajectoryPoint& point) const {
  sample(instant.time, point);
  pace(instant, point);
}

std::optional<double> Motion::tau(double t) const {
  if (t < lead_.duration()) return std::nullopt;
  return t < duration() ? (t - lead_.duration()) / main_.duration() : 1.0;
}

bool isAtRest(const MotionState& state) {
  return state.velocity.isZero(kRest) && state.acceleration.isZero(kRest);
}

bool keepsPositions(const JointTrajectory& trajectory, const Limits& limits) {
  for (int j = 0; limits.lower.size() > 0 && j < trajectory.joints(); ++j) {
    const Range range = trajectory.extrema(j).position;
    if (range.lower < limits.lower[j] - kSamePlace || range.upper > limits.upper[j] + kSamePlace) return false;
  }
  return true;
}

Motion startFrom(const MotionState& present, const JointTrajectory& main, const Limits& limits) {
  TrajectoryPoint first(main.joints());
  main.sample(0.0, first);
  const bool at_rest = isAtRest(present);
  const bool there = (present.position - first.position).cwiseAbs().maxCoeff() <= kSamePlace;
  if (at_rest && there && !main.startsMoving()) return Motion(main);
  if (!at_rest || !first.velocity.isZero(kRest)) {
    const MotionState moving{first.position, first.velocity, first.acceleration};
    if (const auto lead = leadTo(moving, present, limits)) return {*lead, main};
  }
  return {bridge(present, stateAtRest(first.position), limits), main};
}

JointTrajectory stopFrom(const MotionState& present, const Limits& limits) {
  const JointTrajectory braking = stopTrajectory(present, limits);
  if (keepsPositions(braking, limits)) return braking;
  const VectorX goal = endOf(braking).cwiseMax(limits.lower).cwiseMin(limits.upper);
  if (const auto shorter = leadTo(stateAtRest(goal), present, limits)) return *shorter;
  const JointTrajectory hard = stopTrajectory(present, withoutJerk(limits));
  return keepsPositions(hard, limits) ? hard : braking;
}

}  // namespace ros_bridge
}  // namespace screwline
