#include <ros/ros.h>

#include <algorithm>
#include <exception>
#include <string>
#include <thread>

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
          publisher<geometry_msgs::TwistStamped>(node, kTwistStream)};
}

void generate(ros::NodeHandle& node, ros::NodeHandle& private_node) {
  XmlRpc::XmlRpcValue values;
  private_node.getParam("", values);
  const TrajectoryParams params = readTrajectoryParams(values);
  const ServedRobot robot = makeRobot(findRobot(private_node), params.robot);
  const MotionClock clock = ros::Time::isSimTime() ? rosMotionClock() : wallMotionClock();
  TrajectoryGenerator generator(robot, params, tfLookup(robot.chain->baseLink()), clock, publishers(node));
  generator.advertise(private_node);
  generator.executor().start();

  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  ros::AsyncSpinner spinner(params.threads > 0 ? static_cast<unsigned>(params.threads) : cores);
  spinner.start();
  ROS_INFO_STREAM("moving chain '" << robot.chain->name() << "' of " << robot.chain->size() << " joints");
  ros::waitForShutdown();
  spinner.stop();
  generator.executor().shutdown();
}

std::string inOneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, kTrajectoryGeneratorNode);
  ros::NodeHandle node;  // The console is silent once the last handle is gone.
  ros::NodeHandle private_node("~");
  try {
    generate(node, private_node);
    return 0;
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM("the robot can not be moved: " << inOneLine(error.what()));
    return 1;
  }
}
