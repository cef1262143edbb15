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
  const double carried = excess + (now.acceleration > 0.0 ? 0.5 * now.acceleration * now.acceleration / down : 0.0);
  if (carried <= 0.0) return now;
  // Through zero to the acceleration with which the velocity meets its limit, or the least one, held until it does.
  const double trough = std::max(limits.acceleration.lower, -std::sqrt(2.0 * carried * down));
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

}  // namespace

EndState brakePhases(const EndState& state, const AxisLimits& limits, JerkPhases& phases) {
  if (checkState(state, limits, true).fault == StateFault::kNone) return state;
  const EndState once = brakeUpward(state, limits, phases);
  const std::size_t first = phases.count;
  const AxisLimits other{turned(limits.velocity), turned(limits.acceleration), turned(limits.jerk), {}};
  const EndState last = turned(brakeUpward(turned(once), other, phases));
  for (std::size_t k = first; k < phases.count; ++k) phases.phases[k].jerk = -phases.phases[k].jerk;
  return last;
}

}  // namespace screwline
