#ifndef SCREWLINE_TEST_UNIT_QUINTIC_BRIDGE_H
#define SCREWLINE_TEST_UNIT_QUINTIC_BRIDGE_H

#include <algorithm>
#include <cmath>
#include <optional>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/hermite.h"
#include "screwline/trajectory/stop.h"

namespace screwline {
namespace trajectory_test {

inline bool keeps(const LimitUse& use) {
  return use.value <= use.bound * (1.0 + kLimitTolerance);
}

inline bool keepsBounds(const JointTrajectory& trajectory, const Limits& limits) {
  for (int j = 0; limits.lower.size() > 0 && j < trajectory.joints(); ++j) {
    const Range range = trajectory.extrema(j).position;
    if (range.lower < limits.lower[j] - kLimitTolerance || range.upper > limits.upper[j] + kLimitTolerance)
      return false;
  }
  return true;
}

inline JointTrajectory quintic(const MotionState& from, const MotionState& to, double duration) {
  PiecewisePolynomial motion(static_cast<int>(from.position.size()), 5, {0.0, duration}, 2);
  motion.starts_at_rest = from.velocity.isZero(0.0) && from.acceleration.isZero(0.0);
  motion.ends_at_rest = to.velocity.isZero(0.0) && to.acceleration.isZero(0.0);
  for (int j = 0; j < motion.joints; ++j) {
    const EndState first{from.position[j], from.velocity[j], from.acceleration[j]};
    const EndState last{to.position[j], to.velocity[j], to.acceleration[j]};
    motion.setPiece(0, j, quinticBetween(first, last, duration));
  }
  return JointTrajectory::piecewise(std::move(motion));
}

/// No motion is quicker than full speed over the longest way, or a full jerk to a changed acceleration.
inline double lowestDuration(const MotionState& from, const MotionState& to, const Limits& limits) {
  double lowest = 0.0;
  for (int j = 0; j < limits.joints(); ++j) {
    lowest = std::max(lowest, std::abs(to.position[j] - from.position[j]) / limits.velocity[j]);
    lowest = std::max(lowest, std::abs(to.velocity[j] - from.velocity[j]) / limits.acceleration[j]);
    lowest = std::max(lowest, std::abs(to.acceleration[j] - from.acceleration[j]) / limits.jerk[j]);
  }
  return lowest;
}

/// The shortest quintic found below `longest`; feasible durations need not form one interval, so the scan is fine and
/// upward.
inline std::optional<JointTrajectory> shortestQuintic(const MotionState& from, const MotionState& to,
                                                      const Limits& limits, double longest) {
  constexpr double kStep = 1.03;
  const auto feasible = [&](double duration) {
    const JointTrajectory trajectory = quintic(from, to, duration);
    return keeps(tightestUse(trajectory, limits)) && keepsBounds(trajectory, limits);
  };
  double upper = std::max(lowestDuration(from, to, limits), 1e-3 * longest);
  while (!feasible(upper)) {
    upper *= kStep;
    if (upper > longest) return std::nullopt;
  }
  double lower = upper / kStep;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (lower + upper);
    (feasible(middle) ? upper : lower) = middle;
  }
  return quintic(from, to, upper);
}

inline MotionState mirroredInTime(const MotionState& state) {
  return {state.position, -state.velocity, state.acceleration};
}

inline JointTrajectory restToRest(const VectorX& start, const VectorX& goal, const Limits& limits) {
  const MotionState from{start, VectorX::Zero(start.size()), VectorX::Zero(start.size())};
  const MotionState to{goal, from.velocity, from.velocity};
  double duration = tightestUse(quintic(from, to, 1.0), limits).stretch;
  if (duration == 0.0 && start != goal) {
    throw InputError(AnswerCode::kInvalidGoal, "no finite limit bounds the motion to the new start: give limits");
  }
  if (start != goal) duration = std::max(duration, kShortestTime);
  return quintic(from, to, duration);
}

/// Brake, move at rest to where the reversed braking of the goal begins, and follow that backwards: within limits
/// wherever the two brakings are.
inline JointTrajectory byWayOfRest(const MotionState& from, const MotionState& to, const Limits& limits) {
  const PiecewisePolynomial braking = *stopTrajectory(from, limits).pieces();
  const PiecewisePolynomial starting = reversed(*stopTrajectory(mirroredInTime(to), limits).pieces());
  TrajectoryPoint rest(limits.joints());
  JointTrajectory::piecewise(braking).sample(braking.duration(), rest);
  const VectorX start = rest.position;
  JointTrajectory::piecewise(starting).sample(0.0, rest);
  const PiecewisePolynomial move = *restToRest(start, rest.position, limits).pieces();
  return JointTrajectory::piecewise(concatenate(concatenate(braking, move), starting));
}

/// One C2 motion from a moving state to another, found otherwise than timeOptimalBridge(): a quintic per joint over one
/// common duration by an upward search, or braking to rest, a 3-4-5 move and the reverse of braking, whichever is
/// shorter. @throws InputError(kLimitsInfeasible) where neither keeps the limits.
inline JointTrajectory quinticBridge(const MotionState& from, const MotionState& to, const Limits& limits) {
  const JointTrajectory detour = byWayOfRest(from, to, limits);
  const bool detour_keeps = keeps(tightestUse(detour, limits)) && keepsBounds(detour, limits);
  // Where braking itself overshoots a limit, a quintic may still exist; it is looked for within ten times that way.
  const double longest = detour.duration() * (detour_keeps ? 1.0 : 10.0);
  if (longest > 0.0) {
    if (auto direct = shortestQuintic(from, to, limits, longest)) return *direct;
  }
  if (detour_keeps) return detour;
  const LimitUse use = tightestUse(detour, limits);
  const std::string why = keeps(use) ? "position leaves the joint limits on every way found" : describe(use);
  throw InputError(AnswerCode::kLimitsInfeasible, "no motion from the current state within the limits: " + why);
}

}  // namespace trajectory_test
}  // namespace screwline

#endif  // SCREWLINE_TEST_UNIT_QUINTIC_BRIDGE_H
