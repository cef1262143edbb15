#include "screwline/trajectory/constant_jerk.h"

#include <algorithm>
#include <cmath>

namespace screwline {
namespace {

void include(Range& range, double value) {
  range.lower = std::min(range.lower, value);
  range.upper = std::max(range.upper, value);
}

/// The positions at which the velocity v + a t + j t^2 / 2 crosses zero inside the phase.
void includeTurns(Range& range, const EndState& state, const JerkPhase& phase) {
  if (phase.cruise) return;
  const double discriminant = state.acceleration * state.acceleration - 2.0 * phase.jerk * state.velocity;
  if (discriminant < 0.0) return;
  // The root with no cancellation, the other one by the product of the roots.
  const double q = -(state.acceleration + std::copysign(std::sqrt(discriminant), state.acceleration));
  for (double t : {phase.jerk != 0.0 ? q / phase.jerk : -1.0, q != 0.0 ? 2.0 * state.velocity / q : -1.0}) {
    if (t > 0.0 && t < phase.length) include(range, advanced(state, phase, t).position);
  }
}

}  // namespace

double JerkPhases::duration() const {
  double total = 0.0;
  for (std::size_t k = 0; k < count; ++k) total += phases[k].length;
  return total;
}

EndState JerkPhases::end() const {
  EndState state = start;
  for (std::size_t k = 0; k < count; ++k) state = advanced(state, phases[k], phases[k].length);
  return state;
}

EndState JerkPhases::at(double t) const {
  if (t < 0.0) return {start.position, 0.0, 0.0};
  EndState state = start;
  for (std::size_t k = 0; k < count; ++k) {
    if (t <= phases[k].length) return advanced(state, phases[k], t);
    state = advanced(state, phases[k], phases[k].length);
    t -= phases[k].length;
  }
  return t > 0.0 ? EndState{state.position, 0.0, 0.0} : state;
}

AxisLimits JerkPhases::extent() const {
  EndState state = start;
  AxisLimits extent{{state.velocity, state.velocity},
                    {state.acceleration, state.acceleration},
                    {0.0, 0.0},
                    {state.position, state.position}};
  for (std::size_t k = 0; k < count; ++k) {
    const JerkPhase& phase = phases[k];
    includeTurns(extent.position, state, phase);
    const double level = phase.jerk != 0.0 ? -state.acceleration / phase.jerk : -1.0;  // Where acceleration vanishes.
    if (level > 0.0 && level < phase.length) include(extent.velocity, advanced(state, phase, level).velocity);
    state = advanced(state, phase, phase.length);
    include(extent.position, state.position);
    include(extent.velocity, state.velocity);
    include(extent.acceleration, state.acceleration);
    include(extent.jerk, phase.jerk);
  }
  return extent;
}

}  // namespace screwline
