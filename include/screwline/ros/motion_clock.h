#ifndef SCREWLINE_ROS_MOTION_CLOCK_H
#define SCREWLINE_ROS_MOTION_CLOCK_H

#include <cstdint>
#include <functional>

namespace screwline {
namespace ros_bridge {

/// An instant or a time span in ns; instants since the epoch of ros::Time.
using Nanoseconds = std::int64_t;

constexpr Nanoseconds kNanosecondsPerSecond = 1000000000;

/// The time that motion runs on. A seam: tests turn it by hand.
struct MotionClock {
  std::function<Nanoseconds()> now;              ///< 0 while there is no time yet (a simulated clock before its start).
  std::function<void(Nanoseconds)> sleep_until;  ///< May return early, by a signal or to let its caller look around.
  std::function<void()> at_rest = [] {};         ///< Called now and then while nothing moves: the clock may be set.
};

/// The system's monotonic clock, read as ros::Time: absolute deadlines by clock_nanosleep(), which do not drift. While
/// nothing moves it follows the wall clock where that was set.
MotionClock wallMotionClock();

/// ros::Time, simulated or played from a bag. Needs ros::init().
MotionClock rosMotionClock();

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_MOTION_CLOCK_H
