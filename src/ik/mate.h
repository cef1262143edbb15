#ifndef SCREWLINE_SRC_IK_MATE_H
#define SCREWLINE_SRC_IK_MATE_H

#include <optional>

#include "screwline/ik/task_error.h"
#include "screwline/model/serial_chain.h"

namespace screwline {

/// The solution that an almost singular one almost meets. Along the direction n that the task Jacobian maps to almost
/// nothing, sigma u, the residual is sigma t + kappa t^2 / 2 along u: it vanishes at q and once more, from where
/// Newton's method goes on. Empty where q is regular or nothing is near. As many joints as rows. Allocates.
std::optional<VectorX> mateOf(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& q);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_MATE_H
