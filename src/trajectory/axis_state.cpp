#include <algorithm>
#include <cmath>

#include "screwline/trajectory/axis_motion.h"

namespace screwline {
namespace {

/// Rounding of a sampled state at a limit is not a state outside it.
constexpr double kSlack = 1e-12;

bool contains(const Range& range, double value) {
  const double slack = kSlack * std::abs(value);
  return value >= range.lower - slack && value <= range.upper + slack;
}

/// The velocities that leave room to bring the acceleration to zero: at a start those reached later count, at an end
/// those come from.
Range velocitiesWith(double acceleration, const AxisLimits& limits, bool starting) {
  const double square = 0.5 * acceleration * acceleration;
  Range range = limits.velocity;
  if (acceleration == 0.0) return range;
  if (starting == (acceleration > 0.0)) {
    range.upper += square / limits.jerk.lower;
  } else {
    range.lower += square / limits.jerk.upper;
  }
  return range;
}

bool usable(const Range& range) {
  return range.lower < 0.0 && range.upper > 0.0;
}

}  // namespace

StateCheck checkState(const EndState& state, const AxisLimits& limits, bool starting) {
  const bool finite_jerk = std::isfinite(limits.jerk.lower) && std::isfinite(limits.jerk.upper);
  if (!finite_jerk || !usable(limits.jerk)) return {StateFault::kLimits, limits.jerk.upper, {}};
  if (!usable(limits.velocity)) return {StateFault::kLimits, limits.velocity.upper, {}};
  if (!usable(limits.acceleration)) return {StateFault::kLimits, limits.acceleration.upper, {}};
  for (double value : {state.position, state.velocity, state.acceleration}) {
    if (!std::isfinite(value)) return {StateFault::kNotFinite, value, {}};
  }
  if (!contains(limits.acceleration, state.acceleration)) {
    return {StateFault::kAcceleration, state.acceleration, limits.acceleration};
  }
  const Range velocities = velocitiesWith(state.acceleration, limits, starting);
  if (!contains(velocities, state.velocity)) return {StateFault::kVelocity, state.velocity, velocities};
  return {};
}

namespace {

/// As brakePhases(), for a state that is too fast or too strong upwards.
EndState brakeUpward(const EndState& state, const AxisLimits& limits, JerkPhases& phases) {
  const double down = -limits.jerk.lower;
  EndState now = state;
  const auto go = [&](double length, double jerk) {
    if (!(length > 0.0)) return;
    phases.append(length, jerk);
    now = advanced(now, jerk, length);
  };
  // Down to the acceleration limit.
  go((now.acceleration - limits.acceleration.upper) / down, -down);
  const double excess = now.velocity - limits.velocity.upper;
  const double square = 0.5 * now.acceleration * now.acceleration / down;
  if (excess + (now.acceleration > 0.0 ? square : 0.0) <= 0.0) return now;
  // Through zero to the acceleration with which the velocity meets its limit, or the least one, held until it does; not
  // so far that the way back up would pass the other velocity limit.
  const double range = limits.velocity.upper - limits.velocity.lower;
  const double trough = std::max({limits.acceleration.lower, -std::sqrt(2.0 * (excess + square) * down),
                                  -std::sqrt(2.0 * range * limits.jerk.upper)});
  if (now.acceleration > trough) go((now.acceleration - trough) / down, -down);
  if (now.velocity > limits.velocity.upper && now.acceleration < 0.0) {
    go((now.velocity - limits.velocity.upper) / -now.acceleration, 0.0);
  }
  return now;
}

EndState turned(const EndState& state) {
  return {-state.position, -state.velocity, -state.acceleration};
}

Range turned(const Range& range) {
  return {-range.upper, -range.lower};
}

/// The state moved into the limits, where only rounding has left it outside.
bool settle(EndState& state, const AxisLimits& limits) {
  constexpr double kRounding = 1e-9;
  const auto moved = [](double value, const Range& range) {
    return std::min(std::max(value, range.lower), range.upper);
  };
  const double a = moved(state.acceleration, limits.acceleration);
  const double v = moved(state.velocity, velocitiesWith(a, limits, true));
  const bool close = std::abs(a - state.acceleration) <= kRounding * std::abs(a) &&
                     std::abs(v - state.velocity) <= kRounding * limits.velocity.peak();
  if (close) state = {state.position, v, a};
  return close;
}

}  // namespace

void appendChange(const EndState& state, double velocity, const AxisLimits& limits, JerkPhases& phases) {
  const double a = state.acceleration;
  const double back = a > 0.0 ? -limits.jerk.lower : limits.jerk.upper;
  const bool up = velocity >= state.velocity + 0.5 * a * std::abs(a) / back;
  const double sign = up ? 1.0 : -1.0;
  const double rise = up ? limits.jerk.upper : -limits.jerk.lower;
  const double fall = up ? -limits.jerk.lower : limits.jerk.upper;
  const double most = up ? limits.acceleration.upper : -limits.acceleration.lower;
  const double m = 1.0 / rise + 1.0 / fall;
  const double squared = std::max(0.0, (2.0 * sign * (velocity - state.velocity) + a * a / rise) / m);
  const double peak = std::min(most, std::sqrt(squared));
  phases.append((peak - sign * a) / rise, sign * rise);
  if (squared > most * most) phases.append(0.5 * (squared - most * most) * m / most, 0.0);
  phases.append(peak / fall, -sign * fall);
}

EndState brakePhases(const EndState& state, const AxisLimits& limits, JerkPhases& phases) {
  if (checkState(state, limits, true).fault == StateFault::kNone) return state;
  const std::size_t before = phases.count;
  const EndState once = brakeUpward(state, limits, phases);
  const std::size_t first = phases.count;
  const AxisLimits other{turned(limits.velocity), turned(limits.acceleration), turned(limits.jerk), {}};
  EndState last = turned(brakeUpward(turned(once), other, phases));
  for (std::size_t k = first; k < phases.count; ++k) phases.phases[k].jerk = -phases.phases[k].jerk;
  if (settle(last, limits)) return last;
  // The limits are too near to each other for that: to the nearest constant velocity.
  phases.count = before;
  EndState now = state;
  const Range& most = limits.acceleration;
  const double inside = std::min(std::max(state.acceleration, most.lower), most.upper);
  if (inside != state.acceleration) {
    const double jerk = inside > state.acceleration ? limits.jerk.upper : limits.jerk.lower;
    const double length = (inside - state.acceleration) / jerk;
    phases.append(length, jerk);
    now = advanced(state, jerk, length);
    now.acceleration = inside;
  }
  const double velocity = std::min(std::max(now.velocity, limits.velocity.lower), limits.velocity.upper);
  const std::size_t changed = phases.count;
  appendChange(now, velocity, limits, phases);
  for (std::size_t k = changed; k < phases.count; ++k) now = advanced(now, phases.phases[k], phases.phases[k].length);
  return {now.position, velocity, 0.0};
}

}  // namespace screwline
