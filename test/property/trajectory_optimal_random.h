#ifndef SCREWLINE_TEST_PROPERTY_TRAJECTORY_OPTIMAL_RANDOM_H
#define SCREWLINE_TEST_PROPERTY_TRAJECTORY_OPTIMAL_RANDOM_H

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>

#include "screwline/trajectory/state_to_state.h"

namespace screwline {
namespace trajectory_test {

/// SCREWLINE_LAW_COUNT, else the given number.
inline int lawCount(int fallback) {
  const char* given = std::getenv("SCREWLINE_LAW_COUNT");
  return given != nullptr ? std::atoi(given) : fallback;
}

/// Questions of all kinds: any scale, limits symmetric or not, ends at rest, at their limits, equal, or anywhere.
class Questions {
 public:
  explicit Questions(unsigned seed) : engine_(seed) {}

  double uniform(double lower, double upper) { return std::uniform_real_distribution<double>(lower, upper)(engine_); }
  int integer(int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(engine_); }
  double power(double lower, double upper) { return std::pow(10.0, uniform(lower, upper)); }

  AxisLimits limits(bool wild) {
    const double spread = wild ? 2.0 : 0.7;
    AxisLimits l = AxisLimits::symmetric(power(-spread, spread), power(-spread, spread), power(-spread, 1.5 * spread));
    if (integer(0, 1) == 0) return l;
    for (Range* range : {&l.velocity, &l.acceleration, &l.jerk}) range->lower *= power(-0.5, 0.5);
    return l;
  }

  /// A state that checkState() accepts.
  EndState state(const AxisLimits& l, bool starting) {
    for (;;) {
      EndState s{uniform(-3.0, 3.0), part(l.velocity), part(l.acceleration)};
      if (integer(0, 3) == 0) s.velocity = s.acceleration = 0.0;
      if (integer(0, 3) == 0) s.acceleration = 0.0;
      if (checkState(s, l, starting).fault == StateFault::kNone) return s;
    }
  }

  void fill(StateToState& question, int joints) {
    question.joints = joints;
    question.least_duration = integer(0, 9) == 0 ? uniform(0.0, 8.0) : 0.0;
    const bool wild = integer(0, 3) == 0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(joints); ++j) {
      question.limits[j] = limits(wild);
      question.from[j] = state(question.limits[j], true);
      question.to[j] = state(question.limits[j], false);
      if (integer(0, 9) == 0) question.to[j].position = question.from[j].position;
      if (integer(0, 9) == 0) question.to[j].position = question.from[j].position + power(-9.0, 0.0);
      if (integer(0, 19) == 0) question.to[j] = question.from[j];
      if (checkState(question.to[j], question.limits[j], false).fault != StateFault::kNone) question.to[j] = {};
    }
  }

 private:
  double part(const Range& range) {
    const int kind = integer(0, 11);
    if (kind == 0) return range.lower;
    if (kind == 1) return range.upper;
    if (kind == 2) return 0.0;
    return uniform(range.lower, range.upper);
  }

  std::mt19937 engine_;
};

/// What is wrong with a motion: empty, or the law it breaks.
inline std::string brokenLaw(const StateToState& question, const StateToStateMotion& motion) {
  for (std::size_t j = 0; j < static_cast<std::size_t>(question.joints); ++j) {
    const AxisLimits& l = question.limits[j];
    const AxisLimits e = motion.phases[j].extent();
    const EndState end = motion.phases[j].end();
    const EndState& goal = question.to[j];
    const std::string joint = " of joint " + std::to_string(j);
    const auto outside = [](const Range& range, const Range& bound) {
      const double slack = 1e-9;
      return !(range.lower >= bound.lower * (1.0 + slack) && range.upper <= bound.upper * (1.0 + slack));
    };
    if (outside(e.velocity, l.velocity)) return "velocity" + joint;
    if (outside(e.acceleration, l.acceleration)) return "acceleration" + joint;
    if (outside(e.jerk, l.jerk)) return "jerk" + joint;
    const double T = motion.duration;
    const double reach = std::max({1.0, std::abs(goal.position), e.position.peak()});
    if (!(std::abs(end.position - goal.position) <= 1e-8 * reach)) return "end position" + joint;
    if (!(std::abs(end.velocity - goal.velocity) <= 1e-8 * std::max(1.0, e.velocity.peak()))) {
      return "end velocity" + joint;
    }
    if (!(std::abs(end.acceleration - goal.acceleration) <= 1e-8 * std::max(1.0, e.acceleration.peak()))) {
      return "end acceleration" + joint;
    }
    if (!(std::abs(motion.phases[j].duration() - T) <= 1e-11 * T + 1e-14)) return "duration" + joint;
    if (!(T >= motion.shortest[j] && T >= question.least_duration)) return "least duration" + joint;
  }
  return {};
}

}  // namespace trajectory_test
}  // namespace screwline

#endif  // SCREWLINE_TEST_PROPERTY_TRAJECTORY_OPTIMAL_RANDOM_H
