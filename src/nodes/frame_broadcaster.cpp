#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <string>

#include "screwline/exception.h"
#include "screwline/ros/frame_broadcaster.h"
#include "screwline/ros/node_main.h"

namespace {

using namespace screwline::ros_bridge;

constexpr std::uint32_t kQueue = 1000;
constexpr double kWarningPeriod = 5.0;  // s

/// Runs a callback; a message that is no good is said and passed over.
template <typename Callback>
void guarded(Callback&& callback) {
  try {
    callback();
  } catch (const screwline::InputError& error) {
    ROS_WARN_STREAM_THROTTLE(kWarningPeriod, "passed over: " << error.what());
  }
}

/// Calls a method of the broadcaster with each message of a topic.
template <typename Message, typename Method>
ros::Subscriber listen(ros::NodeHandle& node, const std::string& topic, FrameBroadcaster& broadcaster, Method method) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
      [&broadcaster, method](const boost::shared_ptr<const Message>& message) {
        guarded([&] { method(broadcaster, *message); });
      };
  return node.subscribe<Message>(topic, kQueue, callback, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}

void broadcastRobot(ros::NodeHandle& private_node) {
  ros::NodeHandle node;
  const BroadcasterParams params = readBroadcasterParams(privateParameters(private_node));
  const RobotSource source = findRobot(private_node);
  const ServedRobot robot = makeRobot(source, params.robot);

  tf2_ros::StaticTransformBroadcaster static_tf;
  // With a queue of its own: tf2_ros's holds 100 messages, of which a busy machine drops some.
  const ros::Publisher tf = node.advertise<tf2_msgs::TFMessage>(kTfTopic, kQueue);
  const ros::Publisher markers = private_node.advertise<visualization_msgs::MarkerArray>(kMarkersTopic, kQueue);
  const BroadcasterSinks sinks{
      [&](const geometry_msgs::TransformStamped& transform) { static_tf.sendTransform(transform); },
      [&](const std::vector<geometry_msgs::TransformStamped>& transforms) {
        tf2_msgs::TFMessage message;
        message.transforms = transforms;
        tf.publish(message);
      },
      [&](const visualization_msgs::MarkerArray& array) { markers.publish(array); }};
  FrameBroadcaster broadcaster(robot, linkNames(source.description), params, sinks);
  broadcaster.start(ros::Time::now());

  const ros::Subscriber states = listen<sensor_msgs::JointState>(
      node, kJointStatesTopic, broadcaster,
      [](FrameBroadcaster& b, const sensor_msgs::JointState& state) { b.onJointState(state, ros::Time::now()); });
  const ros::Subscriber trajectories = listen<trajectory_msgs::JointTrajectory>(
      node, kJointTrajectoryTopic, broadcaster,
      [](FrameBroadcaster& b, const trajectory_msgs::JointTrajectory& message) { b.onTrajectory(message); });
  const ros::Subscriber targets = listen<geometry_msgs::PoseStamped>(
      node, kTargetTopic, broadcaster,
      [](FrameBroadcaster& b, const geometry_msgs::PoseStamped& message) { b.onTarget(message); });
  ROS_INFO_STREAM("broadcasting the frames of chain '" << robot.chain->name() << "' as " << params.frame_prefix << "*");
  ros::spin();
}

}  // namespace

int main(int argc, char** argv) {
  return runNode(argc, argv, kFrameBroadcasterNode, "the robot can not be broadcast", broadcastRobot);
}
