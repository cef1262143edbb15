#include "neighbour_sheet.h"

#include <Eigen/QR>
#include <algorithm>

#include "screwline/kinematics/jacobian.h"
#include "screwline/spatial/svd.h"

namespace screwline {
namespace {

constexpr int kMostSteps = 12;
constexpr double kExact = 1e-13;      ///< [m, rad]
constexpr double kOnTask = 1e-11;     ///< [m, rad]
constexpr double kLongestStep = 0.3;  ///< [rad, m] Farther, another branch would be met.

/// Newton steps of all joints but `held` from `q` to a solution.
bool returned(const SerialChain& chain, const Task& task, const Pose& target, const std::vector<int>& held,
              VectorX& q) {
  Matrix6X J;
  for (int k = 0; k < kMostSteps; ++k) {
    const Pose tip = geometricJacobian(chain, q, J);
    const TaskError error = taskError(task, target, tip);
    if (error.norm() <= kExact) return true;
    MatrixX J_task = task.select(J, tip.R);
    for (int joint : held) J_task.col(joint).setZero();
    Eigen::CompleteOrthogonalDecomposition<MatrixX> solver;
    solver.setThreshold(1e-10);
    const VectorX step = solver.compute(J_task).solve(task.select(error.twist, tip.R));
    if (!(step.cwiseAbs().maxCoeff() <= kLongestStep)) return false;
    q += step;
  }
  return taskError(task, target, forwardKinematics(chain, q)).norm() <= kOnTask;
}

/// Joints whose values give the others' on a self-motion of that dimension.
std::vector<int> parameters(const MatrixX& J_task, std::size_t dimension) {
  const auto k = static_cast<Eigen::Index>(dimension);
  const Svd svd(J_task, Eigen::ComputeFullV);
  const MatrixX null_space = svd.matrixV().rightCols(k).transpose();
  const Eigen::ColPivHouseholderQR<MatrixX> qr(null_space);
  std::vector<int> joints;
  for (Eigen::Index i = 0; i < k; ++i) joints.push_back(static_cast<int>(qr.colsPermutation().indices()[i]));
  std::sort(joints.begin(), joints.end());
  return joints;
}

}  // namespace

void openByNeighbours(const SerialChain& chain, const Task& task, const Pose& target, std::size_t dimension,
                      Candidate& candidate) {
  candidate.free = parameters(taskJacobian(chain, candidate.q, task), dimension);
  candidate.member = [&chain, task, target, held = candidate.free](const VectorX& preferred, VectorX& q) {
    q = preferred;
    return returned(chain, task, target, held, q);
  };
}

}  // namespace screwline
