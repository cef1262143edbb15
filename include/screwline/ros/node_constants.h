#ifndef SCREWLINE_ROS_NODE_CONSTANTS_H
#define SCREWLINE_ROS_NODE_CONSTANTS_H

namespace screwline {
namespace ros_bridge {

constexpr char kKinematicsServerNode[] = "kinematics_server";
constexpr char kRecorderNode[] = "recorder";

// Services of kinematics_server, in its private namespace.
constexpr char kDescribeService[] = "describe";
constexpr char kComputeFkService[] = "compute_fk";
constexpr char kComputeIkService[] = "compute_ik";
constexpr char kComputeJacobianService[] = "compute_jacobian";
constexpr char kAnalyzeSingularityService[] = "analyze_singularity";
constexpr char kComputeStaticsService[] = "compute_statics";
constexpr char kComputeVelocityService[] = "compute_velocity";
constexpr char kComputeFkBatchService[] = "compute_fk_batch";
constexpr char kComputeIkBatchService[] = "compute_ik_batch";
constexpr char kDeriveService[] = "derive";

// Parameters found by searching upward, and what lies beside the first of them.
constexpr char kRobotDescriptionParam[] = "robot_description";
constexpr char kPlanningSuffix[] = "_planning";
constexpr char kJointLimitsKey[] = "joint_limits";

// Private parameters of a node that serves one robot.
constexpr char kBaseLinkParam[] = "base_link";
constexpr char kTipLinkParam[] = "tip_link";
constexpr char kTaskParam[] = "task";
constexpr char kIkTimeoutParam[] = "ik_timeout";
constexpr char kThreadsParam[] = "threads";
constexpr char kMaxBatchParam[] = "max_batch";
constexpr char kBatchTimeoutParam[] = "batch_timeout";
constexpr char kDeriveTimeoutParam[] = "derive_timeout";
constexpr char kConditionsTimeoutParam[] = "conditions_timeout";
constexpr char kMaxJointsParam[] = "max_joints";
constexpr char kRotationWeightParam[] = "rotation_weight";

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_NODE_CONSTANTS_H
