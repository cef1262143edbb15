#ifndef SCREWLINE_TRAJECTORY_METRICS_H
#define SCREWLINE_TRAJECTORY_METRICS_H

#include <functional>

#include "screwline/spatial/pose.h"
#include "screwline/trajectory/limits.h"

namespace screwline {

/// Figures of a motion, one entry per joint, in rad (or m) and s; TrajectoryMetrics.msg. Exact: closed form from the
/// roots of the derivatives and integrals of polynomials, sines and cosines. Infinite where the order below steps (ends
/// joined to rest included): peak_acceleration, rms_acceleration and energy where velocity steps, peak_jerk and
/// jerk_integral where acceleration steps.
struct JointMetrics {
  VectorX peak_velocity;
  VectorX peak_acceleration;
  VectorX peak_jerk;
  VectorX acceleration_step;  ///< Largest step of the acceleration; 0 where it is continuous.
  VectorX rms_acceleration;   ///< sqrt(integral of squared acceleration / duration); 0 for no duration.
  VectorX jerk_integral;      ///< Integral of squared jerk.
  VectorX travel;             ///< Integral of |velocity|.
  VectorX limit_ratio;      ///< Largest peak / limit over the finite orders: an infinite one is not held (see plan.h).
  double energy = 0.0;      ///< Sum over joints of the integral of squared acceleration.
  double goal_error = 0.0;  ///< Largest joint difference at the end to the goal.
};

/// @pre limits and goal have the trajectory's joints.
JointMetrics jointMetrics(const JointTrajectory& trajectory, const Limits& limits, const VectorX& goal);

/// The tool point in the base frame [m, m/s, m/s^2].
struct ToolMotion {
  Vector3 position;
  Vector3 velocity;
  Vector3 acceleration;
};

/// Forward kinematics to second order, supplied by the caller: J(q) qd and J qdd + dJ/dt qd. Called with the state at
/// one instant.
using ToolKinematics = std::function<ToolMotion(const TrajectoryPoint& state)>;

/// Figures of the tool's path. The integrals and maxima are numerical: see the stated errors.
struct ToolMetrics {
  double path_length = 0.0;        ///< [m] Integral of the speed.
  double path_length_error = 0.0;  ///< [m] Estimated error of it.
  double max_curvature = 0.0;      ///< [1/m] |v x a| / |v|^3 where the tool moves; 0 where it never does.
  double peak_speed = 0.0;         ///< [m/s]
};

/// Path length by adaptive Gauss-Kronrod quadrature (7/15 points) between the motion's corners to a relative tolerance
/// of 1e-9. Maxima over a grid of at least 400 instants, each local one refined by golden section: to about 1e-9 of the
/// value for a path without features shorter than the grid. Curvature counts where the speed exceeds 1e-6 of its peak:
/// at rest it has no meaning.
/// @pre tool is callable; it sees instants of [0, duration] only.
ToolMetrics toolMetrics(const JointTrajectory& trajectory, const ToolKinematics& tool);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_METRICS_H
