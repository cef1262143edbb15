#include "path_system.h"

#include <algorithm>
#include <cmath>

#include "jacobian_rate.h"

namespace screwline {
namespace {

constexpr double kExact = 1e-13;       ///< Of the error in units: rounding.
constexpr double kGoodEnough = 1e-11;  ///< What may remain where steps no longer help.
constexpr double kNoRank = 1e-9;       ///< Of the pivots: the rows depend on one another.
constexpr double kMargin = 0.3;        ///< [rad or characteristic lengths] from a limit, where it is felt.
constexpr double kPush = 3.0;          ///< How fast a redundant chain leaves a limit, beside the path's unit speed.

}  // namespace

PathSystem::PathSystem(const SerialChain& chain, const Task& task, const ToolPath& path)
    : chain_(chain), task_(task), path_(path), n_(chain.size()), units_(VectorX::Ones(n_ + 1)), J_(6, n_) {
  for (int i = 0; i < n_; ++i) {
    if (!chain.joint(i).isRevolute()) units_[i] = chain.characteristicLength();
  }
}

void PathSystem::evaluate(const VectorX& y) {
  y_ = y;
  path_.at(part_, y[n_], target_);
  const Pose actual = geometricJacobian(chain_, y.head(n_), J_);
  error_ = taskError(task_, target_.pose, actual);
  R_BT_ = actual.R;
  rows_.resize(n_ + 1, task_.size());
  for (int i = 0; i < task_.size(); ++i) {
    const Vector6 row = rowOf(i);
    rows_.col(i).head(n_) = (J_.transpose() * row).cwiseProduct(units_.head(n_));
    rows_(n_, i) = -row.dot(target_.rate);
  }
  factor_.compute(rows_);
  rank_ = std::min(n_, task_.size());
  const auto pivot = [this](int i) { return std::abs(factor_.matrixR()(i, i) / factor_.matrixR()(0, 0)); };
  gap_ = pivot(rank_ - 1);
  while (rank_ > 1 && pivot(rank_ - 1) < kNoRank) --rank_;
}

double PathSystem::residual() const {
  return std::max(error_.position / chain_.characteristicLength(), error_.orientation);
}

VectorX PathSystem::step() const {
  return shortest(error_.twist);
}

/// What takes a twist to the task's row i of it, in units.
Vector6 PathSystem::rowOf(int i) const {
  const int row = task_.row(i);
  Vector6 result = Vector6::Zero();
  if (row < 3) {
    result[row] = 1.0 / chain_.characteristicLength();
  } else {
    result.tail<3>() = task_.axisOf(i, R_BT_);
  }
  return result;
}

VectorX PathSystem::inUnits(const Vector6& twist) const {
  VectorX rows = task_.select(twist, R_BT_);
  for (int i = 0; i < task_.size(); ++i) {
    if (task_.row(i) < 3) rows[i] /= chain_.characteristicLength();
  }
  return rows;
}

/// The shortest change of y that changes the task rows by `twist`. With more rows than joints: the rows that tell most.
VectorX PathSystem::shortest(const Vector6& twist) const {
  const VectorX right = factor_.colsPermutation().transpose() * inUnits(twist);
  VectorX change = VectorX::Zero(n_ + 1);
  change.head(rank_) =
      factor_.matrixR().topLeftCorner(rank_, rank_).triangularView<Eigen::Upper>().transpose().solve(right.head(rank_));
  change = factor_.householderQ() * change;
  return change.cwiseProduct(units_);
}

VectorX PathSystem::direction(const VectorX& previous) const {
  const MatrixX Q = factor_.householderQ();
  const auto free = Q.rightCols(n_ + 1 - rank_);
  VectorX z;
  if (free.cols() == 1) {
    z = free.col(0);
    const double along = previous.size() > 0 ? z.dot(previous.cwiseQuotient(units_)) : z[n_];
    if (along < 0.0) z = -z;
    return z.cwiseProduct(units_);
  }
  z = free * free.row(n_).transpose();
  z.normalize();
  // What is left of the free directions moves the joints alone.
  VectorX push = free * (free.transpose() * awayFromLimits(y_));
  push -= z * z.dot(push);
  const double sign = previous.size() > 0 && previous[n_] < 0.0 ? -1.0 : 1.0;
  z = sign * z + kPush * push;
  return z.normalized().cwiseProduct(units_);
}

/// Per joint, in units: grows smoothly from zero at the margin to 1 at a limit.
VectorX PathSystem::awayFromLimits(const VectorX& y) const {
  VectorX push = VectorX::Zero(n_ + 1);
  for (int i = 0; i < n_; ++i) {
    const JointLimits& limits = chain_.joint(i).limits;
    const double range = (limits.upper - limits.lower) / units_[i];
    const double margin = std::min(kMargin, 0.15 * range);
    const double low = 1.0 - (y[i] - limits.lower) / (units_[i] * margin);
    const double high = 1.0 - (limits.upper - y[i]) / (units_[i] * margin);
    if (low > 0.0) push[i] = low * low * low;
    if (high > 0.0) push[i] -= high * high * high;
  }
  return push;
}

VectorX PathSystem::exactBend(const VectorX& direction) const {
  Matrix6X J_rate(6, n_);
  jacobianRate(chain_, y_.head(n_), direction.head(n_), J_, J_rate);
  const double du = direction[n_];
  Vector6 change = target_.change * (du * du) - J_rate * direction.head(n_);
  if (task_.usesToolAxes()) {
    // The rows turn with the tool, and the tool may turn against the target about what is free.
    const Vector3 w = J_.bottomRows<3>() * direction.head(n_);
    change.tail<3>() -= w.cross(du * target_.rate.tail<3>());
  }
  return shortest(change);
}

VectorX PathSystem::bend(const VectorX& y, const VectorX& direction) {
  if (!redundant()) return exactBend(direction);
  // Its direction also follows from limits: the field is differentiated along itself.
  constexpr double kStep = 1e-5;
  evaluate(y + kStep * direction);
  const VectorX ahead = this->direction(direction);
  evaluate(y - kStep * direction);
  return (ahead - this->direction(direction)) / (2.0 * kStep);
}

bool PathSystem::correct(VectorX& y) {
  constexpr int kMostSteps = 8;
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMostSteps; ++k) {
    evaluate(y);
    const double now = residual();
    if (now <= kExact) return true;
    if (!(now < 0.5 * before)) return now <= kGoodEnough;
    before = now;
    y += step();
  }
  evaluate(y);
  return residual() <= kGoodEnough;
}

bool PathSystem::correctJoints(VectorX& y) {
  constexpr int kMostSteps = 30;
  VectorX best = y;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMostSteps; ++k) {
    evaluate(y);
    if (residual() < least) {
      least = residual();
      best = y;
    } else if (k > 3) {
      break;
    }
    if (least <= kExact) break;
    const MatrixX joints = rows_.topRows(n_).transpose();
    Eigen::CompleteOrthogonalDecomposition<MatrixX> solver;
    solver.setThreshold(1e-9);
    solver.compute(joints);
    y.head(n_) += solver.solve(inUnits(error_.twist)).cwiseProduct(units_.head(n_));
  }
  y = best;
  evaluate(y);
  return least <= kGoodEnough;
}

}  // namespace screwline
