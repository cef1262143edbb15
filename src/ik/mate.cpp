#include "mate.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

#include "screwline/kinematics/jacobian.h"

namespace screwline {
namespace {

constexpr double kNearSingular = 1e-3;  // Smallest over largest singular value.
constexpr double kOnContinuum = 1e-11;  // Below it rounding is the model.
constexpr double kProbe = 1e-4;         // [rad, m]
constexpr double kFarthest = 0.05;      // [rad, m]
constexpr double kExact = 1e-13;        // [m, rad]
constexpr int kMaxSteps = 20;

/// The task's residual and its Jacobian.
class Residual {
 public:
  Residual(const SerialChain& chain, const Task& task, const Pose& target)
      : chain_(chain), task_(task), target_(target) {}

  VectorX at(const VectorX& q) {
    tip_ = geometricJacobian(chain_, q, J_);
    return task_.select(taskError(task_, target_, tip_).twist, tip_.R);
  }
  MatrixX jacobian() const { return task_.select(J_, tip_.R); }

 private:
  const SerialChain& chain_;
  const Task& task_;
  const Pose& target_;
  Pose tip_;
  Matrix6X J_;
};

}  // namespace

std::optional<VectorX> mateOf(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& q) {
  Residual residual(chain, task, target);
  residual.at(q);
  const Eigen::JacobiSVD<MatrixX> svd(residual.jacobian(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Index last = q.size() - 1;
  const double sigma = svd.singularValues()[last];
  if (sigma > kNearSingular * svd.singularValues()[0] || sigma < kOnContinuum) return std::nullopt;
  const VectorX n = svd.matrixV().col(last);
  const double kappa =
      -svd.matrixU().col(last).dot(residual.at(q + kProbe * n) + residual.at(q - kProbe * n)) / (kProbe * kProbe);
  const double t = -2.0 * sigma / kappa;
  if (!(std::abs(t) < kFarthest)) return std::nullopt;
  VectorX mate = q + t * n;
  VectorX error = residual.at(mate);
  for (int k = 0; k < kMaxSteps && error.norm() > kExact; ++k) {
    mate += residual.jacobian().partialPivLu().solve(error);
    if (!((mate - q).norm() < 2.0 * std::abs(t))) return std::nullopt;  // Another one's.
    error = residual.at(mate);
  }
  if (!(error.norm() <= kExact)) return std::nullopt;
  return mate;
}

}  // namespace screwline
