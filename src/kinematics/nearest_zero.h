#ifndef SCREWLINE_SRC_KINEMATICS_NEAREST_ZERO_H
#define SCREWLINE_SRC_KINEMATICS_NEAREST_ZERO_H

#include <optional>
#include <vector>

#include "factor_fit.h"

namespace screwline {

/// Bounds of the search: the joint limits, or none.
struct Box {
  VectorX lower;
  VectorX upper;

  VectorX clamped(const VectorX& q) const { return q.cwiseMax(lower).cwiseMin(upper); }
};

/// A zero of a smooth function, changing sign, that is nearest to q within the box, as far as the search sees: first
/// sign changes along single joints (and, of few joints, pairs) to both sides, each then moved to where |q' - q| is
/// stationary on f = 0 (sequential quadratic programming under box constraints). Only `joints` move; the others stay at
/// the clamped q. None: no sign change was found.
std::optional<VectorX> nearestZero(const JointFunction& f, const SerialChain& chain, const std::vector<int>& joints,
                                   const VectorX& q, const Box& box);

/// A configuration where the task Jacobian has less than full rank: sequential quadratic programming on the conditions
/// that its smallest singular value (with the null directions beside it, where it is not square) is zero, from q and
/// from the lowest points of `volume` (the manipulability squared) along single joints. None: no start led to one.
std::optional<VectorX> nearestRankDrop(const TaskDeterminant& volume, const VectorX& q, const Box& box);

}  // namespace screwline

#endif  // SCREWLINE_SRC_KINEMATICS_NEAREST_ZERO_H
