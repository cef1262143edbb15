#include "mate.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "screwline/kinematics/jacobian.h"
#include "screwline/spatial/svd.h"

namespace screwline {
namespace {

constexpr double kNearSingular = 1e-3;   // Smallest over largest singular value.
constexpr double kTwiceSingular = 1e-4;  // The same for the second smallest.
constexpr double kOnContinuum = 1e-11;   // Below it rounding is the model,
constexpr double kStraight = 1e-5;       // if the residual is not bent either.
constexpr double kProbe = 1e-4;          // [rad, m]
constexpr double kFarthest = 0.05;       // [rad, m]
constexpr double kExact = 1e-13;         // [m, rad]
constexpr double kRounding = 4e-16;      // [m, rad] Residuals that steps would not lessen.
constexpr int kMaxSteps = 20;
constexpr int kCircle = 8;  // Starts about a solution that is singular twice.

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

/// Of the residual along u on the way n: how far its roots are, the nearer first. `bound`: no farther where they are
/// not real. 0: none.
struct Along {
  double near = 0.0;
  double far = 0.0;
  double bound = 0.0;
  double kappa = 0.0;
};

Along rootsAlong(Residual& residual, const VectorX& q, const VectorX& n, const VectorX& u, double sigma) {
  const double r = u.dot(residual.at(q));
  const double bend = u.dot(residual.at(q + kProbe * n) + residual.at(q - kProbe * n)) - 2.0 * r;
  const double kappa = -bend / (kProbe * kProbe);
  const double discriminant = sigma * sigma + 2.0 * kappa * r;
  Along along;
  along.kappa = kappa;
  along.bound = (sigma + std::sqrt(std::abs(discriminant))) / std::abs(kappa);
  if (!(discriminant > 0.0)) return along;
  const double root = std::sqrt(discriminant);
  along.near = 2.0 * r / (sigma + root);
  along.far = -(sigma + root) / kappa;
  return along;
}

/// Newton's method from a start to a solution within `reach` of q.
bool refine(Residual& residual, const VectorX& q, double reach, VectorX& solution) {
  VectorX best = solution;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMaxSteps; ++k) {
    const VectorX error = residual.at(solution);
    const double size = error.norm();
    if (size < least) {
      least = size;
      best = solution;
    } else if (least <= kExact) {
      break;
    }
    if (size <= kRounding) break;
    solution += residual.jacobian().partialPivLu().solve(error);
    if (!((solution - q).norm() <= reach)) break;  // Another one's.
  }
  solution = best;
  return least <= kExact && (best - q).norm() <= reach;
}

}  // namespace

std::vector<VectorX> solutionsAbout(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& q) {
  Residual residual(chain, task, target);
  residual.at(q);
  const Svd svd(residual.jacobian(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const VectorX sigma = svd.singularValues();
  const Eigen::Index last = q.size() - 1;
  if (sigma[last] > kNearSingular * sigma[0]) return {};
  const auto along = [&](Eigen::Index i) {
    return rootsAlong(residual, q, svd.matrixV().col(i), svd.matrixU().col(i), sigma[i]);
  };
  const Along weakest = along(last);
  if (sigma[last] < kOnContinuum && std::abs(weakest.kappa) < kStraight) return {};
  std::vector<VectorX> starts;
  double reach = std::max(std::abs(weakest.near), std::abs(weakest.far));
  if (last > 0 && sigma[last - 1] < kTwiceSingular * sigma[0]) {
    reach = std::max(weakest.bound, along(last - 1).bound);
    for (int k = 0; k < kCircle; ++k) {
      const double angle = kTwoPi * (k + 0.5) / kCircle;
      starts.push_back(
          q + reach * (std::cos(angle) * svd.matrixV().col(last) + std::sin(angle) * svd.matrixV().col(last - 1)));
    }
  }
  if (weakest.far != 0.0) {
    starts.push_back(q + weakest.near * svd.matrixV().col(last));
    starts.push_back(q + weakest.far * svd.matrixV().col(last));
  }
  if (!(reach < kFarthest)) return {};
  std::vector<VectorX> solutions;
  for (VectorX& start : starts) {
    if (refine(residual, q, 2.0 * reach, start)) solutions.push_back(start);
  }
  std::stable_sort(solutions.begin(), solutions.end(),
                   [&q](const VectorX& a, const VectorX& b) { return (a - q).norm() < (b - q).norm(); });
  return solutions;
}

}  // namespace screwline
