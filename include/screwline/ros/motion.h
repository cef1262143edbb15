#ifndef SCREWLINE_ROS_MOTION_H
#define SCREWLINE_ROS_MOTION_H

#include <optional>
#include <utility>

#include "screwline/trajectory/joint_trajectory.h"
#include "screwline/trajectory/limits.h"
#include "screwline/trajectory/path_clock.h"
#include "screwline/trajectory/stop.h"

namespace screwline {
namespace ros_bridge {

/// What is streamed: a lead from where the robot is, then the motion that was asked for. Immutable. Its times are path
/// times: a PathClock says when they are.
class Motion {
 public:
  explicit Motion(JointTrajectory main) : main_(std::move(main)) {}
  Motion(JointTrajectory lead, JointTrajectory main) : lead_(std::move(lead)), main_(std::move(main)) {}

  /// The robot at rest.
  static Motion resting(const VectorX& position);

  double duration() const { return lead_.duration() + main_.duration(); }  ///< [s]
  const JointTrajectory& lead() const { return lead_; }                    ///< Of no duration where none is needed.
  const JointTrajectory& main() const { return main_; }
  Path path() const { return {&lead_, &main_}; }  ///< Valid as long as this.

  /// State at t [s]; from the duration on that of the end. No allocation where `point` has n entries.
  void sample(double t, TrajectoryPoint& point) const;
  /// The same with derivatives by the clock's time.
  void sample(const PathInstant& instant, TrajectoryPoint& point) const;

  /// Time over duration of the main motion, clamped to 1; none during the lead.
  std::optional<double> tau(double t) const;

 private:
  JointTrajectory lead_;
  JointTrajectory main_;
};

/// Joint values [rad or m] that differ by less are one place: a motion that begins so near needs no lead.
constexpr double kSamePlace = 1e-6;

bool isAtRest(const MotionState& state);

/// Whether positions stay within the bounds, up to rounding.
bool keepsPositions(const JointTrajectory& trajectory, const Limits& limits);

/// The motion from the present state. From rest at its first position it starts as it is (with the steps that its
/// profile has), unless it starts in a moving state; else by a lead, the shortest within the limits: to its first
/// state, continuous to acceleration, or, where the limits allow no such way, to rest at its first position. The lead
/// is verified before it is returned.
/// @throws InputError (kLimitsInfeasible): no lead within the limits.
Motion startFrom(const MotionState& present, const JointTrajectory& main, const Limits& limits);

/// To rest within velocity, acceleration and jerk limits. Where braking would pass a position bound: to rest before it,
/// else braking without heed to the jerk limit, else braking as it is.
JointTrajectory stopFrom(const MotionState& present, const Limits& limits);

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_MOTION_H
