#include "screwline/trajectory/double_s.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "screwline/trajectory/axis_motion.h"

namespace screwline {
namespace {

bool symmetric(const Range& range) {
  return range.lower == -range.upper;
}

JerkPhases symmetricDoubleS(double v, double a, double j) {
  double ramp = 0.0;     // Of the acceleration, up or down.
  double plateau = 0.0;  // At the greatest acceleration.
  double cruise = 0.0;
  const double accelerating = std::isfinite(v) ? (v >= a * a / j ? v / a + a / j : 2.0 * std::sqrt(v / j)) : 0.0;
  if (std::isfinite(v) && v * accelerating <= 1.0) {
    ramp = std::min(a / j, 0.5 * accelerating);
    plateau = accelerating - 2.0 * ramp;
    cruise = 1.0 / v - accelerating;
  } else {
    ramp = std::min(std::cbrt(0.5 / j), a / j);
    if (a * ramp < 0.5 / ramp) {  // Acceleration is held: of the peak V, V (V/a + a/j) = 1.
      const double r = a / j;
      const double peak = 2.0 / (r + std::sqrt(r * r + 4.0 / a));
      plateau = std::max(0.0, peak / a - r);
    }
  }
  JerkPhases phases;
  const double lengths[] = {ramp, plateau, ramp, cruise, ramp, plateau, ramp};
  const double signs[] = {1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0};
  for (int k = 0; k < 7; ++k) phases.append(lengths[k], signs[k] * j, k == 3);
  return phases;
}

}  // namespace

JerkPhases shortestDoubleS(const AxisLimits& limits) {
  if (symmetric(limits.acceleration) && symmetric(limits.jerk)) {
    return symmetricDoubleS(limits.velocity.upper, limits.acceleration.upper, limits.jerk.upper);
  }
  JerkPhases phases;
  const AxisMotion motion({}, {1.0, 0.0, 0.0}, limits);
  motion.appendPhases(motion.nextDuration(0.0), phases);
  return phases;
}

AxisLimits narrowed(const AxisLimits& limits, const AxisLimits& joint, double displacement) {
  const auto met = [&](const Range& range, const Range& bound) {
    const double ends[] = {bound.lower / displacement, bound.upper / displacement};
    return Range{std::max(range.lower, std::min(ends[0], ends[1])), std::min(range.upper, std::max(ends[0], ends[1]))};
  };
  return {met(limits.velocity, joint.velocity), met(limits.acceleration, joint.acceleration),
          met(limits.jerk, joint.jerk), limits.position};
}

TimeLaw timeLawOf(const JerkPhases& phases) {
  const double T = phases.duration();
  std::vector<double> breaks{0.0};
  double t = 0.0;
  for (std::size_t k = 0; k < phases.count; ++k) breaks.push_back((t += phases.phases[k].length) / T);
  breaks.back() = 1.0;
  PiecewisePolynomial pieces(1, 3, std::move(breaks), 2);
  EndState state = phases.start;
  for (std::size_t k = 0; k < phases.count; ++k) {
    const double h = phases.phases[k].length;
    const double jerk = phases.phases[k].jerk;
    pieces.setPiece(k, 0,
                    {{state.position, state.velocity * h, 0.5 * state.acceleration * h * h, jerk * h * h * h / 6.0}});
    state = advanced(state, phases.phases[k], h);
  }
  return TimeLaw(std::move(pieces));
}

}  // namespace screwline
