#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <csignal>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "../ros/bag_recorder.h"
#include "screwline/ros/node_constants.h"
#include "screwline/ros/node_main.h"

namespace {

using namespace screwline::ros_bridge;

constexpr std::uint32_t kUnbounded = 0;  // Queue: a busy machine delays messages, it drops none.
constexpr double kPollPeriod = 0.05;     // s, in which a signal is seen.
constexpr double kConnecting = 2.0;      // s that a topic's publishers are waited for.
constexpr double kHandshake = 0.02;      // s from a connection to its first message.
constexpr double kLastMessages = 0.06;   // s for what follows from a topic's last messages to come.

volatile std::sig_atomic_t stop_requested = 0;

void requestStop(int) {
  stop_requested = 1;
}

/// How many nodes publish a topic, as the master knows it.
std::uint32_t publisherCount(const std::string& topic) {
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue state;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, state, false)) return 0;
  for (int i = 0; i < state[0].size(); ++i) {
    if (std::string(state[0][i][0]) == topic) return static_cast<std::uint32_t>(state[0][i][1].size());
  }
  return 0;
}

/// Takes messages for a while.
void takeFor(double seconds) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
  while (ros::WallTime::now() < end) ros::getGlobalCallbackQueue()->callAvailable(end - ros::WallTime::now());
}

void waitForPublishers(const ros::Subscriber& subscriber) {
  const std::uint32_t count = publisherCount(subscriber.getTopic());
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kConnecting);
  while (stop_requested == 0 && subscriber.getNumPublishers() < count && ros::WallTime::now() < end)
    takeFor(kHandshake);
  takeFor(kHandshake);
}

/// In the order given, each once it is connected: what follows from another topic's messages comes before it, and then
/// has no gap at the start.
std::vector<ros::Subscriber> listen(ros::NodeHandle& node, const std::vector<std::string>& names,
                                    BagRecorder& recorder) {
  using Message = const BagRecorder::Message&;
  std::vector<ros::Subscriber> subscribers;
  std::set<std::string> known;
  for (const std::string& name : names) {
    const std::string topic = node.resolveName(name);
    if (!known.insert(topic).second) continue;
    const boost::function<void(Message)> callback = [&recorder, topic](Message message) {
      recorder.take(topic, message);
    };
    subscribers.push_back(
        node.subscribe<Message>(topic, kUnbounded, callback, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
    waitForPublishers(subscribers.back());
  }
  return subscribers;
}

/// So that what follows from another topic's messages has no gap at the end either.
void endInReverse(std::vector<ros::Subscriber>& subscribers) {
  while (!subscribers.empty()) {
    subscribers.pop_back();
    takeFor(kLastMessages);
  }
}

void record(const std::string& path, const std::vector<std::string>& names) {
  // roscpp's own handler would drop what waits in the queue; it has none for SIGTERM.
  std::signal(SIGINT, requestStop);
  std::signal(SIGTERM, requestStop);
  ros::NodeHandle node;
  BagRecorder recorder(path);
  std::vector<ros::Subscriber> subscribers = listen(node, names, recorder);
  ROS_INFO_STREAM("recording " << subscribers.size() << " topics into " << path);

  ros::CallbackQueue& queue = *ros::getGlobalCallbackQueue();
  while (ros::ok() && stop_requested == 0 && !recorder.failed()) queue.callAvailable(ros::WallDuration(kPollPeriod));
  queue.callAvailable();  // What had come before the signal.
  endInReverse(subscribers);
  const std::uint64_t count = recorder.close();
  ROS_INFO_STREAM("closed " << path << ": " << count << " messages");
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments;
  ros::removeROSArgs(argc, argv, arguments);
  if (arguments.size() < 3 || arguments[1].empty() || arguments[1][0] == '-') {
    std::fputs(
        "usage: rosrun screwline recorder BAG TOPIC...\n"
        "Records topics until it is interrupted, then closes the bag.\n"
        "Exit code: 0 all that came is in the bag, 1 it is not, 2 wrong arguments.\n",
        stderr);
    return 2;
  }
  return runNode(argc, argv, kRecorderNode, "nothing more is recorded", [&](ros::NodeHandle&) {
    record(arguments[1], {arguments.begin() + 2, arguments.end()});
  });
}
