#ifndef SCREWLINE_ROS_ROBOT_LOADER_H
#define SCREWLINE_ROS_ROBOT_LOADER_H

#include <ros/node_handle.h>

#include <memory>
#include <string>
#include <vector>

#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"
#include "screwline/ros/params.h"

namespace screwline {
namespace ros_bridge {

/// The one chain that a node serves; shared by all its threads.
struct ServedRobot {
  std::shared_ptr<const SerialChain> chain;
  Task task;                       ///< The rows that the chain controls.
  std::vector<std::string> notes;  ///< What was assumed or passed over, a line each.
};

/// What the parameter server holds of a robot.
struct RobotSource {
  std::string description;           ///< URDF.
  std::string name;                  ///< Of the parameter that held it.
  XmlRpc::XmlRpcValue joint_limits;  ///< Of <name>_planning/joint_limits; invalid where there is none.
};

/// @throws ModelError: see readUrdf(), withRateLimits(); more joints than max_joints; a task that is not one.
ServedRobot makeRobot(const RobotSource& source, const RobotParams& params);

/// Searches robot_description upward from the node. @throws ModelError at once where there is none, or it is no string.
RobotSource findRobot(const ros::NodeHandle& private_node);

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_ROBOT_LOADER_H
