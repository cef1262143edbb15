#include "screwline/kinematics/statics.h"

#include "screwline/kinematics/singularity.h"
#include "screwline/spatial/svd.h"

namespace screwline {
VectorX effortOf(const SerialChain& chain, const ConstVectorRef& q, const Vector6& wrench) {
  Matrix6X J;
  geometricJacobian(chain, q, J);
  return J.transpose() * wrench;
}

WrenchSolution wrenchOf(const SerialChain& chain, const ConstVectorRef& q, const ConstVectorRef& effort,
                        const Task& task) {
  Matrix6X J;
  const Matrix3 R_BT = geometricJacobian(chain, q, J).R;
  const MatrixX A = taskJacobian(task, J, R_BT).transpose();
  const Svd svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const int rank = rankOf(svd.singularValues(), jacobianNoise(J));
  VectorX F = VectorX::Zero(task.size());
  for (int i = 0; i < rank; ++i) {
    F += svd.matrixU().col(i).dot(effort) / svd.singularValues()[i] * svd.matrixV().col(i);
  }
  WrenchSolution solution;
  solution.wrench = task.spread(F, R_BT);
  solution.residual = (effort - A * F).norm();
  solution.exact = solution.residual < 1e-9 * (1.0 + effort.norm());
  return solution;
}

MatrixX supportedWrenches(const SerialChain& chain, const ConstVectorRef& q) {
  Matrix6X J;
  geometricJacobian(chain, q, J);
  return taskRank(J, jacobianNoise(J)).lost_directions;
}

}  // namespace screwline
