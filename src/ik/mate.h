#ifndef SCREWLINE_SRC_IK_MATE_H
#define SCREWLINE_SRC_IK_MATE_H

#include <vector>

#include "screwline/ik/task_error.h"
#include "screwline/model/serial_chain.h"

namespace screwline {

/// All solutions about an almost singular one, nearest first; q need not be one itself, where rounding at a double root
/// put it between two. Along the direction n that the task Jacobian maps to almost nothing, sigma u, the residual is
/// r - sigma t - kappa t^2 / 2 along u: from its two roots Newton's method goes on. Where two singular values are
/// almost nothing, it starts from a circle about q. Empty where q is regular or nothing is near. As many joints as
/// rows. Allocates.
std::vector<VectorX> solutionsAbout(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& q);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_MATE_H
