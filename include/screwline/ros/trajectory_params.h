#ifndef SCREWLINE_ROS_TRAJECTORY_PARAMS_H
#define SCREWLINE_ROS_TRAJECTORY_PARAMS_H

#include <vector>

#include "screwline/ros/params.h"

namespace screwline {
namespace ros_bridge {

constexpr char kTrajectoryGeneratorNode[] = "trajectory_generator";

// Its services, in the private namespace.
constexpr char kPlanService[] = "plan";
constexpr char kExecuteService[] = "execute";
constexpr char kStopService[] = "stop";
constexpr char kPauseService[] = "pause";
constexpr char kResumeService[] = "resume";
constexpr char kListProfilesService[] = "list_profiles";

// What it listens to, relative to its namespace.
constexpr char kSpeedTopic[] = "speed_override";

// What it publishes, relative to its namespace.
constexpr char kTrajectoryStream[] = "joint_trajectory";
constexpr char kStateStream[] = "joint_states";
constexpr char kScalingStream[] = "time_scaling";
constexpr char kPoseStream[] = "tool_pose";
constexpr char kTwistStream[] = "tool_twist";
constexpr char kMetricsStream[] = "metrics";
constexpr char kDiagnosticsStream[] = "diagnostics";

/// Private parameters of trajectory_generator: those of RobotParams, and ~rate, ~ik_timeout, ~threads,
/// ~initial_position, ~tracked_joint_states.
struct TrajectoryParams {
  RobotParams robot;
  double rate = 100.0;                   ///< [Hz] of the streamed topics, 1 to 1000.
  double ik_timeout = 0.1;               ///< [s] per pose for what inverse kinematics searches numerically.
  int threads = 0;                       ///< That answer requests; 0: as many as cores.
  std::string tracked_joint_states;      ///< Topic of a controlled robot's states; empty: none.
  std::vector<double> initial_position;  ///< [rad or m] n values, chain order; empty: zero, clamped into the limits.
};

/// Every private parameter of the node. @throws ModelError naming the key, also for one that the node does not have.
TrajectoryParams readTrajectoryParams(const XmlRpc::XmlRpcValue& private_params);

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_TRAJECTORY_PARAMS_H
