#ifndef SCREWLINE_TRAJECTORY_STATE_TO_STATE_H
#define SCREWLINE_TRAJECTORY_STATE_TO_STATE_H

#include <array>
#include <string>

#include "screwline/model/serial_chain.h"
#include "screwline/trajectory/axis_motion.h"
#include "screwline/trajectory/constant_jerk.h"
#include "screwline/trajectory/joint_trajectory.h"
#include "screwline/trajectory/stop.h"

namespace screwline {

/// Where up to kMaxJoints joints are, where they shall be, what they may do. rad (or m) and s. Fixed size: filled by
/// the caller, reused from one question to the next.
struct StateToState {
  int joints = 0;
  std::array<EndState, kMaxJoints> from;
  std::array<EndState, kMaxJoints> to;
  std::array<AxisLimits, kMaxJoints> limits;
  double least_duration = 0.0;  ///< [s] The motion takes at least this.
  bool straight = true;         ///< All joints on one line in joint space where that takes no longer.
};

enum class MotionStatus {
  kFound,
  kJoints,    ///< Their number is not 1 .. kMaxJoints.
  kLimits,    ///< A limit of a joint is not usable: lower < 0 < upper, jerk finite.
  kDuration,  ///< The least duration is NaN, infinite or negative.
  kStart,     ///< The start state of a joint is not finite.
  kGoal,      ///< The goal state of a joint cannot be reached within the limits.
  kPosition,  ///< A joint cannot stay within its position limits.
};

/// The motion of every joint over one duration, or what stands against it. Fixed size.
struct StateToStateMotion {
  MotionStatus status = MotionStatus::kFound;
  int joint = 0;                              ///< Which one, where the status is not kFound.
  StateCheck check;                           ///< Its value and the feasible range.
  double duration = 0.0;                      ///< [s] Of all joints.
  std::array<double, kMaxJoints> shortest{};  ///< [s] Of each joint by itself.
  bool straight = false;                      ///< Whether all joints keep to one line.
  int joints = 0;
  std::array<JerkPhases, kMaxJoints> phases;
  std::array<AxisMotion, kMaxJoints> axes;  ///< Each joint's problem after its braking: what durations it can have.
  std::array<double, kMaxJoints> braking;   ///< [s] Of each joint, before it.
  std::array<std::size_t, kMaxJoints> braking_phases;
  std::array<bool, kMaxJoints> goal_rests;
};

/// The shortest common motion from state to state: each joint's least duration, then the least common one outside of
/// every joint's blocked intervals, then a motion of each joint that takes exactly that. Positions keep their limits
/// where the request has them: another motion of the same duration, else a longer duration, is looked for.
/// A start outside velocity or acceleration limits (or bound to leave them) is first brought back as fast as the jerk
/// allows. Does not allocate or throw. Sources: Berscheid & Kroeger, arXiv 2105.04830, for the problem and its blocked
/// intervals; the solution is by extreme motions, see ExtremeMotion.
void moveStateToState(const StateToState& question, StateToStateMotion& motion);

/// One joint of symmetric limits, with its position bounds.
AxisLimits axisLimits(const Limits& limits, int joint);

/// What stands against the motion, "joint 2: goal velocity is 1.2, feasible is -1 to 1".
std::string describe(const StateToStateMotion& motion);

/// The same path `factor` times as slow. @pre factor >= 1: limits that are kept stay kept.
void slowDown(StateToStateMotion& motion, double factor);

/// The motion as polynomial pieces of degree 3 over the breakpoints of all joints, after those there are, if any.
/// @param end [s] where its end is known better than as a sum of durations; 0: that sum. Allocates. @pre kFound.
void appendPieces(const StateToStateMotion& motion, PiecewisePolynomial& pieces, double end = 0.0);
JointTrajectory trajectoryOf(const StateToStateMotion& motion);

/// The time-optimal C2 motion from a moving state to another (or to rest): a running motion is replaced. @throws
/// InputError(kLimitsInfeasible) with joint, value and feasible range; (kInvalidGoal) for sizes, values that are not
/// finite, jerk limits that are not.
JointTrajectory timeOptimalBridge(const MotionState& from, const MotionState& to, const Limits& limits);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_STATE_TO_STATE_H
