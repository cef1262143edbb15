#ifndef SCREWLINE_TRAJECTORY_VERIFY_H
#define SCREWLINE_TRAJECTORY_VERIFY_H

#include <optional>
#include <string>
#include <vector>

#include "screwline/trajectory/limits.h"

namespace screwline {

/// What a motion must pass: joint j is at position(k) at instant(k).
struct Checkpoint {
  double time = 0.0;
  VectorX position;
};

/// Proves a motion by exact extrema of every piece, not by samples: every figure is finite, the peaks of the finite
/// orders keep the limits, positions keep their bounds, derivatives up to the promised continuity do not step anywhere
/// (ends joined to rest included), and the checkpoints are met. Independent of how the motion was built: it reads the
/// trajectory only.
/// @return nothing, or what is broken: joint, order, value and bound. Allocates only for the message.
std::optional<std::string> verifyTrajectory(const JointTrajectory& trajectory, const Limits& limits,
                                            const std::vector<Checkpoint>& checkpoints);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_VERIFY_H
