#include "screwline/ros/motion_clock.h"

#include <ros/duration.h>
#include <ros/time.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <ctime>
#include <memory>

namespace screwline {
namespace ros_bridge {
namespace {

constexpr Nanoseconds kLongestSleep = kNanosecondsPerSecond / 10;  // so that a shutdown is seen
constexpr Nanoseconds kClockSet = kNanosecondsPerSecond / 100;     // a wall clock off by more was set, not slewed
constexpr double kPollPeriod = 0.0005;                             // s of wall time, for a clock that others turn

Nanoseconds readClock(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<Nanoseconds>(time.tv_sec) * kNanosecondsPerSecond + time.tv_nsec;
}

Nanoseconds wallOffset() {
  return readClock(CLOCK_REALTIME) - readClock(CLOCK_MONOTONIC);
}

void sleepUntilMonotonic(Nanoseconds deadline) {
  timespec time{};
  time.tv_sec = static_cast<std::time_t>(deadline / kNanosecondsPerSecond);
  time.tv_nsec = static_cast<long>(deadline % kNanosecondsPerSecond);
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
}

}  // namespace

MotionClock wallMotionClock() {
  const auto offset = std::make_shared<std::atomic<Nanoseconds>>(wallOffset());
  MotionClock clock;
  clock.now = [offset] { return readClock(CLOCK_MONOTONIC) + *offset; };
  clock.sleep_until = [offset](Nanoseconds instant) {
    sleepUntilMonotonic(std::min(instant - *offset, readClock(CLOCK_MONOTONIC) + kLongestSleep));
  };
  clock.at_rest = [offset] {
    const Nanoseconds present = wallOffset();
    if (std::abs(present - *offset) > kClockSet) *offset = present;
  };
  return clock;
}

MotionClock rosMotionClock() {
  MotionClock clock;
  clock.now = [] { return static_cast<Nanoseconds>(ros::Time::now().toNSec()); };
  clock.sleep_until = [](Nanoseconds) { ros::WallDuration(kPollPeriod).sleep(); };
  return clock;
}

}  // namespace ros_bridge
}  // namespace screwline
