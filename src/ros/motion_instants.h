#ifndef SCREWLINE_ROS_MOTION_INSTANTS_H
#define SCREWLINE_ROS_MOTION_INSTANTS_H

#include <cmath>
#include <cstdint>

#include "screwline/ros/motion_clock.h"

namespace screwline {
namespace ros_bridge {

constexpr Nanoseconds kNever = INT64_MAX / 4;  ///< Room to add to it.

inline double secondsOf(Nanoseconds span) {
  return static_cast<double>(span) / static_cast<double>(kNanosecondsPerSecond);
}

inline Nanoseconds nanosecondsOf(double seconds) {
  return static_cast<Nanoseconds>(std::llround(seconds * static_cast<double>(kNanosecondsPerSecond)));
}

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_MOTION_INSTANTS_H
