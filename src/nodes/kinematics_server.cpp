#include <ros/ros.h>

#include "screwline/ros/kinematics_server.h"
#include "screwline/ros/node_constants.h"
#include "screwline/ros/node_main.h"
#include "screwline/ros/tf_lookup.h"

namespace {

using namespace screwline::ros_bridge;

void serveRobot(ros::NodeHandle& private_node) {
  const KinematicsParams params = readKinematicsParams(privateParameters(private_node));
  const ServedRobot robot = makeRobot(findRobot(private_node), params.robot);
  KinematicsServer server(robot, params, tfLookup(robot.chain->baseLink()));
  server.advertise(private_node);

  ros::AsyncSpinner spinner = makeSpinner(params.threads);
  spinner.start();
  ROS_INFO_STREAM("serving chain '" << robot.chain->name() << "' of " << robot.chain->size() << " joints");
  ros::waitForShutdown();
}

}  // namespace

int main(int argc, char** argv) {
  return runNode(argc, argv, kKinematicsServerNode, "the robot can not be served", serveRobot);
}
