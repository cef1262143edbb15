#ifndef SCREWLINE_ROS_FRAME_BROADCASTER_PARAMS_H
#define SCREWLINE_ROS_FRAME_BROADCASTER_PARAMS_H

#include <string>

#include "screwline/ros/params.h"

namespace screwline {
namespace ros_bridge {

constexpr char kFrameBroadcasterNode[] = "frame_broadcaster";

// What the node listens to, relative to its namespace, and what it publishes, in its private one.
constexpr char kJointStatesTopic[] = "joint_states";
constexpr char kJointTrajectoryTopic[] = "joint_trajectory";
constexpr char kTargetTopic[] = "target";
constexpr char kMarkersTopic[] = "markers";
constexpr char kTfTopic[] = "/tf";

/// How markers are drawn.
struct MarkerParams {
  double rate = 20.0;  ///< [Hz] at most, in the time of the joint states.
  double ellipsoid_scale =
      0.25;                     ///< [s] half an axis of the ellipsoid [m] is this times the speed per unit joint rate.
  double near_singular = 0.05;  ///< A direction is drawn as lost from this share of the largest singular value down.
  int path_points = 600;        ///< That the tool's path keeps.
};

/// Private parameters of frame_broadcaster: those of RobotParams, and ~frame_prefix, ~marker_rate, ~ellipsoid_scale,
/// ~near_singular, ~path_points.
struct BroadcasterParams {
  RobotParams robot;
  std::string frame_prefix = "screwline/";  ///< Stands before the name of every frame that the node broadcasts.
  MarkerParams markers;
};

/// Every private parameter of the node. @throws ModelError naming the key, also for one that the node does not have.
BroadcasterParams readBroadcasterParams(const XmlRpc::XmlRpcValue& private_params);

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_FRAME_BROADCASTER_PARAMS_H
