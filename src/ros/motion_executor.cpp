#include "screwline/ros/motion_executor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion_instants.h"

namespace screwline {
namespace ros_bridge {
namespace {

constexpr Nanoseconds kSameInstant = 1000;                    // An end so near to a period's is there.
constexpr Nanoseconds kMostCaughtUp = kNanosecondsPerSecond;  // Later than that, samples are skipped.
constexpr Nanoseconds kSetBack = kNanosecondsPerSecond;       // A clock set back by more is followed.

}  // namespace

MotionExecutor::MotionExecutor(const VectorX& initial_position, double rate, Limits limits, MotionClock clock,
                               StreamSink sink)
    : rate_(rate),
      limits_(std::move(limits)),
      clock_(std::move(clock)),
      sink_(std::move(sink)),
      point_(static_cast<int>(initial_position.size())) {
  active_.motion = std::make_shared<const Motion>(Motion::resting(initial_position));
  active_.clock = std::make_shared<const PathClock>();
}

MotionExecutor::~MotionExecutor() {
  shutdown();
}

void MotionExecutor::start() {
  thread_ = std::thread([this] {
    while (step()) {
    }
  });
}

void MotionExecutor::shutdown() {
  running_ = false;
  if (thread_.joinable()) thread_.join();
}

Nanoseconds MotionExecutor::gridInstant(std::int64_t tick) const {
  return origin_ + nanosecondsOf(static_cast<double>(tick) / rate_);
}

std::int64_t MotionExecutor::firstTickAt(Nanoseconds instant) const {
  std::int64_t tick = static_cast<std::int64_t>(std::floor(secondsOf(instant - origin_) * rate_)) - 1;
  while (gridInstant(tick) < instant) ++tick;
  return tick;
}

MotionState MotionExecutor::stateAt(Nanoseconds instant) const {
  const Active& active = next_ && instant >= next_->start ? *next_ : active_;
  TrajectoryPoint point(active.motion->main().joints());
  active.motion->sample(active.clock->at(secondsOf(instant - active.start)), point);
  if (instant < active.end) return {point.position, point.velocity, point.acceleration};
  return {point.position, VectorX::Zero(point.position.size()), VectorX::Zero(point.position.size())};
}

MotionState MotionExecutor::state() const {
  const Nanoseconds now = clock_.now();
  const std::lock_guard<std::mutex> lock(mutex_);
  return stateAt(now);
}

std::optional<MotionState> MotionExecutor::stateInMotion(Nanoseconds instant) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (over_ || instant < active_.start || instant > active_.end || (next_ && instant >= next_->start)) {
    return std::nullopt;
  }
  return stateAt(instant);
}

MotionExecutor::Event MotionExecutor::nextEvent() const {
  const Nanoseconds grid = gridInstant(tick_);
  if (!over_ && active_.end < grid - kSameInstant) return {active_.end, false, false, true};
  if (next_ && grid >= next_->start) return {grid, true, true, false};
  if (!over_ && active_.end <= grid + kSameInstant) return {active_.end, true, false, true};
  return {grid, true, false, false};
}

void MotionExecutor::followClock(Nanoseconds now) {
  if (origin_ == 0) {
    origin_ = now;
    tick_ = 0;
  }
  if (now < last_stamp_ - kSetBack) {
    const Nanoseconds shift = now - last_stamp_;
    for (Nanoseconds* instant : {&origin_, &last_stamp_, &active_.start, &active_.end}) *instant += shift;
    if (next_) next_->start += shift;
    if (next_) next_->end += shift;
  }
  if (now - gridInstant(tick_) > kMostCaughtUp) {
    const Nanoseconds until = next_ ? std::min(now, next_->start) : now;
    const std::int64_t tick = std::max(tick_, firstTickAt(until));
    skipped_ += tick - tick_;
    tick_ = tick;
  }
}

bool MotionExecutor::waitForEvent() {
  while (running_) {
    const Nanoseconds now = clock_.now();
    Nanoseconds deadline = 0;
    bool at_rest = false;
    if (now > 0) {
      const std::lock_guard<std::mutex> lock(mutex_);
      followClock(now);
      deadline = nextEvent().stamp;
      at_rest = over_ && !next_;
    }
    if (now > 0 && now >= deadline) return true;
    if (at_rest) clock_.at_rest();
    clock_.sleep_until(deadline);
  }
  return false;
}

bool MotionExecutor::step() {
  if (!waitForEvent()) return false;
  Active active;
  StreamSample sample;
  PathInstant instant;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const Event event = nextEvent();
    if (event.start) {
      active_ = std::move(*next_);
      next_.reset();
    }
    active = active_;
    sample.first = event.start;
    sample.held = over_ && !event.start;
    over_ = event.start ? active_.end <= event.stamp + kSameInstant : over_ || event.end;
    sample.last = over_ && !sample.held;
    instant = active.clock->at(secondsOf(event.stamp - active.start));
    if (event.end || sample.held) instant.time = active.motion->duration();
    if (event.grid) ++tick_;
    last_stamp_ = sample.stamp = event.stamp;
    std::swap(sample.skipped, skipped_);
  }
  active.motion->sample(instant, point_);
  if (sample.held) {
    for (VectorX* derivative : {&point_.velocity, &point_.acceleration, &point_.jerk}) derivative->setZero();
  }
  sample.state = &point_;
  const std::optional<double> tau = active.motion->tau(instant.time);
  if (tau) sample.scaling = active.motion->main().scaling();
  sample.tau = tau.value_or(0.0);
  sample.sent = clock_.now();
  sink_(sample);
  return true;
}

}  // namespace ros_bridge
}  // namespace screwline
