#ifndef SCREWLINE_SRC_IK_MATE_H
#define SCREWLINE_SRC_IK_MATE_H

#include <functional>
#include <vector>

#include "screwline/ik/task_error.h"
#include "screwline/model/serial_chain.h"
#include "screwline/spatial/weak_directions.h"

namespace screwline {

/// Whether a solution within `distance` (norm) of `place` is at hand.
using IsAtHand = std::function<bool(const VectorX& place, double distance)>;

/// Solutions about an almost singular one.
struct SolutionsAbout {
  bool is_one = true;              ///< q is a solution itself; false: rounding put it between those that are.
  bool is_told = true;             ///< False: by less than rounding from configurations all along a curve.
  std::vector<VectorX> solutions;  ///< Others, nearest first, but those that are at hand.
};

/// Along the one or two directions that the task Jacobian maps to almost nothing, the residual is a quadratic in one or
/// two unknowns (Lyapunov and Schmidt's reduction, to the second order): from each of its up to four roots Newton's
/// method goes on. Nothing where q is regular. As many joints as rows. Allocates.
/// @param known of the task Jacobian at q; null: they are found.
SolutionsAbout solutionsAbout(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& q,
                              const WeakDirections* known, const IsAtHand& at_hand);

/// Whether the pose tells q from configurations all along a curve: `is_told` alone.
bool isTold(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& q,
            const WeakDirections& weak);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_MATE_H
