#include "active_set.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace screwline {
namespace {

constexpr int kMaxPasses = 8;  ///< Of stopping joints at their bounds within one step.

/// x = (A + lambda I)^-1 b of `size` <= 6 rows, A positive semidefinite: Cholesky on fixed storage.
template <int kSize>
void solveDamped(const TaskMatrix& A, double lambda, const TaskVector& b, TaskVector& x) {
  using Square = Eigen::Matrix<double, kSize, kSize>;
  Square M = A.topLeftCorner<kSize, kSize>();
  M.diagonal().array() += lambda;
  const Eigen::LLT<Square> factor(M);
  x.resize(kSize);
  if (factor.info() == Eigen::Success) {
    x = factor.solve(b.head<kSize>());
  } else {
    x.setZero();
  }
}

void solveDamped(int size, const TaskMatrix& A, double lambda, const TaskVector& b, TaskVector& x) {
  switch (size) {
    case 1:
      return solveDamped<1>(A, lambda, b, x);
    case 2:
      return solveDamped<2>(A, lambda, b, x);
    case 3:
      return solveDamped<3>(A, lambda, b, x);
    case 4:
      return solveDamped<4>(A, lambda, b, x);
    case 5:
      return solveDamped<5>(A, lambda, b, x);
    default:
      return solveDamped<6>(A, lambda, b, x);
  }
}

}  // namespace

void ActiveSet::update(const TaskPoint& point) {
  const int n = box_->size();
  gradient_.resize(n);
  gradient_.noalias() = -point.J.transpose().lazyProduct(point.residual);
  free_count_ = 0;
  for (int i = 0; i < n; ++i) {
    const bool pressed = !box_->isFree(i) && ((point.q[i] <= box_->lower(i) && gradient_[i] > 0.0) ||
                                              (point.q[i] >= box_->upper(i) && gradient_[i] < 0.0));
    if (!pressed) free_[static_cast<std::size_t>(free_count_++)] = i;
  }
}

double ActiveSet::columnScale(const TaskPoint& point) const {
  double sum = 0.0;
  for (int k = 0; k < free_count_; ++k) {
    const int i = freeJoint(k);
    sum += point.J.col(i).squaredNorm() * box_->unit(i) * box_->unit(i);
  }
  return free_count_ == 0 ? 0.0 : sum / free_count_;
}

void ActiveSet::gather(const TaskPoint& point) {
  J_.resize(point.residual.size(), moving_count_);
  for (int k = 0; k < moving_count_; ++k) {
    const int i = moving_[static_cast<std::size_t>(k)];
    J_.col(k) = box_->unit(i) * point.J.col(i);
  }
}

void ActiveSet::solve(double lambda, const TaskVector& residual) {
  TaskMatrix A;
  TaskVector x;
  if (J_.rows() <= J_.cols()) {
    A.resize(J_.rows(), J_.rows());
    A.noalias() = J_.lazyProduct(J_.transpose());
    solveDamped(static_cast<int>(J_.rows()), A, lambda, residual, x);
    scaled_step_.resize(J_.cols());
    scaled_step_.noalias() = J_.transpose().lazyProduct(x);
    return;
  }
  A.resize(J_.cols(), J_.cols());
  A.noalias() = J_.transpose().lazyProduct(J_);
  TaskVector b = J_.transpose().lazyProduct(residual);
  solveDamped(static_cast<int>(J_.cols()), A, lambda, b, x);
  scaled_step_ = x;
}

bool ActiveSet::stopAtBounds(const TaskPoint& point) {
  int kept = 0;
  for (int k = 0; k < moving_count_; ++k) {
    const int i = moving_[static_cast<std::size_t>(k)];
    const double q = point.q[i] + step_[i];
    if (box_->isFree(i) || (q >= box_->lower(i) && q <= box_->upper(i))) {
      moving_[static_cast<std::size_t>(kept++)] = i;
    } else {
      step_[i] = (q < box_->lower(i) ? box_->lower(i) : box_->upper(i)) - point.q[i];
    }
  }
  const bool stopped = kept < moving_count_;
  moving_count_ = kept;
  return stopped;
}

const JointVector& ActiveSet::step(const TaskPoint& point, double lambda) {
  step_ = JointVector::Zero(box_->size());
  moving_count_ = free_count_;
  std::copy_n(free_.begin(), free_count_, moving_.begin());
  TaskVector residual = point.residual;
  for (int pass = 0; pass < kMaxPasses && moving_count_ > 0; ++pass) {
    gather(point);
    solve(lambda, residual);
    for (int k = 0; k < moving_count_; ++k) {
      const int i = moving_[static_cast<std::size_t>(k)];
      step_[i] = box_->unit(i) * scaled_step_[k];
    }
    if (!stopAtBounds(point)) break;
    for (int k = 0; k < moving_count_; ++k) step_[moving_[static_cast<std::size_t>(k)]] = 0.0;
    residual = point.residual;
    residual.noalias() -= point.J.lazyProduct(step_);
  }
  return step_;
}

}  // namespace screwline
