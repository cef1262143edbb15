#include <ros/ros.h>

#include <algorithm>
#include <exception>
#include <string>
#include <thread>

#include "screwline/ros/kinematics_server.h"
#include "screwline/ros/node_constants.h"
#include "screwline/ros/tf_lookup.h"

namespace {

using namespace screwline::ros_bridge;

void serveRobot(ros::NodeHandle& private_node) {
  XmlRpc::XmlRpcValue values;
  private_node.getParam("", values);
  const KinematicsParams params = readKinematicsParams(values);
  const ServedRobot robot = makeRobot(findRobot(private_node), params.robot);
  KinematicsServer server(robot, params, tfLookup(robot.chain->baseLink()));
  server.advertise(private_node);

  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  ros::AsyncSpinner spinner(params.threads > 0 ? static_cast<unsigned>(params.threads) : cores);
  spinner.start();
  ROS_INFO_STREAM("serving chain '" << robot.chain->name() << "' of " << robot.chain->size() << " joints");
  ros::waitForShutdown();
}

std::string inOneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, kKinematicsServerNode);
  ros::NodeHandle private_node("~");  // The console is silent once the last handle is gone.
  try {
    serveRobot(private_node);
    return 0;
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM("the robot can not be served: " << inOneLine(error.what()));
    return 1;
  }
}
