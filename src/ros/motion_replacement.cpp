// How a MotionExecutor gets its motions, and their speed.
#include <cmath>
#include <utility>

#include "motion_instants.h"
#include "screwline/exception.h"
#include "screwline/ros/checks.h"
#include "screwline/ros/motion_executor.h"

namespace screwline {
namespace ros_bridge {
namespace {

constexpr Nanoseconds kFirstNotice = kNanosecondsPerSecond / 1000;  // From a replacement to its start,
constexpr Nanoseconds kLongestNotice = 2 * kNanosecondsPerSecond;   // tried up to this
constexpr Nanoseconds kNoticeGrowth = 4;                            // in such steps.
constexpr double kLongestMotion = 1e9;                              // s; what takes longer has no end.

[[noreturn]] void refuseWithoutTime() {
  throw InputError(AnswerCode::kFailure, "time does not run: nobody publishes /clock");
}

}  // namespace

void MotionExecutor::setClock(Active& active, PathClock clock) const {
  const double end = clock.instantOf(active.motion->duration());
  active.end = end < kLongestMotion ? active.start + nanosecondsOf(end) : kNever;
  active.clock = std::make_shared<const PathClock>(std::move(clock));
}

/// The motion begins at the least rate at which the present state is one that the limits allow, and goes from there to
/// the rate that is asked for: it neither jumps nor is it any faster than it has to be.
MotionExecutor::Active MotionExecutor::follow(const MotionMaker& make, const MotionState& present, double rate,
                                              Pace pace) const {
  const double first = pace == Pace::kRealTime ? 1.0 : slowestRate(present, limits_, rate);
  Active next;
  next.pace = pace;
  next.motion = std::make_shared<const Motion>(make(inPathTime(present, first)));
  const Path path = next.motion->path();
  next.bounds = std::make_shared<const Limits>(boundsOf(path, limits_));
  PathClock clock(first);
  setClock(next, first == rate ? clock : clock.turned(0.0, rate, path, *next.bounds));
  return next;
}

MotionExecutor::Started MotionExecutor::replace(const MotionMaker& make, Pace pace) {
  const std::lock_guard<std::mutex> one_at_a_time(replacing_);
  const bool real_time = pace == Pace::kRealTime;
  for (Nanoseconds notice = kFirstNotice; notice <= kLongestNotice; notice *= kNoticeGrowth) {
    Nanoseconds start = 0;
    double rate = 1.0;
    MotionState present;
    {
      const Nanoseconds now = clock_.now();
      const std::lock_guard<std::mutex> lock(mutex_);
      if (now <= 0) refuseWithoutTime();
      followClock(now);
      start = gridInstant(std::max(tick_, firstTickAt(now + notice)));
      present = stateAt(start);
      if (!real_time) rate = pathRate();
    }
    Active next = follow(make, present, rate, pace);
    next.start += start;
    if (next.end != kNever) next.end += start;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (gridInstant(tick_) > start) continue;
    next_ = next;
    if (real_time) paused_ = false;
    return {start, next.motion};
  }
  throw InputError(AnswerCode::kFailure, "the way from the present state was not found before it was past");
}

/// What runs, or is about to, and heeds the speed; null: nothing. With the lock held.
MotionExecutor::Active* MotionExecutor::heeding() {
  Active* active = next_ ? &*next_ : over_ ? nullptr : &active_;
  return active != nullptr && active->pace == Pace::kSpeed ? active : nullptr;
}

MotionExecutor::Turn MotionExecutor::turn(std::optional<double> speed, std::optional<bool> paused) {
  const std::lock_guard<std::mutex> one_at_a_time(replacing_);
  for (Nanoseconds notice = kFirstNotice; notice <= kLongestNotice; notice *= kNoticeGrowth) {
    Active turned;
    Nanoseconds instant = 0;
    double rate = 1.0;
    {
      const Nanoseconds now = clock_.now();
      const std::lock_guard<std::mutex> lock(mutex_);
      const Active* active = heeding();
      if (active != nullptr) {
        if (now <= 0) refuseWithoutTime();
        followClock(now);
        instant = std::max(gridInstant(std::max(tick_, firstTickAt(now + notice))), active->start);
      }
      // What has ended before it could heed does not.
      if (active == nullptr || active->end <= instant) {
        speed_ = speed.value_or(speed_);
        paused_ = paused.value_or(paused_);
        return {};
      }
      turned = *active;
      rate = paused.value_or(paused_) ? 0.0 : speed.value_or(speed_);
    }
    const double t = secondsOf(instant - turned.start);
    setClock(turned, turned.clock->turned(t, rate, turned.motion->path(), *turned.bounds));
    const std::lock_guard<std::mutex> lock(mutex_);
    Active* active = heeding();
    if (gridInstant(tick_) > instant || active == nullptr || active->motion != turned.motion) continue;
    *active = turned;
    speed_ = speed.value_or(speed_);
    paused_ = paused.value_or(paused_);
    const double settles = std::max(0.0, turned.clock->settled() - t);
    const double ends = secondsOf(turned.end - instant);
    return {true, std::min(settles, ends), ends < settles};
  }
  throw InputError(AnswerCode::kFailure, "the change of speed was not found before it was past");
}

MotionExecutor::Turn MotionExecutor::setSpeed(double speed) {
  if (!(speed >= 0.0 && speed <= 1.0)) {
    throw InputError(AnswerCode::kInvalidGoal, "speed is " + numberText(speed) + ", it must be from 0 to 1");
  }
  return turn(speed, std::nullopt);
}

MotionExecutor::Turn MotionExecutor::pause() {
  return turn(std::nullopt, true);
}

MotionExecutor::Turn MotionExecutor::resume() {
  return turn(std::nullopt, false);
}

double MotionExecutor::speed() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return speed_;
}

bool MotionExecutor::paused() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return paused_;
}

}  // namespace ros_bridge
}  // namespace screwline
