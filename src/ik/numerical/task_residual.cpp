#include "task_residual.h"

#include <cmath>

#include "../pointing.h"
#include "screwline/kinematics/forward.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

/// Inverse of the right Jacobian of the rotation group: with exp(r) = R_target R^T, a turn w of R changes r by -this w
/// (Sola, Deray, Atchuthan 2018, eq. 144).
Matrix3 inverseRightJacobian(const Vector3& r) {
  const double angle = r.norm();
  const Matrix3 S = skew(r);
  // (1 - (angle / 2) cot(angle / 2)) / angle^2 by series where the quotient would lose its digits.
  const double factor =
      angle < 1e-2 ? 1.0 / 12.0 + angle * angle / 720.0 : (1.0 - 0.5 * angle / std::tan(0.5 * angle)) / (angle * angle);
  return Matrix3::Identity() + 0.5 * S + factor * S * S;
}

}  // namespace

TaskResidual::TaskResidual(const SerialChain& chain, const Task& task, const Pose& target, double rotation_weight)
    : chain_(&chain),
      task_(&task),
      target_(&target),
      rotation_weight_(rotation_weight),
      has_rotation_(task.rotationCount() > 0),
      pointing_(task.pointingAxis()),
      J_(6, chain.size()) {}

void TaskResidual::takeResidual(const Pose& X_BT, TaskPoint& point) const {
  point.error = taskError(*task_, *target_, X_BT);
  point.residual.resize(task_->size());
  for (int i = 0; i < task_->size(); ++i) {
    const int row = task_->row(i);
    const double weight = row < 3 ? 1.0 : rotation_weight_;
    point.residual[i] = row < Task::kFirstToolRow ? weight * point.error.twist[row]
                                                  : weight * task_->axisOf(i, X_BT.R).dot(point.error.twist.tail<3>());
  }
  point.cost = 0.5 * point.residual.squaredNorm();
}

void TaskResidual::evaluateResidual(TaskPoint& point) const {
  takeResidual(forwardKinematics(*chain_, point.q), point);
}

void TaskResidual::evaluate(TaskPoint& point) {
  const Pose X_BT = geometricJacobian(*chain_, point.q, J_);
  takeResidual(X_BT, point);
  if (pointing_ >= 0) {
    const Matrix3 D = X_BT.R * pointingDerivative(target_->R, X_BT.R, pointing_) * X_BT.R.transpose();
    for (Eigen::Index i = 0; i < J_.cols(); ++i) J_.col(i).tail<3>() = (D * J_.col(i).tail<3>()).eval();
  } else if (has_rotation_) {
    const bool whole = task_->rotationCount() == 3;
    const Vector3 r = whole ? Vector3(point.error.twist.tail<3>()) : rotationVector(target_->R * X_BT.R.transpose());
    const Matrix3 D = inverseRightJacobian(r);
    for (Eigen::Index i = 0; i < J_.cols(); ++i) J_.col(i).tail<3>() = (D * J_.col(i).tail<3>()).eval();
  }
  point.J.resize(task_->size(), J_.cols());
  for (int i = 0; i < task_->size(); ++i) {
    const int row = task_->row(i);
    const double weight = row < 3 ? 1.0 : rotation_weight_;
    if (row < Task::kFirstToolRow) {
      point.J.row(i) = weight * J_.row(row);
    } else {
      const Vector3 axis = weight * task_->axisOf(i, X_BT.R);
      point.J.row(i).noalias() = axis.transpose() * J_.bottomRows<3>();
    }
  }
}

}  // namespace screwline
