#include <ros/ros.h>

#include <functional>
#include <string>

#include "screwline/ros/node_main.h"
#include "screwline/ros/tf_lookup.h"
#include "screwline/ros/trajectory_generator.h"

namespace {

using namespace screwline::ros_bridge;

constexpr std::uint32_t kQueue = 10000;  // 10 s at the highest rate

/// A function that publishes what it is given.
template <typename Message>
std::function<void(const Message&)> publisher(ros::NodeHandle& node, const std::string& topic, bool latched = false) {
  const ros::Publisher out = node.advertise<Message>(topic, kQueue, latched);
  return [out](const Message& message) { out.publish(message); };
}

GeneratorSinks publishers(ros::NodeHandle& node) {
  return {publisher<trajectory_msgs::JointTrajectory>(node, kTrajectoryStream, true),
          publisher<screwline::TrajectoryMetrics>(node, kMetricsStream, true),
          publisher<sensor_msgs::JointState>(node, kStateStream),
          publisher<screwline::TimeScaling>(node, kScalingStream),
          publisher<geometry_msgs::PoseStamped>(node, kPoseStream),
          publisher<geometry_msgs::TwistStamped>(node, kTwistStream),
          publisher<diagnostic_msgs::DiagnosticArray>(node, kDiagnosticsStream)};
}

void generate(ros::NodeHandle& private_node) {
  ros::NodeHandle node;
  const TrajectoryParams params = readTrajectoryParams(privateParameters(private_node));
  const ServedRobot robot = makeRobot(findRobot(private_node), params.robot);
  const MotionClock clock = ros::Time::isSimTime() ? rosMotionClock() : wallMotionClock();
  TrajectoryGenerator generator(robot, params, tfLookup(robot.chain->baseLink()), clock, publishers(node));
  generator.advertise(private_node, node);
  generator.executor().start();

  ros::AsyncSpinner spinner = makeSpinner(params.threads);
  spinner.start();
  ROS_INFO_STREAM("moving chain '" << robot.chain->name() << "' of " << robot.chain->size() << " joints");
  ros::waitForShutdown();
  spinner.stop();
  generator.executor().shutdown();
}

}  // namespace

int main(int argc, char** argv) {
  return runNode(argc, argv, kTrajectoryGeneratorNode, "the robot can not be moved", generate);
}
