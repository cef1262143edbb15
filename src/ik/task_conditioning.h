#ifndef SCREWLINE_SRC_IK_TASK_CONDITIONING_H
#define SCREWLINE_SRC_IK_TASK_CONDITIONING_H

#include <optional>

#include "screwline/kinematics/jacobian.h"
#include "screwline/spatial/weak_directions.h"

namespace screwline {

/// How well a task Jacobian is conditioned.
struct TaskConditioning {
  double smallest = 0.0;               ///< Smallest singular value; at least kRankTolerance of the largest, and 1e-12.
  double manipulability = 0.0;         ///< Product of the singular values.
  bool full_rank = false;              ///< As rankOf() counts.
  std::optional<WeakDirections> weak;  ///< Of a square one, where it is nearly singular.
};

/// Of the task's rows of J (6 x n). From the eigenvalues of J J^T (or J^T J), to 1e-10; where their ratio is beyond 1e6
/// by the smallest singular values, to rounding. Below 1 us if J is square; allocates only where it is not.
TaskConditioning conditioningOf(const MatrixX& task_jacobian, double noise);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_TASK_CONDITIONING_H
