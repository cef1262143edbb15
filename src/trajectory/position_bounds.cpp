#include "position_bounds.h"

#include <algorithm>
#include <cmath>

namespace screwline {
namespace {

constexpr double kSlack = 1e-10;

Range turned(const Range& range) {
  return {-range.upper, -range.lower};
}

bool inside(const Range& positions, const Range& bound) {
  return positions.lower >= bound.lower - kSlack && positions.upper <= bound.upper + kSlack;
}

/// The motion in T by way of a constant velocity, entered and left as fast as can be; nothing where T is too short.
bool appendByCruise(const EndState& first, const EndState& last, const AxisLimits& limits, double velocity, double T,
                    JerkPhases& phases) {
  JerkPhases change;
  appendChange(first, velocity, limits, change);
  JerkPhases leave;
  AxisLimits backwards = limits;  // Seen backwards and upside down: velocity and jerk keep their signs.
  backwards.acceleration = turned(limits.acceleration);
  appendChange({0.0, last.velocity, -last.acceleration}, velocity, backwards, leave);
  const double cruise = T - change.duration() - leave.duration();
  if (cruise < 0.0) return false;
  for (std::size_t k = 0; k < change.count; ++k) phases.append(change.phases[k].length, change.phases[k].jerk);
  phases.append(cruise, 0.0, true);
  for (std::size_t k = leave.count; k-- > 0;) phases.append(leave.phases[k].length, leave.phases[k].jerk);
  return true;
}

constexpr int kScan = 32;

/// Velocities that are worth a try: `share` of the way from the lowest to the highest.
double triedVelocity(const EndState& from, const EndState& to, const AxisLimits& limits, double T, double share) {
  const double settling = 0.5 / limits.jerk.upper - 0.5 / limits.jerk.lower;
  const double span = 2.0 * (std::abs(from.velocity) + std::abs(to.velocity)) +
                      4.0 * std::abs(to.position - from.position) / T +
                      2.0 * settling * (from.acceleration * from.acceleration + to.acceleration * to.acceleration);
  const double low = std::max(limits.velocity.lower, -span);
  return low + (std::min(limits.velocity.upper, span) - low) * share;
}

/// Among the motions by way of a constant velocity one that meets the goal and stays inside. Displacements rise with
/// the velocity: between neighbours of a scan on either side of the goal it is found by halving.
bool cruiseInside(const StateToState& question, std::size_t j, double T, std::size_t braking, JerkPhases& phases) {
  const AxisLimits& limits = question.limits[j];
  phases.count = braking;
  const EndState from = phases.end();
  const EndState& to = question.to[j];
  const auto miss = [&](double velocity) {
    phases.count = braking;
    if (!appendByCruise(from, to, limits, velocity, T, phases)) return std::nan("");
    return phases.end().position - to.position;
  };
  double before = triedVelocity(from, to, limits, T, 0.0);
  double miss_before = miss(before);
  for (int i = 1; i <= kScan; ++i) {
    const double velocity = triedVelocity(from, to, limits, T, double(i) / kScan);
    const double miss_here = miss(velocity);
    double lower = before;
    double upper = velocity;
    before = velocity;
    const bool between = miss_before <= 0.0 && miss_here >= 0.0;
    miss_before = miss_here;
    if (!between) continue;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (lower + upper);
      (miss(middle) < 0.0 ? lower : upper) = middle;
    }
    miss(upper);
    if (std::abs(phases.end().position - to.position) < kSlack && inside(phases.extent().position, limits.position)) {
      return true;
    }
  }
  return false;
}

/// First as fast as can be to some velocity, from there any motion to the goal in the time that is left.
bool turnInside(const StateToState& question, std::size_t j, double T, std::size_t braking, JerkPhases& phases) {
  const AxisLimits& limits = question.limits[j];
  phases.count = braking;
  const EndState from = phases.end();
  const EndState& to = question.to[j];
  for (int i = 0; i <= kScan; ++i) {
    phases.count = braking;
    appendChange(from, triedVelocity(from, to, limits, T, double(i) / kScan), limits, phases);
    double left = T;
    for (std::size_t k = braking; k < phases.count; ++k) left -= phases.phases[k].length;
    if (left < 0.0 || !inside(phases.extent().position, limits.position)) continue;
    EndState turn = phases.end();
    turn.acceleration = 0.0;
    const AxisMotion rest(turn, to, limits);
    if (rest.nextDuration(left) != left) continue;
    rest.appendPhases(left, phases);
    if (inside(phases.extent().position, limits.position)) return true;
  }
  return false;
}

/// The highest position that no braking avoids: jerk, then acceleration, at their lower limits until the joint falls.
double forcedPeak(const EndState& state, const AxisLimits& limits) {
  const double jerk = -limits.jerk.lower;
  const double least = std::max(limits.acceleration.lower,
                                -std::abs(state.acceleration) - std::sqrt(2.0 * jerk * std::abs(state.velocity)));
  JerkPhases phases;
  phases.start = state;
  phases.append((state.acceleration - least) / jerk, -jerk);
  const EndState falling = phases.end();
  if (falling.velocity > 0.0) phases.append(falling.velocity / -least, 0.0);
  return phases.extent().position.upper;
}

/// The positions that a joint passes whatever it does: after its start and before its goal.
Range forcedRange(const StateToState& question, std::size_t j) {
  const EndState& from = question.from[j];
  const EndState& to = question.to[j];
  AxisLimits limits = question.limits[j];
  AxisLimits below = limits;
  below.acceleration = turned(limits.acceleration);
  below.jerk = turned(limits.jerk);
  const auto upsideDown = [](const EndState& s) { return EndState{-s.position, -s.velocity, -s.acceleration}; };
  const auto backwards = [](const EndState& s) { return EndState{s.position, -s.velocity, s.acceleration}; };
  AxisLimits back = limits;
  AxisLimits back_below = below;
  back.jerk = turned(limits.jerk);
  back_below.jerk = turned(below.jerk);
  return {-std::max(forcedPeak(upsideDown(from), below), forcedPeak(upsideDown(backwards(to)), back_below)),
          std::max(forcedPeak(from, limits), forcedPeak(backwards(to), back))};
}

bool refuse(StateToStateMotion& motion, std::size_t j, const Range& passed, const Range& bound) {
  const bool low = passed.lower < bound.lower - kSlack;
  motion.status = MotionStatus::kPosition;
  motion.joint = static_cast<int>(j);
  motion.check = {StateFault::kPosition, low ? passed.lower : passed.upper, bound};
  return false;
}

/// Motions in T with every joint inside; returns the number of joints for which there is one, before the first failure.
std::size_t layInside(const StateToState& question, StateToStateMotion& motion, double T) {
  const std::size_t n = static_cast<std::size_t>(question.joints);
  for (std::size_t j = 0; j < n; ++j) {
    JerkPhases& phases = motion.phases[j];
    phases.count = motion.braking_phases[j];
    motion.axes[j].appendPhases(T - motion.braking[j], phases);
    if (inside(phases.extent().position, question.limits[j].position)) continue;
    const double left = T - motion.braking[j];
    const std::size_t braking = motion.braking_phases[j];
    if (cruiseInside(question, j, left, braking, phases) || turnInside(question, j, left, braking, phases)) continue;
    return j;
  }
  motion.duration = T;
  return n;
}

}  // namespace

void keepPositions(const StateToState& question, StateToStateMotion& motion) {
  const std::size_t n = static_cast<std::size_t>(question.joints);
  std::size_t out = n;
  for (std::size_t j = 0; j < n && out == n; ++j) {
    const Range& bound = question.limits[j].position;
    const bool bounded = std::isfinite(bound.lower) || std::isfinite(bound.upper);
    if (bounded && !inside(motion.phases[j].extent().position, bound)) out = j;
  }
  if (out == n) return;
  motion.straight = false;
  for (std::size_t j = 0; j < n; ++j) {
    const Range forced = forcedRange(question, j);
    if (!inside(forced, question.limits[j].position)) {
      refuse(motion, j, forced, question.limits[j].position);
      return;
    }
  }
  // Upwards in steps of 2 %; then halved down to the shortest found in between.
  constexpr double kStep = 1.02;
  constexpr int kMostSteps = 250;
  double failed = 0.0;
  double T = motion.duration;
  for (int i = 0; i < kMostSteps; ++i) {
    out = layInside(question, motion, T);
    if (out == n) break;
    failed = T;
    T = commonDuration(motion, T * kStep);
  }
  if (out < n) {
    const Range& bound = question.limits[out].position;
    motion.phases[out].count = motion.braking_phases[out];
    motion.axes[out].appendPhases(motion.duration - motion.braking[out], motion.phases[out]);
    refuse(motion, out, motion.phases[out].extent().position, bound);
    return;
  }
  for (int i = 0; i < 20 && failed > 0.0; ++i) {
    const double middle = commonDuration(motion, 0.5 * (failed + T));
    if (middle >= T) break;
    if (layInside(question, motion, middle) == n) {
      T = middle;
    } else {
      failed = middle;
    }
  }
  layInside(question, motion, T);
}

}  // namespace screwline
