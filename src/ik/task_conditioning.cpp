#include "task_conditioning.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "screwline/kinematics/singularity.h"

namespace screwline {
namespace {

/// Of the largest eigenvalue: squaring costs half the digits of what is smaller.
constexpr double kClearShare = 1e-6;

using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

TaskConditioning bySingularValues(const MatrixX& J, double noise) {
  const VectorX sigma = singularValues(J);
  TaskConditioning result;
  result.smallest = std::max({sigma.minCoeff(), kRankTolerance * sigma.maxCoeff(), 1e-12});
  result.manipulability = sigma.prod();
  result.full_rank = rankOf(sigma, noise) == sigma.size();
  return result;
}

/// From G = J J^T or J^T J, whichever is smaller; manipulability is left to the caller. Empty where squaring would cost
/// too many digits.
template <typename Matrix>
std::optional<TaskConditioning> byEigenvalues(const Matrix& G, double noise) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(G, Eigen::EigenvaluesOnly);
  const double least = eigen.eigenvalues()[0];
  const double most = eigen.eigenvalues()[G.rows() - 1];
  if (!(least > kClearShare * most) || !(std::sqrt(least) > noise)) return std::nullopt;
  TaskConditioning result;
  result.smallest = std::max(std::sqrt(least), 1e-12);
  result.manipulability = std::sqrt(eigen.eigenvalues().prod());
  result.full_rank = true;
  return result;
}

/// A whole pose of six joints: sizes that the compiler knows make it twice as fast.
std::optional<TaskConditioning> ofSixJoints(const MatrixX& task_jacobian, double noise) {
  const Matrix6 J = task_jacobian;
  std::optional<TaskConditioning> result = byEigenvalues<Matrix6>(J * J.transpose(), noise);
  if (result) result->manipulability = std::abs(J.partialPivLu().determinant());
  return result;
}

std::optional<TaskConditioning> ofAnySize(const MatrixX& J, double noise) {
  SmallMatrix G;
  if (J.rows() <= J.cols()) {
    G.noalias() = J.lazyProduct(J.transpose());
  } else {
    G.noalias() = J.transpose().lazyProduct(J);
  }
  std::optional<TaskConditioning> result = byEigenvalues(G, noise);
  if (result && J.rows() == J.cols()) {
    result->manipulability = std::abs(SmallMatrix(J).partialPivLu().determinant());
  }
  return result;
}

}  // namespace

TaskConditioning conditioningOf(const MatrixX& task_jacobian, double noise) {
  const bool is_six = task_jacobian.rows() == 6 && task_jacobian.cols() == 6;
  const std::optional<TaskConditioning> result =
      is_six ? ofSixJoints(task_jacobian, noise) : ofAnySize(task_jacobian, noise);
  return result ? *result : bySingularValues(task_jacobian, noise);
}

}  // namespace screwline
