#include "task_conditioning.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "screwline/kinematics/singularity.h"

namespace screwline {
namespace {

/// Of the eigenvalues' sum: squaring costs half the digits of what is smaller.
constexpr double kClearShare = 1e-6;
constexpr double kConverged = 1e-14;  ///< Of the eigenvalue.
constexpr int kMaxSteps = 30;

TaskConditioning ofSingularValues(double smallest, double largest, double product, double noise) {
  TaskConditioning result;
  result.smallest = std::max({smallest, kRankTolerance * largest, 1e-12});
  result.manipulability = product;
  result.full_rank = smallest > std::max(kRankTolerance * largest, noise);
  return result;
}

/// @param largest singular value; 0: not known.
TaskConditioning bySingularValues(const MatrixX& J, double largest, double noise) {
  if (J.rows() != J.cols()) {
    const VectorX sigma = singularValues(J);
    return ofSingularValues(sigma.minCoeff(), sigma.maxCoeff(), sigma.prod(), noise);
  }
  const WeakDirections weak = largest > 0.0 ? weakDirectionsOf(J, largest) : weakDirectionsOf(SmallSvd(J));
  TaskConditioning result = ofSingularValues(weak.sigma[weak.sigma.size() - 1], weak.largest, weak.product, noise);
  result.weak = weak;
  return result;
}

/// The least eigenvalue of a symmetric tridiagonal matrix whose eigenvalues are positive, and its determinant.
struct LeastEigenvalue {
  double value = 0.0;
  double determinant = 0.0;
};

/// The characteristic polynomial at x with two derivatives, by its three-term recurrence.
template <typename Diagonal, typename OffDiagonal>
Eigen::Array3d characteristic(const Diagonal& d, const OffDiagonal& e, double x) {
  Eigen::Array3d before(0.0, 0.0, 0.0);
  Eigen::Array3d p(1.0, 0.0, 0.0);
  for (Eigen::Index k = 0; k < d.size(); ++k) {
    const double left = d[k] - x;
    const double coupling = k == 0 ? 0.0 : e[k - 1] * e[k - 1];
    const Eigen::Array3d next(left * p[0] - coupling * before[0], left * p[1] - p[0] - coupling * before[1],
                              left * p[2] - 2.0 * p[1] - coupling * before[2]);
    before = p;
    p = next;
  }
  return p;
}

/// Laguerre's steps from zero: to the left of the least root of a polynomial with real roots they grow towards it, and
/// converge with the third power (Wilkinson, The Algebraic Eigenvalue Problem, ch. 7).
template <typename Diagonal, typename OffDiagonal>
LeastEigenvalue leastEigenvalue(const Diagonal& d, const OffDiagonal& e) {
  const auto n = static_cast<double>(d.size());
  LeastEigenvalue least;
  Eigen::Array3d p = characteristic(d, e, 0.0);
  least.determinant = p[0];
  for (int k = 0; k < kMaxSteps && p[0] > 0.0; ++k) {
    const double slope = p[1] / p[0];
    const double bend = slope * slope - p[2] / p[0];
    const double step = n / (std::sqrt(std::max(0.0, (n - 1.0) * (n * bend - slope * slope))) - slope);
    if (!(step > kConverged * least.value)) break;
    least.value += step;
    p = characteristic(d, e, least.value);
  }
  return least;
}

template <typename Matrix>
using VectorOf = Eigen::Matrix<double, Matrix::RowsAtCompileTime, 1, 0, Matrix::MaxRowsAtCompileTime, 1>;

/// From G = J J^T or J^T J, whichever is smaller; manipulability is sqrt(det G). Empty where squaring would cost too
/// many digits: then with the largest singular value, which it does not.
template <typename Matrix>
std::optional<TaskConditioning> byEigenvalues(Matrix G, double noise, double& largest) {
  const double sum = G.trace();  // Of the eigenvalues: no less than the largest.
  if (!(sum > 0.0)) return std::nullopt;
  G /= sum;
  LeastEigenvalue least{G(0, 0), G(0, 0)};
  if (G.rows() > 1) {
    const Eigen::Tridiagonalization<Matrix> T(G);
    least = leastEigenvalue(T.diagonal(), T.subDiagonal());
    if (!(least.value > kClearShare)) {
      const VectorOf<Matrix> rest = 1.0 - T.diagonal().array();
      largest = std::sqrt(sum * (1.0 - leastEigenvalue(rest, T.subDiagonal()).value));
    }
  }
  const double smallest = std::sqrt(sum * std::max(0.0, least.value));
  if (!(least.value > kClearShare) || !(smallest > noise)) return std::nullopt;
  TaskConditioning result;
  result.smallest = std::max(smallest, 1e-12);
  result.manipulability = std::sqrt(least.determinant * std::pow(sum, static_cast<double>(G.rows())));
  result.full_rank = true;
  return result;
}

/// A whole pose of six joints: sizes that the compiler knows make it twice as fast.
std::optional<TaskConditioning> ofSixJoints(const MatrixX& task_jacobian, double noise, double& largest) {
  const Matrix6 J = task_jacobian;
  std::optional<TaskConditioning> result = byEigenvalues<Matrix6>(J * J.transpose(), noise, largest);
  if (result) result->manipulability = std::abs(J.partialPivLu().determinant());
  return result;
}

std::optional<TaskConditioning> ofAnySize(const MatrixX& J, double noise, double& largest) {
  SmallMatrix G;
  if (J.rows() <= J.cols()) {
    G.noalias() = J.lazyProduct(J.transpose());
  } else {
    G.noalias() = J.transpose().lazyProduct(J);
  }
  std::optional<TaskConditioning> result = byEigenvalues(G, noise, largest);
  if (result && J.rows() == J.cols()) {
    result->manipulability = std::abs(SmallMatrix(J).partialPivLu().determinant());
  }
  return result;
}

}  // namespace

TaskConditioning conditioningOf(const MatrixX& task_jacobian, double noise) {
  const bool is_six = task_jacobian.rows() == 6 && task_jacobian.cols() == 6;
  double largest = 0.0;
  const std::optional<TaskConditioning> result =
      is_six ? ofSixJoints(task_jacobian, noise, largest) : ofAnySize(task_jacobian, noise, largest);
  return result ? *result : bySingularValues(task_jacobian, largest, noise);
}

}  // namespace screwline
