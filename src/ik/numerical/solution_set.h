#ifndef SCREWLINE_IK_NUMERICAL_SOLUTION_SET_H
#define SCREWLINE_IK_NUMERICAL_SOLUTION_SET_H

#include <vector>

#include "joint_box.h"

namespace screwline {

constexpr double kAcceptedError = 1e-9;  ///< [m], [rad] that a solution's errors stay below.

inline bool isAccepted(const TaskError& error) {
  return error.position < kAcceptedError && error.orientation < kAcceptedError;
}

/// Index of the solution that `q` is: within 1e-6 in every joint, or as close as its residual over the smallest
/// singular value leaves uncertain (1e-3 at most); -1 where it is a new one.
int indexOfKnown(const SerialChain& chain, const Task& task, const JointBox& box, const std::vector<VectorX>& solutions,
                 const ConstVectorRef& q, const TaskError& error);

}  // namespace screwline

#endif  // SCREWLINE_IK_NUMERICAL_SOLUTION_SET_H
