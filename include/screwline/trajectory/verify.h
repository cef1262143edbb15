#ifndef SCREWLINE_TRAJECTORY_VERIFY_H
#define SCREWLINE_TRAJECTORY_VERIFY_H

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "screwline/trajectory/limits.h"

namespace screwline {

/// What a motion must pass: joint j is at position(j) at an instant, with velocity(j) and acceleration(j) where these
/// are given (empty: not). At an interior corner a stepping derivative is that of the later piece.
struct Checkpoint {
  double time = 0.0;
  VectorX position;
  VectorX velocity;
  VectorX acceleration;

  Checkpoint(double at, VectorX where, VectorX rate = {}, VectorX rate_of_rate = {})
      : time(at), position(std::move(where)), velocity(std::move(rate)), acceleration(std::move(rate_of_rate)) {}
};

/// Proves a motion over all of its time, not at samples: intervals that hold all values of a stretch (enclosure.h) are
/// narrowed until they lie within the bound. Every value is finite, the finite orders keep the limits, positions keep
/// their bounds, derivatives up to the promised continuity do not step anywhere (ends joined to rest included), and the
/// checkpoints, in order of time, are met. It reads the trajectory only, pieces, scalings s(tau) and sinusoids alike,
/// and by another method than the extrema that motions are planned with.
/// @return nothing, or what is broken: joint, order, time, value and bound.
std::optional<std::string> verifyTrajectory(const JointTrajectory& trajectory, const Limits& limits,
                                            const std::vector<Checkpoint>& checkpoints);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_VERIFY_H
