#include "screwline/model/limits.h"

#include <cmath>

#include "screwline/exception.h"
#include "text.h"

namespace screwline {
namespace {

void setRate(const std::optional<double>& given, const std::string& what, double& value, bool& assumed) {
  if (!given) return;
  if (!(*given > 0.0) || *given > kMaxMagnitude) {
    throw ModelError(what + " limit is " + numberText(*given) + ", it must be above 0 and at most " +
                     numberText(kMaxMagnitude));
  }
  value = *given;
  assumed = false;
}

}  // namespace

JointLimits withAssumedRates(JointLimits limits) {
  if (std::isinf(limits.velocity)) {
    limits.velocity = kAssumedVelocity;
    limits.velocity_assumed = true;
  }
  if (std::isinf(limits.acceleration)) {
    limits.acceleration = limits.velocity / kAssumedAccelerationTime;
    limits.acceleration_assumed = true;
  }
  if (std::isinf(limits.jerk)) {
    limits.jerk = limits.acceleration / kAssumedJerkTime;
    limits.jerk_assumed = true;
  }
  return limits;
}

SerialChain withRateLimits(const SerialChain& chain, const std::map<std::string, RateLimits>& limits_of) {
  ChainDescription description{chain.name(), chain.baseLink(), chain.tipLink(), chain.joints(),
                               chain.axes(), chain.home(),     chain.links(),   chain.modifiedDh()};
  for (Joint& joint : description.joints) {
    const auto found = limits_of.find(joint.name);
    if (found == limits_of.end()) continue;
    const std::string who = "joint '" + joint.name + "': ";
    JointLimits& limits = joint.limits;
    if (limits.acceleration_assumed) limits.acceleration = std::numeric_limits<double>::infinity();
    if (limits.jerk_assumed) limits.jerk = std::numeric_limits<double>::infinity();
    setRate(found->second.velocity, who + "velocity", limits.velocity, limits.velocity_assumed);
    setRate(found->second.acceleration, who + "acceleration", limits.acceleration, limits.acceleration_assumed);
    setRate(found->second.jerk, who + "jerk", limits.jerk, limits.jerk_assumed);
    limits = withAssumedRates(limits);
  }
  return SerialChain(std::move(description));
}

}  // namespace screwline
