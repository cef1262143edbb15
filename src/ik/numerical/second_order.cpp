#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "descent.h"

namespace screwline {
namespace {

constexpr double kDifference = 1e-5;        ///< Scaled step of the central differences: errors of about 1e-10.
constexpr double kFlat = 1e-9;              ///< Of the largest curvature: what differences cannot tell from none.
constexpr double kLongestStep = 0.5;        ///< Scaled.
constexpr double kShortestStep = 1e-9;      ///< Scaled; the cost is flat to rounding within it.
constexpr double kEscape = 0.2;             ///< Scaled length of the first step off a saddle.
constexpr double kEscapeShortest = 1e-4;    ///< Scaled.
constexpr double kShortestFraction = 1e-3;  ///< Of a Newton step that is shortened until the cost falls.

}  // namespace

MatrixX Descent::hessian() {
  const int count = active_.freeCount();
  MatrixX H(count, count);
  VectorX gradients[2] = {VectorX(count), VectorX(count)};
  for (int k = 0; k < count; ++k) {
    for (int side = 0; side < 2; ++side) {
      trial_->q = current_->q;
      const int i = active_.freeJoint(k);
      trial_->q[i] += (side == 0 ? kDifference : -kDifference) * box_.unit(i);
      residual_.evaluate(*trial_);
      for (int l = 0; l < count; ++l) {
        const int j = active_.freeJoint(l);
        gradients[side][l] = -trial_->J.col(j).dot(trial_->residual) * box_.unit(j);
      }
    }
    H.col(k) = (gradients[0] - gradients[1]) / (2.0 * kDifference);
  }
  return 0.5 * (H + H.transpose());
}

bool Descent::tryAlong(const VectorX& direction, double length) {
  JointVector step = JointVector::Zero(box_.size());
  for (int k = 0; k < active_.freeCount(); ++k) {
    const int i = active_.freeJoint(k);
    step[i] = length * direction[k] * box_.unit(i);
  }
  return tryStep(step);
}

bool Descent::newtonStep(const MatrixX& vectors, const VectorX& values) {
  const int count = active_.freeCount();
  VectorX gradient(count);
  for (int k = 0; k < count; ++k)
    gradient[k] = active_.gradient()[active_.freeJoint(k)] * box_.unit(active_.freeJoint(k));
  const double steepest = values.cwiseAbs().maxCoeff();
  // The step of |H|: downhill also where the curvature is negative; along flat directions it stays.
  VectorX along = vectors.transpose() * gradient;
  for (int k = 0; k < count; ++k) {
    along[k] = std::abs(values[k]) > kFlat * steepest ? -along[k] / std::abs(values[k]) : 0.0;
  }
  VectorX direction = vectors * along;
  const double longest = direction.cwiseAbs().maxCoeff();
  if (longest < kShortestStep) return false;
  direction *= std::min(1.0, kLongestStep / longest);
  for (double length = 1.0; length > kShortestFraction; length *= 0.5) {
    if (tryAlong(direction, length)) return true;
  }
  // Bounds may have bent the step uphill; the projected gradient never is.
  direction = gradient * (-std::min(1.0, kLongestStep * steepest / gradient.norm()) / steepest);
  for (double length = 1.0; length > kShortestStep; length *= 0.25) {
    if (tryAlong(direction, length)) return true;
  }
  return false;
}

bool Descent::escape(const MatrixX& vectors, const VectorX& values) {
  // Eigenvalues ascend.
  if (values[0] >= -kFlat * values.cwiseAbs().maxCoeff()) return false;
  for (double length = kEscape; length > kEscapeShortest; length *= 0.3) {
    if (tryAlong(vectors.col(0), length) || tryAlong(vectors.col(0), -length)) return true;
  }
  return false;
}

Descent::Outcome Descent::secondOrder() {
  while (true) {
    if (watch_.expired() || iterations_ >= options_.max_iterations) return Outcome::kStopped;
    ++iterations_;
    active_.update(*current_);
    if (active_.freeCount() == 0) return Outcome::kStationary;
    const Eigen::SelfAdjointEigenSolver<MatrixX> eigen(hessian());
    const double cost_before = current_->cost;
    if (newtonStep(eigen.eigenvectors(), eigen.eigenvalues())) {
      // Where the cost falls by much, the first-order steps may find a solution.
      if (current_->cost < 0.1 * cost_before) return Outcome::kSlow;
      continue;
    }
    return escape(eigen.eigenvectors(), eigen.eigenvalues()) ? Outcome::kSlow : Outcome::kStationary;
  }
}

}  // namespace screwline
