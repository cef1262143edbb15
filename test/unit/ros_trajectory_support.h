#ifndef SCREWLINE_TEST_UNIT_ROS_TRAJECTORY_SUPPORT_H
#define SCREWLINE_TEST_UNIT_ROS_TRAJECTORY_SUPPORT_H

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "screwline/ros/motion_executor.h"

namespace screwline {
namespace ros_bridge {

/// A clock that stands still until somebody sleeps: then it is as late as `lateness` says.
struct FakeClock {
  Nanoseconds now = 1000000000000000000;
  std::function<Nanoseconds()> lateness = [] { return Nanoseconds(0); };
  int rests = 0;

  MotionClock clock() {
    MotionClock clock;
    clock.now = [this] { return now; };
    clock.sleep_until = [this](Nanoseconds instant) { now = std::max(now, instant + lateness()); };
    clock.at_rest = [this] { ++rests; };
    return clock;
  }
};

/// One sample that was sent.
struct Sent {
  Nanoseconds stamp = 0;
  TrajectoryPoint state;
  bool scaled = false;
  double tau = 0.0;
  bool held = false;
};

inline StreamSink recorderInto(std::vector<Sent>& sent) {
  return [&sent](const StreamSample& sample) {
    sent.push_back({sample.stamp, *sample.state, sample.scaling != nullptr, sample.tau, sample.held});
  };
}

inline double seconds(Nanoseconds span) {
  return static_cast<double>(span) / 1e9;
}

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_TEST_UNIT_ROS_TRAJECTORY_SUPPORT_H
