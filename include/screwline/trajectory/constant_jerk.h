#ifndef SCREWLINE_TRAJECTORY_CONSTANT_JERK_H
#define SCREWLINE_TRAJECTORY_CONSTANT_JERK_H

#include <array>
#include <cstddef>
#include <limits>

#include "screwline/trajectory/hermite.h"
#include "screwline/trajectory/polynomial.h"

namespace screwline {

/// What one joint may do, each order with a least and a greatest value: rad (or m) and s. Infinite where unlimited.
struct AxisLimits {
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  Range velocity{-kNone, kNone};
  Range acceleration{-kNone, kNone};
  Range jerk{-kNone, kNone};
  Range position{-kNone, kNone};

  static AxisLimits symmetric(double velocity, double acceleration, double jerk) {
    return {{-velocity, velocity}, {-acceleration, acceleration}, {-jerk, jerk}, {-kNone, kNone}};
  }
};

/// The state `t` seconds after `state` under a constant jerk. Defined here: the planner's innermost step.
inline EndState advanced(const EndState& state, double jerk, double t) {
  return {state.position + t * (state.velocity + t * (0.5 * state.acceleration + t * jerk / 6.0)),
          state.velocity + t * (state.acceleration + 0.5 * t * jerk), state.acceleration + t * jerk};
}

struct JerkPhase {
  double length = 0.0;  ///< [s] Positive.
  double jerk = 0.0;
  bool cruise = false;  ///< No acceleration either: what rounding left of it would grow with the square of the time.
};

/// The state `t` seconds into a phase that is entered in `state`.
inline EndState advanced(const EndState& state, const JerkPhase& phase, double t) {
  if (phase.cruise) return {state.position + t * state.velocity, state.velocity, 0.0};
  return advanced(state, phase.jerk, t);
}

/// The motion of one joint as phases of constant jerk from a start state: C2, at most kCapacity phases. A plain value
/// of fixed size: nothing here allocates or throws.
struct JerkPhases {
  static constexpr std::size_t kCapacity = 24;

  EndState start;
  std::size_t count = 0;
  std::array<JerkPhase, kCapacity> phases;

  /// Appends a phase; one that takes no time is left out. @pre room for it.
  void append(double length, double jerk, bool cruise = false) {
    if (length > 0.0) phases[count++] = {length, jerk, cruise};
  }

  double duration() const;
  EndState end() const;
  /// At t [s]; before 0 and after the duration the ends are held in position, with no velocity or acceleration.
  EndState at(double t) const;

  /// Exact ranges of position, velocity and acceleration on the way (ends included), and of the jerk.
  AxisLimits extent() const;
};

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_CONSTANT_JERK_H
