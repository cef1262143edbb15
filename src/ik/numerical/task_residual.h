#ifndef SCREWLINE_IK_NUMERICAL_TASK_RESIDUAL_H
#define SCREWLINE_IK_NUMERICAL_TASK_RESIDUAL_H

#include "screwline/ik/task_error.h"
#include "screwline/kinematics/jacobian.h"

namespace screwline {

// Sizes bounded at compile time: a descent allocates nothing once it runs.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;
using TaskVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using TaskMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, kMaxJoints>;

/// A configuration with all that a step needs.
struct TaskPoint {
  JointVector q;
  TaskError error;
  TaskVector residual;  ///< Weighted, task order; residual(q + dq) = residual - J dq to first order.
  TaskMatrix J;         ///< Exact derivative of -residual, also far from the target.
  double cost = 0.0;    ///< |residual|^2 / 2.
};

/// The function whose zeros are the solutions and whose least square is the closest configuration.
class TaskResidual {
 public:
  TaskResidual(const SerialChain& chain, const Task& task, const Pose& target, double rotation_weight);

  const SerialChain& chain() const { return *chain_; }
  const Pose& target() const { return *target_; }

  /// Fills a point from its q. No allocation.
  void evaluate(TaskPoint& point);
  /// The same without J.
  void evaluateResidual(TaskPoint& point) const;

 private:
  void takeResidual(const Pose& X_BT, TaskPoint& point) const;

  const SerialChain* chain_;
  const Task* task_;
  const Pose* target_;
  double rotation_weight_;
  bool has_rotation_;
  int pointing_;  ///< The tool's axis that is to point somewhere; -1: none.
  Matrix6X J_;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_NUMERICAL_TASK_RESIDUAL_H
