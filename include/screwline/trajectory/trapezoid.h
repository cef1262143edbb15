#ifndef SCREWLINE_TRAJECTORY_TRAPEZOID_H
#define SCREWLINE_TRAJECTORY_TRAPEZOID_H

#include <optional>

namespace screwline {

/// What a request fixes of a trapezoidal velocity profile: at most two of the four. [rad/s, rad/s^2, s, s] (or m)
struct TrapezoidSpec {
  std::optional<double> peak_velocity;
  std::optional<double> acceleration;
  std::optional<double> duration;
  std::optional<double> acceleration_time;
};

/// All four, consistent: distance = peak_velocity * (duration - acceleration_time).
struct Trapezoid {
  double peak_velocity = 0.0;
  double acceleration = 0.0;
  double duration = 0.0;
  double acceleration_time = 0.0;

  double blendFraction() const { return duration > 0.0 ? acceleration_time / duration : 1.0 / 3.0; }
};

/// The trapezoid over `distance` (>= 0) [rad or m] that two of the four define; with one or none the rest is a profile
/// of equal thirds (with none of them it takes 1 s). No distance: it holds for the given duration.
/// @throws InputError where more than two are given, one is not positive and finite, or a pair is infeasible: the
/// message names the feasible range. Does not allocate otherwise. Source: Biagiotti & Melchiorri, section 3.2.
Trapezoid resolveTrapezoid(double distance, const TrapezoidSpec& spec);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_TRAPEZOID_H
