#include "screwline/ros/tf_lookup.h"

#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <chrono>
#include <cmath>
#include <thread>

namespace screwline {
namespace ros_bridge {
namespace {

constexpr std::chrono::milliseconds kPollPeriod(5);

struct Listening {
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener{buffer};
};

Pose poseOf(const geometry_msgs::Transform& transform) {
  const auto& r = transform.rotation;
  const auto& t = transform.translation;
  return {Quaternion(r.w, r.x, r.y, r.z).normalized().toRotationMatrix(), Vector3(t.x, t.y, t.z)};
}

std::optional<Pose> latest(const tf2_ros::Buffer& buffer, const std::string& base, const std::string& frame) {
  try {
    return poseOf(buffer.lookupTransform(base, frame, ros::Time(0)).transform);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

}  // namespace

FrameLookup tfLookup(const std::string& base_link, double timeout) {
  const auto listening = std::make_shared<Listening>();
  return [=](const std::string& frame) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout));
    std::optional<Pose> pose = latest(listening->buffer, base_link, frame);
    while (!pose && Clock::now() < end) {
      std::this_thread::sleep_for(kPollPeriod);
      pose = latest(listening->buffer, base_link, frame);
    }
    return pose;
  };
}

}  // namespace ros_bridge
}  // namespace screwline
