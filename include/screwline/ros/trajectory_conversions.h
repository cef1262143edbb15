#ifndef SCREWLINE_ROS_TRAJECTORY_CONVERSIONS_H
#define SCREWLINE_ROS_TRAJECTORY_CONVERSIONS_H

#include <memory>
#include <vector>

#include "screwline/model/serial_chain.h"
#include "screwline/ros/motion.h"
#include "screwline/ros/trajectory_messages.h"
#include "screwline/trajectory/metrics.h"
#include "screwline/trajectory/points.h"

namespace screwline {
namespace ros_bridge {

constexpr std::size_t kMostPoints = 1000000;  ///< Of one trajectory.

/// The chain's rate limits and position bounds.
Limits limitsOf(const SerialChain& chain);

/// The points of a trajectory in chain order.
/// @throws InputError: (kInvalidRobotState) joint names and values, naming the point, (kInvalidGoal) times,
/// (kTooLarge) more than kMostPoints.
std::vector<SampledPoint> toPoints(const SerialChain& chain, const trajectory_msgs::JointTrajectory& message);

/// The points as a message, the last at `duration` [s]. (Times moved to that: what they are from is the present state.)
trajectory_msgs::JointTrajectory toMessage(const SerialChain& chain, const std::vector<SampledPoint>& points,
                                           double duration);

/// A trajectory's message: its samples at 0, period, ... and the end. With jerks: points x n, row-major.
struct SampledTrajectory {
  trajectory_msgs::JointTrajectory message;
  std::vector<double> times;  ///< [s] of the points.
  std::vector<double> jerks;
};
SampledTrajectory sampled(const SerialChain& chain, const JointTrajectory& trajectory, double period);

/// The points of `main` after the lead of a motion, which they follow: with the lead's own points before them where
/// there is one, times moved on by its duration.
trajectory_msgs::JointTrajectory withLead(const SerialChain& chain, const Motion& motion,
                                          const trajectory_msgs::JointTrajectory& main);

/// Figures of a motion that is meant to end at `goal`.
TrajectoryMetrics metricsOf(const std::shared_ptr<const SerialChain>& chain, const JointTrajectory& trajectory,
                            const Limits& limits, const VectorX& goal);

/// Position, velocity and acceleration of the tip's origin. The acceleration's part that comes from the change of the
/// Jacobian is a central difference along the motion: error about 1e-10 of the squared speed. From one thread.
ToolKinematics toolKinematics(const std::shared_ptr<const SerialChain>& chain);

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_TRAJECTORY_CONVERSIONS_H
