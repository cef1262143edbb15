#ifndef SCREWLINE_SRC_KINEMATICS_SAMPLING_H
#define SCREWLINE_SRC_KINEMATICS_SAMPLING_H

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "screwline/model/serial_chain.h"

namespace screwline {

/// Number `index` of a fixed sequence, uniform in [0, 1) (splitmix64): the same on every machine.
inline double fixedUniform(std::uint64_t index) {
  std::uint64_t z = (index + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
}

/// A length [m] over which slides are sampled: the chain's own, or how far its limits let slides go; 1 where neither
/// says anything.
inline double slideReach(const SerialChain& chain) {
  double reach = chain.characteristicLength();
  for (const Joint& joint : chain.joints()) {
    if (joint.isRevolute()) continue;
    for (double bound : {joint.limits.lower, joint.limits.upper}) {
      if (std::isfinite(bound)) reach = std::max(reach, std::abs(bound));
    }
  }
  return reach > 1e-5 ? reach : 1.0;
}

/// A value for joint i: any angle, or a slide within slideReach(). Limits are not looked at otherwise.
inline double sampleJoint(const SerialChain& chain, int i, int number) {
  const double unit =
      2.0 * fixedUniform(static_cast<std::uint64_t>(number) * kMaxJoints + static_cast<std::uint64_t>(i)) - 1.0;
  return unit * (chain.joint(i).isRevolute() ? kPi : slideReach(chain));
}

inline VectorX sampleConfiguration(const SerialChain& chain, int number) {
  VectorX q(chain.size());
  for (int i = 0; i < chain.size(); ++i) q[i] = sampleJoint(chain, i, number);
  return q;
}

}  // namespace screwline

#endif  // SCREWLINE_SRC_KINEMATICS_SAMPLING_H
