#ifndef SCREWLINE_TRAJECTORY_AXIS_MOTION_H
#define SCREWLINE_TRAJECTORY_AXIS_MOTION_H

#include "screwline/trajectory/constant_jerk.h"
#include "screwline/trajectory/extreme_motion.h"

namespace screwline {

/// What is wrong with an end state; kNone where nothing is.
enum class StateFault {
  kNone,
  kLimits,  ///< A limit is not usable: lower < 0 < upper, jerk finite.
  kNotFinite,
  kAcceleration,  ///< Outside its limits.
  kVelocity,      ///< Outside its limits, or the acceleration cannot be brought to zero before it would be.
  kPosition,      ///< Outside its limits.
};

/// The value that broke, and what would have done (with the state's other values as they are).
struct StateCheck {
  StateFault fault = StateFault::kNone;
  double value = 0.0;
  Range feasible;
};

/// Whether a motion can end in (or, `starting`, begin from) a state within the limits. A starting state that fails may
/// still be served: see brakePhases().
StateCheck checkState(const EndState& state, const AxisLimits& limits, bool starting);

/// From a state outside the limits back to them, as fast as jerk allows; appends to `phases` and returns the state
/// reached. A state from which the limits can be kept is returned as it is.
EndState brakePhases(const EndState& state, const AxisLimits& limits, JerkPhases& phases);

/// Appends the fastest change of a state to a constant velocity, wherever that leads. @pre acceleration within limits.
void appendChange(const EndState& state, double velocity, const AxisLimits& limits, JerkPhases& phases);

/// Jerk-limited motions of one joint between two states. Which durations it can have: all from its least one on, but
/// for at most two blocked intervals (a joint that moves can not wait without coming back). A motion in T is a convex
/// combination of the two extreme ones in T, so it keeps every limit that they keep and meets both ends.
/// Nothing here allocates or throws.
class AxisMotion {
 public:
  AxisMotion() = default;
  /// @pre both states pass checkState().
  AxisMotion(const EndState& first, const EndState& last, const AxisLimits& limits);

  /// The least feasible duration that is not less than T [s].
  double nextDuration(double T) const;

  /// The phases of a motion that takes exactly T are appended. @pre T comes from nextDuration().
  void appendPhases(double T, JerkPhases& phases) const;

 private:
  double displacement_ = 0.0;
  double grain_ = 0.0;     ///< What rounding of the given positions leaves open.
  double speed_ = 0.0;     ///< Larger of the end velocities' magnitudes.
  double settling_ = 0.0;  ///< [s] To change the end accelerations by themselves.
  bool rests_ = true;      ///< At both ends.
  ExtremeMotion up_;
  ExtremeMotion down_;
};

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_AXIS_MOTION_H
