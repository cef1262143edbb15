#include "screwline/trajectory/path_clock.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "clock_ramps.h"
#include "screwline/exception.h"
#include "screwline/trajectory/axis_motion.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/state_to_state.h"

namespace screwline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kHistory = 2.0;  ///< [s] that a clock remembers: late samples ask for the past.

/// Where the path time of a phase reaches a value: it never falls, so halving brackets and Newton's step hastens it.
double timeInPhase(const EndState& state, const JerkPhase& phase, double value) {
  double low = 0.0;
  double high = phase.length;
  double t = 0.5 * high;
  for (int i = 0; i < 100 && high - low > 1e-16 * high; ++i) {
    const EndState now = advanced(state, phase, t);
    (now.position < value ? low : high) = t;
    const double step = now.velocity > 0.0 ? t - (now.position - value) / now.velocity : -1.0;
    t = step > low && step < high ? step : 0.5 * (low + high);
  }
  return high;
}

}  // namespace

double durationOf(const Path& path) {
  double duration = 0.0;
  for (const JointTrajectory* part : path) duration += part->duration();
  return duration;
}

void pace(const PathInstant& instant, TrajectoryPoint& point) {
  const double r = instant.rate;
  if (r == 1.0 && instant.change == 0.0 && instant.bend == 0.0) return;
  point.jerk = r * r * r * point.jerk + 3.0 * r * instant.change * point.acceleration + instant.bend * point.velocity;
  point.acceleration = r * r * point.acceleration + instant.change * point.velocity;
  point.velocity *= r;
}

PathClock::PathClock(double rate) : stretches_{{0.0, {0.0, rate, 0.0}, {kInfinity, 0.0, true}}} {}

const PathClock::Stretch& PathClock::stretchAt(double t) const {
  auto stretch = stretches_.end() - 1;
  while (stretch != stretches_.begin() && t < stretch->begin) --stretch;
  return *stretch;
}

PathInstant PathClock::at(double t) const {
  const Stretch& stretch = stretchAt(t);
  const EndState now = advanced(stretch.state, stretch.phase, t - stretch.begin);
  return {now.position, std::min(std::max(now.velocity, 0.0), 1.0), now.acceleration, stretch.phase.jerk};
}

double PathClock::finalRate() const {
  return stretches_.back().state.velocity;
}

double PathClock::settled() const {
  return stretches_.back().begin;
}

double PathClock::instantOf(double path_time) const {
  for (std::size_t k = 0; k + 1 < stretches_.size(); ++k) {
    const Stretch& stretch = stretches_[k];
    if (path_time <= stretch.state.position) return stretch.begin;
    if (path_time > stretches_[k + 1].state.position) continue;
    return stretch.begin + timeInPhase(stretch.state, stretch.phase, path_time);
  }
  const Stretch& last = stretches_.back();
  const double left = path_time - last.state.position;
  if (left <= 0.0) return last.begin;
  return last.state.velocity > 0.0 ? last.begin + left / last.state.velocity : kInfinity;
}

/// The last stretch ends where the new phase begins, and another one without end follows.
void PathClock::append(const JerkPhase& phase) {
  const Stretch& last = stretches_.back();
  Stretch next{last.begin + last.phase.length, advanced(last.state, last.phase, last.phase.length), phase};
  stretches_.push_back(next);
}

PathClock PathClock::turned(double t, double rate, const Path& path, const Limits& bounds) const {
  if (!(rate >= 0.0 && rate <= 1.0)) {
    throw InputError(AnswerCode::kInvalidGoal, "rate is " + number(rate) + ", it must lie in [0, 1]");
  }
  PathClock clock = *this;
  auto& stretches = clock.stretches_;
  const auto forgotten = [&](const Stretch& next) { return next.begin <= t - kHistory; };
  while (stretches.size() > 1 && forgotten(stretches[1])) stretches.erase(stretches.begin());

  const auto rampFrom = [&](double begin) {
    const Stretch& stretch = clock.stretchAt(begin);
    return rampsTo(rate, advanced(stretch.state, stretch.phase, begin - stretch.begin), path, bounds);
  };
  double begin = t;
  std::vector<JerkPhase> ramps = rampFrom(begin);
  if (ramps.empty() && clock.at(t).change != 0.0) {
    begin = std::max(t, stretches.back().begin);
    ramps = rampFrom(begin);
  }
  while (stretches.size() > 1 && stretches.back().begin > begin) stretches.pop_back();
  stretches.back().phase.length = begin - stretches.back().begin;
  for (const JerkPhase& phase : ramps) clock.append(phase);
  clock.append({kInfinity, 0.0, true});
  EndState& last = stretches.back().state;
  last.acceleration = 0.0;
  // A ramp that ended before its goal (the path did) goes on as it is; else rounding of the rate is taken off.
  if (std::abs(last.velocity - rate) < 1e-9) last.velocity = rate;
  return clock;
}

Limits boundsOf(const Path& path, const Limits& limits) {
  Limits bounds = limits;
  for (const JointTrajectory* part : path) {
    for (int j = 0; j < part->joints(); ++j) {
      const JointExtrema extrema = part->extrema(j);
      bounds.acceleration[j] = std::max(bounds.acceleration[j], extrema.acceleration);
      bounds.jerk[j] = std::max(bounds.jerk[j], extrema.jerk);
    }
  }
  return bounds;
}

MotionState inPathTime(const MotionState& state, double rate) {
  if (rate <= 0.0) return {state.position, 0.0 * state.velocity, 0.0 * state.acceleration};
  return {state.position, state.velocity / rate, state.acceleration / (rate * rate)};
}

double slowestRate(const MotionState& state, const Limits& limits, double least) {
  if (state.velocity.isZero(0.0) && state.acceleration.isZero(0.0)) return least;
  constexpr int kSteps = 40;
  const auto feasible = [&](double rate) {
    const MotionState seen = inPathTime(state, rate);
    for (int j = 0; j < limits.joints(); ++j) {
      const EndState joint{seen.position[j], seen.velocity[j], seen.acceleration[j]};
      if (checkState(joint, axisLimits(limits, j), true).fault != StateFault::kNone) return false;
    }
    return true;
  };
  double slowest = 1.0;
  for (int i = 1; i <= kSteps; ++i) {
    const double rate = 1.0 + (std::max(least, 1.0 / kSteps) - 1.0) * i / kSteps;
    if (!feasible(rate)) break;
    slowest = rate;
  }
  return slowest;
}

}  // namespace screwline
