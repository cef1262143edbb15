#ifndef SCREWLINE_IK_TASK_ERROR_H
#define SCREWLINE_IK_TASK_ERROR_H

#include <cmath>

#include "screwline/model/task.h"

namespace screwline {

/// Error of a pose over the task's rows, the one measure of every solver. Translation rows: difference of position,
/// base frame. All three rotation rows: rotation vector of R_target R^T. Two rows about the tool's axes: the smallest
/// turn that points its third axis as in the target. Other rotation rows: those components of the rotation vector.
struct TaskError {
  Vector6 twist =
      Vector6::Zero();       ///< From actual to target, [p; r], base frame; nothing along what is no row of the task.
  double position = 0.0;     ///< [m] norm of the translation rows.
  double orientation = 0.0;  ///< [rad] norm of the rotation rows.

  double norm() const { return std::hypot(position, orientation); }
  double weighted(double rotation_weight) const { return std::hypot(position, rotation_weight * orientation); }
};

/// No allocation.
TaskError taskError(const Task& task, const Pose& target, const Pose& actual);

}  // namespace screwline

#endif  // SCREWLINE_IK_TASK_ERROR_H
