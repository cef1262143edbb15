#ifndef SCREWLINE_MODEL_LIMITS_H
#define SCREWLINE_MODEL_LIMITS_H

#include <map>
#include <optional>
#include <string>

#include "screwline/model/serial_chain.h"

namespace screwline {

/// Fills in the rates that are infinite (not given): velocity kAssumedVelocity, acceleration full speed within
/// kAssumedAccelerationTime, jerk full acceleration within kAssumedJerkTime; and marks them assumed.
JointLimits withAssumedRates(JointLimits limits);

/// Limits from beside the robot description, as MoveIt's joint_limits.yaml has them; what is empty stays as it is.
struct RateLimits {
  std::optional<double> velocity;      ///< rad/s or m/s
  std::optional<double> acceleration;  ///< per s^2
  std::optional<double> jerk;          ///< per s^3
};

/// A copy of the chain with other rate limits, by joint name. Acceleration and jerk limits that are still assumed
/// follow from the new ones. Names that are not in the chain are passed over: such files tell of the whole robot.
/// @throws ModelError where a limit is not finite, not above 0 or beyond kMaxMagnitude, naming joint, limit and value.
SerialChain withRateLimits(const SerialChain& chain, const std::map<std::string, RateLimits>& limits_of);

}  // namespace screwline

#endif  // SCREWLINE_MODEL_LIMITS_H
