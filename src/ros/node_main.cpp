#include "screwline/ros/node_main.h"

#include <ros/ros.h>

#include <algorithm>
#include <exception>
#include <thread>

namespace screwline {
namespace ros_bridge {
namespace {

std::string inOneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

int runNode(int argc, char** argv, const std::string& name, const std::string& failure,
            const std::function<void(ros::NodeHandle& private_node)>& body) {
  ros::init(argc, argv, name);
  ros::NodeHandle private_node("~");  // The console is silent once the last handle is gone.
  try {
    body(private_node);
    return 0;
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(failure << ": " << inOneLine(error.what()));
    return 1;
  }
}

XmlRpc::XmlRpcValue privateParameters(const ros::NodeHandle& private_node) {
  XmlRpc::XmlRpcValue values;
  private_node.getParam("", values);
  return values;
}

ros::AsyncSpinner makeSpinner(int threads) {
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  return ros::AsyncSpinner(threads > 0 ? static_cast<unsigned>(threads) : cores);
}

}  // namespace ros_bridge
}  // namespace screwline
