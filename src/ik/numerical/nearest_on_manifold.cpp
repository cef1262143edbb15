#include "screwline/ik/numerical/nearest_on_manifold.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "joint_box.h"
#include "solution_set.h"

namespace screwline {
namespace {

constexpr int kMaxReturns = 12;         ///< Newton steps back to the task.
constexpr double kReturned = 1e-13;     ///< [m, rad] error with which they may stop.
constexpr double kOnTask = 1e-11;       ///< [m, rad] error that a step may end with.
constexpr double kLongestStep = 0.5;    ///< [rad], [m]
constexpr double kShortestStep = 1e-9;  ///< Share of a step, below which none is nearer.
constexpr double kSufficient = 0.2;  ///< Of what the gradient promises (Armijo): a step twice too long gains nothing.
constexpr double kRank = 1e-10;
constexpr double kAtBound = 1e-7;  ///< [rad], [m] that Newton steps may leave to a limit.
constexpr double kStill = 1e-6;    ///< [rad], [m]

/// One walk along the manifold.
class Walk {
 public:
  Walk(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& seed, bool honour_limits)
      : residual_(chain, task, target, 0.5 * lengthUnit(chain)), box_(chain, honour_limits, 0.0), seed_(seed) {}

  bool begin(const VectorX& start) {
    point_.q = start;
    residual_.evaluate(point_);
    return isAccepted(point_.error) && isInside(point_.q);
  }

  const TaskPoint& point() const { return point_; }

  /// Way towards the seed along the manifold, joints that would leave their limits held. Zero: at a minimum.
  VectorX direction() {
    const int n = box_.size();
    held_.assign(static_cast<std::size_t>(n), false);
    const VectorX way = holding(n);
    // Of joints that were held one after the other, the first may be free to go once the others are.
    if (way.cwiseAbs().maxCoeff() > kStill) return way;
    return releasing(n, way);
  }
  /// The point a step away, back on the task. False where it is none, or not nearer by enough.
  bool advance(const VectorX& way, double share) {
    const double before = (seed_ - VectorX(point_.q)).squaredNorm();
    TaskPoint next;
    next.q = point_.q + share * way;
    clamp(next.q);
    for (int k = 0; k < kMaxReturns; ++k) {
      residual_.evaluate(next);
      if (next.error.norm() < kReturned) break;
      next.q += returning(next);
      clamp(next.q);
    }
    residual_.evaluate(next);
    const double after = (seed_ - VectorX(next.q)).squaredNorm();
    if (!(next.error.norm() < kOnTask) || !(after < before - kSufficient * share * way.squaredNorm())) return false;
    point_ = next;
    return true;
  }

 private:
  /// The projected way, joints held one by one until none leaves its limits.
  VectorX holding(int n) {
    VectorX way = VectorX::Zero(n);
    for (int pass = 0; pass <= n; ++pass) {
      way = project(seed_ - VectorX(point_.q));
      int worst = -1;
      double most = 0.0;
      for (int i = 0; i < n; ++i) {
        const double out = leaves(i, way[i]);
        if (out <= most) continue;
        most = out;
        worst = i;
      }
      if (worst < 0) break;
      held_[static_cast<std::size_t>(worst)] = true;
    }
    return way;
  }

  VectorX releasing(int n, const VectorX& way) {
    VectorX longest = way;
    int released = -1;
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (!held_[k]) continue;
      held_[k] = false;
      const VectorX other = project(seed_ - VectorX(point_.q));
      bool stays = true;
      for (int j = 0; j < n; ++j) stays = stays && leaves(j, other[j]) <= 0.0;
      held_[k] = true;
      if (!stays || other.norm() <= longest.norm()) continue;
      longest = other;
      released = i;
    }
    if (released >= 0) held_[static_cast<std::size_t>(released)] = false;
    return longest;
  }

  bool isInside(const JointVector& q) const {
    for (int i = 0; i < box_.size(); ++i) {
      if (q[i] < box_.lower(i) || q[i] > box_.upper(i)) return false;
    }
    return true;
  }

  void clamp(JointVector& q) const {
    for (int i = 0; i < box_.size(); ++i) q[i] = std::min(std::max(q[i], box_.lower(i)), box_.upper(i));
  }

  double leaves(int i, double rate) const {
    if (held_[static_cast<std::size_t>(i)]) return 0.0;
    if (point_.q[i] <= box_.lower(i) + kAtBound) return -rate;
    return point_.q[i] >= box_.upper(i) - kAtBound ? rate : 0.0;
  }

  TaskMatrix freeColumns(const TaskPoint& point) const {
    TaskMatrix J = point.J;
    for (int i = 0; i < box_.size(); ++i) {
      if (held_[static_cast<std::size_t>(i)]) J.col(i).setZero();
    }
    return J;
  }

  VectorX solve(const TaskPoint& point, const VectorX& rows) const {
    Eigen::CompleteOrthogonalDecomposition<MatrixX> factor;
    factor.setThreshold(kRank);
    factor.compute(MatrixX(freeColumns(point)));
    return factor.solve(rows);
  }

  VectorX project(VectorX way) const {
    for (int i = 0; i < box_.size(); ++i) {
      if (held_[static_cast<std::size_t>(i)]) way[i] = 0.0;
    }
    return way - solve(point_, freeColumns(point_) * way);
  }

  VectorX returning(const TaskPoint& point) const { return solve(point, point.residual); }

  TaskResidual residual_;
  JointBox box_;
  VectorX seed_;
  TaskPoint point_;
  std::vector<bool> held_;
};

}  // namespace

NearestResult nearestOnManifold(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& start,
                                const VectorX& seed, const NearestOptions& options) {
  Walk walk(chain, task, target, seed, options.honour_limits);
  NearestResult result;
  const bool begun = walk.begin(start);
  double share = 0.5;
  for (; begun && result.iterations < options.max_iterations; ++result.iterations) {
    const VectorX way = walk.direction();
    const double longest = way.cwiseAbs().maxCoeff();
    if (longest < options.tolerance) {
      result.converged = true;
      break;
    }
    // Twice the share that did before: the manifold's curvature makes it less or more than the whole way.
    share = std::min({2.0 * share, 4.0, kLongestStep / longest});
    while (share > kShortestStep && !walk.advance(way, share)) share *= 0.5;
    if (share <= kShortestStep) break;
  }
  result.q = walk.point().q;
  result.error = walk.point().error;
  result.distance = (result.q - seed).norm();
  return result;
}

}  // namespace screwline
