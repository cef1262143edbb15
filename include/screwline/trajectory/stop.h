#ifndef SCREWLINE_TRAJECTORY_STOP_H
#define SCREWLINE_TRAJECTORY_STOP_H

#include "screwline/spatial/pose.h"
#include "screwline/trajectory/joint_trajectory.h"
#include "screwline/trajectory/limits.h"

namespace screwline {

/// Where a moving robot is: rad (or m), per s, per s^2; n values each.
struct MotionState {
  VectorX position;
  VectorX velocity;
  VectorX acceleration;
};

/// To rest, each joint in the shortest time that its jerk and acceleration limits allow: at most three phases of
/// constant jerk, closed form. An acceleration beyond its limit is brought back to it at full jerk first, a velocity
/// beyond its limit is left on the shortest way: both are the state's, and nothing is added to them. Without a jerk
/// limit the acceleration steps (C1); the other joints wait at rest. Ends where braking ends: no position is aimed at,
/// position bounds are the caller's to check.
/// @throws InputError for sizes, values that are not finite or beyond 1e6, or a moving joint with neither acceleration
/// nor jerk limit.
JointTrajectory stopTrajectory(const MotionState& state, const Limits& limits);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_STOP_H
