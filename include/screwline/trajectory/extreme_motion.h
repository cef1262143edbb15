#ifndef SCREWLINE_TRAJECTORY_EXTREME_MOTION_H
#define SCREWLINE_TRAJECTORY_EXTREME_MOTION_H

#include <array>
#include <limits>

#include "screwline/trajectory/constant_jerk.h"

namespace screwline {

/// The motion of one joint that gets farthest up in a given time T between two given velocities and accelerations,
/// within velocity, acceleration and jerk limits. For a fixed T the motions within limits form a convex set, so the
/// displacements that can be had in T are an interval; this class knows its upper end, and with all signs turned
/// (`downward`) its lower one.
///
/// Pontryagin's principle: jerk is at its upper limit, its lower one, its upper one, with plateaus of greatest and of
/// least acceleration between, and of greatest velocity where the acceleration falls through zero. That is a closed
/// form for each T. Sources: Pontryagin et al., The Mathematical Theory of Optimal Processes, ch. I and VI; Biagiotti &
/// Melchiorri, section 3.4, for the phases.
class ExtremeMotion {
 public:
  /// Up: jerk +; top: 0; down: -; cruise: 0; down again: -; bottom: 0; up: +.
  struct Arc {
    std::array<double, 7> length{};
    double displacement = 0.0;
    double slope = 0.0;  ///< Derivative of the displacement by T.
  };

  /// Velocity and acceleration alone: T can be had in [least, last] and from `next` on.
  struct Window {
    double last = std::numeric_limits<double>::infinity();
    double next = 0.0;
  };

  ExtremeMotion() = default;
  /// @pre finite jerk limits, lower < 0 < upper in each order, ends from which the limits can be kept.
  ExtremeMotion(const EndState& first, const EndState& last, const AxisLimits& limits);
  /// The same seen upside down: displacements change their sign.
  static ExtremeMotion downward(const EndState& first, const EndState& last, const AxisLimits& limits);

  /// Least T between the accelerations alone.
  double least() const;
  /// Where acceleration at its upper limit is enough for the change of velocity.
  Window window() const;

  /// @pre T is one that velocity and acceleration allow.
  Arc at(double T) const;

  /// The first instant after `from`, where the arc falls short of it, with a displacement of `distance`; infinity where
  /// there is none before `end`. The displacement is concave in T, then convex up to the first cruise, then linear.
  double reach(double distance, double from, Arc at_from, double end) const;

  /// Jerks of the seven phases.
  std::array<double, 7> jerks() const { return {ju_, 0.0, -jd_, 0.0, -jd_, 0.0, ju_}; }

 private:
  void prepare();
  void finish(Arc& arc) const;
  Arc withPlateaus(double T, double peak, double trough) const;
  Arc arcOf(double peak, double top, double trough, double bottom) const;
  double inflection() const;
  double crest(double rising, double falling, Arc& arc) const;
  double bracketEnd(double from, double distance, Arc& arc) const;
  double solve(double distance, double low, Arc at_low, double high, Arc at_high) const;

  double v0_ = 0.0, a0_ = 0.0, v1_ = 0.0, a1_ = 0.0;
  double vmax_ = 0.0, amax_ = 0.0, amin_ = 0.0;
  double ju_ = 0.0, jd_ = 0.0;    ///< Magnitudes of the greatest and the least jerk.
  double iju_ = 0.0, ijd_ = 0.0;  ///< Their inverses.
  double m_ = 0.0;                ///< 1/ju + 1/jd.
  double inverse_m_ = 0.0;
  double sum_scale_ = 0.0;    ///< (A - B) (A + B) of peak A and trough B without plateaus.
  double cruise_from_ = 0.0;  ///< T from which on the velocity limit is reached.
  Arc fastest_;               ///< The arc there.
};

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_EXTREME_MOTION_H
