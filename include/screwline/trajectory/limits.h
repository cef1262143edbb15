#ifndef SCREWLINE_TRAJECTORY_LIMITS_H
#define SCREWLINE_TRAJECTORY_LIMITS_H

#include <string>

#include "screwline/spatial/pose.h"
#include "screwline/trajectory/joint_trajectory.h"

namespace screwline {

/// Least and greatest finite entry of velocity, acceleration and jerk: beyond them times and distances that a request
/// may ask for leave the digits of a double.
constexpr double kLeastLimit = 1e-9;
constexpr double kGreatestLimit = 1e12;

/// What each joint may do, in rad (or m) and s. Every entry of the first three lies in [kLeastLimit, kGreatestLimit] or
/// is infinite: unlimited.
struct Limits {
  VectorX velocity;
  VectorX acceleration;
  VectorX jerk;
  VectorX lower;  ///< Position bounds; empty: none. An entry may be infinite.
  VectorX upper;

  static Limits unlimited(int joints);
  int joints() const { return static_cast<int>(velocity.size()); }
  double bound(int joint, int order) const;  ///< Order 1 velocity, 2 acceleration, 3 jerk.
};

/// How near a motion comes to one limit. No allocation.
struct LimitUse {
  int joint = 0;
  int order = 1;       ///< 1 velocity, 2 acceleration, 3 jerk.
  double value = 0.0;  ///< Peak of that order.
  double bound = 0.0;
  double stretch = 0.0;  ///< (value / bound)^(1/order): the factor of time that brings the peak to the bound.
};

/// Orders that are held: a limit on an order that steps to infinity cannot be kept by any duration, so only finite ones
/// count. Returns the use with the greatest stretch over joints and finite orders; stretch 0 where nothing moves or
/// nothing is bounded.
LimitUse tightestUse(const JointTrajectory& trajectory, const Limits& limits);

/// "joint 2 would reach acceleration 9.4, its limit is 5"
std::string describe(const LimitUse& use);

/// @throws InputError naming the field, its value and the bound: sizes other than `joints`, a limit out of its range,
/// bounds that are no numbers or not ordered.
void validateLimits(const Limits& limits, int joints);

/// Each order multiplied by its factor in (0, 1]. @throws InputError for a factor outside, or one that brings a limit
/// below kLeastLimit.
Limits scaledLimits(const Limits& limits, double velocity_scaling, double acceleration_scaling, double jerk_scaling);

/// [s] No motion that moves is planned shorter than this, and no given time is taken below it.
constexpr double kShortestTime = 1e-6;

/// A peak may pass its limit by this fraction: rounding of the exact extrema, nothing more.
constexpr double kLimitTolerance = 1e-9;

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_LIMITS_H
