#ifndef SCREWLINE_ROS_NODE_MAIN_H
#define SCREWLINE_ROS_NODE_MAIN_H

#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <functional>
#include <string>

namespace screwline {
namespace ros_bridge {

/// Runs a node's body with its private handle, and keeps the node alive until it returns. What it throws ends the node
/// with one FATAL line, `failure` and the reason, and exit status 1. Returns the exit status.
int runNode(int argc, char** argv, const std::string& name, const std::string& failure,
            const std::function<void(ros::NodeHandle& private_node)>& body);

/// All private parameters of a node, as a struct; empty where there is none.
XmlRpc::XmlRpcValue privateParameters(const ros::NodeHandle& private_node);

/// A spinner with so many threads; 0: one for each core.
ros::AsyncSpinner makeSpinner(int threads);

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_NODE_MAIN_H
