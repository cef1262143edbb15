#ifndef SCREWLINE_TRAJECTORY_POINTS_H
#define SCREWLINE_TRAJECTORY_POINTS_H

#include <vector>

#include "screwline/trajectory/joint_trajectory.h"
#include "screwline/trajectory/stop.h"

namespace screwline {

/// One point of a trajectory_msgs/JointTrajectory in chain order; velocity and acceleration may be empty.
struct SampledPoint {
  VectorX position;
  VectorX velocity;
  VectorX acceleration;
  double time = 0.0;  ///< [s] time_from_start.
};

/// The motion that a controller makes of sampled points: straight lines where positions alone are given, cubics where
/// every point has velocities, quintics where every point has accelerations too (exact for a sampled 3-4-5 motion).
/// @param start where the robot is; needed where the first point is not at time 0: the motion then begins there. With a
/// first point at time 0 it is not read.
/// @throws InputError(kInvalidGoal) naming the field for: no points, sizes, values not finite or beyond 1e6, times that
/// do not increase, fields that some points have and others not; (kTooLarge) beyond a million points.
JointTrajectory trajectoryThrough(const std::vector<SampledPoint>& points, const MotionState* start = nullptr);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_POINTS_H
