#include <algorithm>
#include <cmath>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "nearest_zero.h"
#include "sampling.h"
#include "screwline/kinematics/singularity.h"

namespace screwline {
namespace {

constexpr int kIterations = 30;
constexpr int kScanSteps = 16;
constexpr std::size_t kMaxStarts = 4;
constexpr double kLongestStep = 0.5;
constexpr double kDifference = 1e-6;
constexpr double kConverged = 1e-10;

class RankDrop {
 public:
  RankDrop(const TaskDeterminant& volume, const VectorX& q, const Box& box) : volume_(volume), target_(q), box_(box) {}

  std::optional<VectorX> nearest() const {
    std::optional<VectorX> best;
    for (const VectorX& start : starts()) {
      const VectorX q = refined(start);
      if (!isSingular(q)) continue;
      if (!best || (q - target_).norm() < (*best - target_).norm()) best = q;
    }
    return best;
  }

 private:
  MatrixX jacobianAt(const VectorX& q) const {
    Matrix6X J;
    geometricJacobian(volume_.chain(), q, J);
    return taskJacobian(volume_.task(), J);
  }

  bool isSingular(const VectorX& q) const {
    Matrix6X J;
    geometricJacobian(volume_.chain(), q, J);
    const MatrixX J_task = taskJacobian(volume_.task(), J);
    const VectorX sigma = Eigen::JacobiSVD<MatrixX>(J_task).singularValues();
    return rankOf(sigma, jacobianNoise(J)) < sigma.size();
  }

  /// q and, of each joint's sweep, the lowest point; the lowest few.
  std::vector<VectorX> starts() const {
    const VectorX origin = box_.clamped(target_);
    std::vector<std::pair<double, VectorX>> lowest;
    for (Eigen::Index i = 0; i < origin.size(); ++i) {
      const bool revolute = volume_.chain().joint(static_cast<int>(i)).isRevolute();
      const double reach = revolute ? kPi : 2.0 * slideReach(volume_.chain());
      std::pair<double, VectorX> low(std::numeric_limits<double>::infinity(), origin);
      for (int k = -kScanSteps; k <= kScanSteps; ++k) {
        VectorX q = origin;
        q[i] += reach * k / kScanSteps;
        q = box_.clamped(q);
        const double size = std::abs(volume_(q));
        if (size < low.first) low = {size, q};
      }
      lowest.push_back(low);
    }
    std::stable_sort(lowest.begin(), lowest.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<VectorX> result = {origin};
    for (const auto& [size, q] : lowest) {
      if (result.size() < kMaxStarts) result.push_back(q);
    }
    return result;
  }

  /// Conditions G dq + r = 0, to first order, for the rank to drop at q + dq: u^T J v = 0 for the smallest pair of
  /// singular directions, and for the null directions of the longer side in place of its partner.
  void linearise(const VectorX& q, MatrixX& G, VectorX& r) const {
    const MatrixX J = jacobianAt(q);
    const Eigen::JacobiSVD<MatrixX> svd(J, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Index short_side = std::min(J.rows(), J.cols());
    const Eigen::Index count = std::max(J.rows(), J.cols()) - short_side + 1;
    const bool wide = J.rows() <= J.cols();
    G.resize(count, q.size());
    r = VectorX::Zero(count);
    r[0] = svd.singularValues()[short_side - 1];
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      VectorX moved = q;
      moved[j] += kDifference;
      const MatrixX above = jacobianAt(moved);
      moved[j] -= 2.0 * kDifference;
      const MatrixX slope = (above - jacobianAt(moved)) / (2.0 * kDifference);
      for (Eigen::Index k = 0; k < count; ++k) {
        const Eigen::Index u = short_side - 1 + (wide ? 0 : k);
        const Eigen::Index v = short_side - 1 + (wide ? k : 0);
        G(k, j) = svd.matrixU().col(u).dot(slope * svd.matrixV().col(v));
      }
    }
  }

  /// The point of G (x - q) + r = 0 nearest to the target, joints that leave the box held at its bounds.
  VectorX projected(const VectorX& q, const MatrixX& G, const VectorX& r) const {
    MatrixX G_free = G;
    VectorX x = target_;
    VectorX held = VectorX::Zero(q.size());
    for (Eigen::Index round = 0; round <= q.size(); ++round) {
      const VectorX from = x;
      x += Eigen::CompleteOrthogonalDecomposition<MatrixX>(G_free).solve(G * (q - from) - r);
      bool inside = true;
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        if (held[i] != 0.0 || (x[i] >= box_.lower[i] && x[i] <= box_.upper[i])) continue;
        x[i] = std::clamp(x[i], box_.lower[i], box_.upper[i]);
        held[i] = 1.0;
        G_free.col(i).setZero();
        inside = false;
      }
      if (inside) break;
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        if (held[i] == 0.0) x[i] = target_[i];
      }
    }
    return box_.clamped(x);
  }

  VectorX refined(VectorX q) const {
    MatrixX G;
    VectorX r;
    for (int i = 0; i < kIterations; ++i) {
      linearise(q, G, r);
      VectorX step = projected(q, G, r) - q;
      const double length = step.norm();
      if (length > kLongestStep) step *= kLongestStep / length;
      q += step;
      if (length < kConverged) break;
    }
    return q;
  }

  const TaskDeterminant& volume_;
  VectorX target_;
  Box box_;
};

}  // namespace

std::optional<VectorX> nearestRankDrop(const TaskDeterminant& volume, const VectorX& q, const Box& box) {
  return RankDrop(volume, q, box).nearest();
}

}  // namespace screwline
