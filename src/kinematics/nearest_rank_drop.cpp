#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/QR>

#include "nearest_zero.h"
#include "sampling.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/spatial/svd.h"

namespace screwline {
namespace {

constexpr int kIterations = 14;
constexpr int kRestorations = 8;
constexpr int kScanSteps = 16;
constexpr std::size_t kMaxStarts = 5;
constexpr double kDeep = 0.2;  ///< Of the volume at q.
constexpr double kLongestStep = 0.5;
constexpr double kDifference = 1e-6;
constexpr double kDependent = 1e-6;  ///< Conditions that differ by less are one: not all singularities are isolated.
constexpr double kConverged = 1e-8;

class RankDrop {
 public:
  RankDrop(const TaskDeterminant& volume, const VectorX& q, const Box& box) : volume_(volume), target_(q), box_(box) {}

  std::optional<VectorX> nearest() const {
    std::optional<VectorX> best;
    for (const VectorX& start : starts()) {
      // First a singular configuration next to the start. From there the one nearest to the target: where one condition
      // on the joints makes the rank drop, the smallest singular value alone tells the way; where it takes several, all
      // do.
      const VectorX beside = refined(start, start, kRestorations, false);
      for (const VectorX& q :
           {beside, refined(beside, target_, kIterations, false), refined(beside, target_, kIterations, true)}) {
        if (!isSingular(q)) continue;
        if (!best || (q - target_).norm() < (*best - target_).norm()) best = q;
      }
    }
    return best;
  }

 private:
  MatrixX jacobianAt(const VectorX& q) const { return taskJacobian(volume_.chain(), q, volume_.task()); }

  bool isSingular(const VectorX& q) const {
    Matrix6X J;
    const Matrix3 R_BT = geometricJacobian(volume_.chain(), q, J).R;
    const MatrixX J_task = taskJacobian(volume_.task(), J, R_BT);
    const VectorX sigma = singularValues(J_task);
    return rankOf(sigma, jacobianNoise(J)) < sigma.size();
  }

  struct Dip {
    bool deep;  ///< Low enough for a zero to be near.
    double rank;
    VectorX q;
  };

  /// q, and the dips of the volume along single joints: deep ones first, by their distance, then others, by their
  /// depth.
  std::vector<VectorX> starts() const {
    const VectorX origin = box_.clamped(target_);
    const double here = std::abs(volume_(origin));
    std::vector<Dip> dips;
    for (Eigen::Index i = 0; i < origin.size(); ++i) {
      const bool revolute = volume_.chain().joint(static_cast<int>(i)).isRevolute();
      const double reach = revolute ? kPi : 2.0 * slideReach(volume_.chain());
      std::array<double, 2 * kScanSteps + 1> size;
      VectorX q = origin;
      const auto at = [&](int k) {
        return std::clamp(origin[i] + reach * k / kScanSteps, box_.lower[i], box_.upper[i]);
      };
      for (int k = -kScanSteps; k <= kScanSteps; ++k) {
        q[i] = at(k);
        size[static_cast<std::size_t>(k + kScanSteps)] = std::abs(volume_(q));
      }
      for (int k = 1 - kScanSteps; k < kScanSteps; ++k) {
        const std::size_t middle = static_cast<std::size_t>(k + kScanSteps);
        if (size[middle] >= size[middle - 1] || size[middle] > size[middle + 1]) continue;
        q[i] = at(k);
        const bool deep = size[middle] < kDeep * here;
        dips.push_back({deep, deep ? std::abs(q[i] - origin[i]) : size[middle], q});
      }
    }
    std::stable_sort(dips.begin(), dips.end(),
                     [](const Dip& a, const Dip& b) { return a.deep != b.deep ? a.deep : a.rank < b.rank; });
    std::vector<VectorX> result = {origin};
    for (const Dip& dip : dips) {
      if (result.size() < kMaxStarts) result.push_back(dip.q);
    }
    return result;
  }

  /// Conditions G dq + r = 0, to first order, for the rank to drop at q + dq: u^T J v = 0 for the smallest pair of
  /// singular directions, and for the null directions of the longer side in place of its partner.
  void linearise(const VectorX& q, MatrixX& G, VectorX& r) const {
    const MatrixX J = jacobianAt(q);
    const Svd svd(J, Eigen::ComputeFullU | Eigen::ComputeFullV);
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
  VectorX projected(const VectorX& target, const VectorX& q, const MatrixX& G, const VectorX& r) const {
    MatrixX G_free = G;
    VectorX x = target;
    VectorX held = VectorX::Zero(q.size());
    for (Eigen::Index round = 0; round <= q.size(); ++round) {
      const VectorX from = x;
      Eigen::CompleteOrthogonalDecomposition<MatrixX> solver;
      solver.setThreshold(kDependent);
      solver.compute(G_free);
      x += solver.solve(G * (q - from) - r);
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
        if (held[i] == 0.0) x[i] = target[i];
      }
    }
    return box_.clamped(x);
  }

  VectorX refined(VectorX q, const VectorX& target, int iterations, bool all_conditions) const {
    MatrixX G;
    VectorX r;
    for (int i = 0; i < iterations; ++i) {
      linearise(q, G, r);
      if (!all_conditions) {
        G.conservativeResize(1, Eigen::NoChange);
        r.conservativeResize(1);
      }
      VectorX step = projected(target, q, G, r) - q;
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
