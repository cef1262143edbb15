#ifndef SCREWLINE_SRC_IK_TASK_CONDITIONING_H
#define SCREWLINE_SRC_IK_TASK_CONDITIONING_H

#include <optional>

#include "screwline/kinematics/jacobian.h"
#include "screwline/spatial/small_svd.h"

namespace screwline {

/// How well a task Jacobian is conditioned.
struct TaskConditioning {
  double smallest = 0.0;        ///< Smallest singular value; at least kRankTolerance of the largest, and 1e-12.
  double manipulability = 0.0;  ///< Product of the singular values.
  bool full_rank = false;       ///< As rankOf() counts.
  std::optional<SmallSvd> svd;  ///< Where it took the decomposition of a square one.
};

/// Of the task's rows of J (6 x n). From the eigenvalues of J J^T (or J^T J), to 1e-10; by singular values where their
/// ratio is beyond 1e3, to rounding. Well below 1 us; allocates only there.
TaskConditioning conditioningOf(const MatrixX& task_jacobian, double noise);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_TASK_CONDITIONING_H
