#include "nearest_zero.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "sampling.h"

namespace screwline {
namespace {

constexpr int kScanSteps = 12;  ///< To each side.
constexpr int kBisections = 50;
constexpr std::size_t kFewJoints =
    3;  ///< Up to so many, diagonals are scanned and Newton's method ends the refinement.
constexpr std::size_t kMaxRefined = 4;
constexpr int kIterations = 40;
constexpr double kDifference = 1e-6;
constexpr double kHessianDifference = 1e-4;
constexpr double kConverged = 1e-7;  ///< Of a step; the distance is then right to its square.
constexpr double kNewtonRange = 0.05;

/// f over the joints that may move, in their own coordinates x.
class ZeroSurface {
 public:
  ZeroSurface(const JointFunction& f, const SerialChain& chain, const std::vector<int>& joints, const VectorX& q,
              const Box& box)
      : f_(f),
        joints_(joints),
        full_(box.clamped(q)),
        target_(reduced(q)),
        lower_(reduced(box.lower)),
        upper_(reduced(box.upper)),
        reach_(target_.size()) {
    for (Eigen::Index i = 0; i < reach_.size(); ++i) {
      const bool revolute = chain.joint(joints_[static_cast<std::size_t>(i)]).isRevolute();
      reach_[i] = revolute ? kPi : 4.0 * slideReach(chain);
    }
  }

  /// The best zero found.
  std::optional<VectorX> nearest() const {
    std::vector<VectorX> starts = scan();
    std::sort(starts.begin(), starts.end(), [this](const VectorX& a, const VectorX& b) { return cost(a) < cost(b); });
    if (starts.size() > kMaxRefined) starts.resize(kMaxRefined);
    std::optional<VectorX> best;
    for (const VectorX& start : starts) {
      // The start itself is a zero too.
      for (const VectorX& x : {start, refined(start)}) {
        if (isZero(x) && (!best || cost(x) < cost(*best))) best = x;
      }
    }
    if (best) best = expanded(*best);
    return best;
  }

 private:
  VectorX reduced(const VectorX& q) const {
    VectorX x(static_cast<Eigen::Index>(joints_.size()));
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = q[joints_[static_cast<std::size_t>(i)]];
    return x;
  }

  VectorX expanded(const VectorX& x) const {
    VectorX q = full_;
    for (Eigen::Index i = 0; i < x.size(); ++i) q[joints_[static_cast<std::size_t>(i)]] = x[i];
    return q;
  }

  double value(const VectorX& x) const { return f_(expanded(x)); }
  double cost(const VectorX& x) const { return (x - target_).squaredNorm(); }
  VectorX clamped(const VectorX& x) const { return x.cwiseMax(lower_).cwiseMin(upper_); }

  VectorX gradient(const VectorX& x) const {
    VectorX g(x.size());
    VectorX moved = x;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      moved[i] = x[i] + kDifference;
      const double above = value(moved);
      moved[i] = x[i] - kDifference;
      g[i] = (above - value(moved)) / (2.0 * kDifference);
      moved[i] = x[i];
    }
    return g;
  }

  bool isZero(const VectorX& x) const {
    const VectorX g = gradient(x);
    return std::abs(value(x)) <= 1e-10 * g.norm() * std::max(1.0, reach_.minCoeff());
  }

  std::vector<VectorX> directions() const {
    std::vector<VectorX> result;
    const Eigen::Index n = target_.size();
    for (Eigen::Index i = 0; i < n; ++i) {
      result.push_back(VectorX::Unit(n, i) * reach_[i]);
      for (Eigen::Index j = 0; joints_.size() <= kFewJoints && j < i; ++j) {
        result.push_back(VectorX::Unit(n, i) * reach_[i] + VectorX::Unit(n, j) * reach_[j]);
        result.push_back(VectorX::Unit(n, i) * reach_[i] - VectorX::Unit(n, j) * reach_[j]);
      }
    }
    return result;
  }

  /// The first sign change to both sides along each direction.
  std::vector<VectorX> scan() const {
    const VectorX origin = clamped(target_);
    const double f_origin = value(origin);
    std::vector<VectorX> zeros;
    for (const VectorX& direction : directions()) {
      for (double side : {1.0, -1.0}) {
        const VectorX step = side * direction / kScanSteps;
        double t_before = 0.0;
        for (int k = 1; k <= kScanSteps; ++k) {
          const VectorX x = clamped(origin + k * step);
          if (value(x) * f_origin <= 0.0) {
            zeros.push_back(bisected(origin, step, t_before, k, f_origin));
            break;
          }
          t_before = k;
        }
      }
    }
    return zeros;
  }

  VectorX bisected(const VectorX& origin, const VectorX& step, double t_low, double t_high, double f_origin) const {
    for (int i = 0; i < kBisections; ++i) {
      const double t = 0.5 * (t_low + t_high);
      (value(clamped(origin + t * step)) * f_origin > 0.0 ? t_low : t_high) = t;
    }
    return clamped(origin + t_high * step);
  }

  /// mu for which clamped(target + mu g) lies on the plane g . (x' - x) + f = 0; the left side does not fall as mu
  /// grows.
  double multiplierOf(const VectorX& x, double f, const VectorX& g) const {
    const auto excess = [&](double mu) { return g.dot(clamped(target_ + mu * g) - x) + f; };
    const double free = (g.dot(x - target_) - f) / g.squaredNorm();
    if (std::abs(excess(free)) <= 1e-14 * (std::abs(f) + g.norm())) return free;
    double low = free;
    double high = free;
    double width = std::max(1.0, std::abs(free));
    for (int i = 0; i < 20 && excess(low) > 0.0; ++i, width *= 2.0) low -= width;
    for (int i = 0; i < 20 && excess(high) < 0.0; ++i, width *= 2.0) high += width;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (excess(middle) < 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  VectorX refined(VectorX x) const {
    for (int i = 0; i < kIterations; ++i) {
      const double f = value(x);
      const VectorX g = gradient(x);
      if (g.squaredNorm() == 0.0) return x;
      const double mu = multiplierOf(x, f, g);
      const VectorX step = clamped(target_ + mu * g) - x;
      const double weight = 2.0 * std::abs(mu) + 1e-3;
      const double merit = 0.5 * cost(x) + weight * std::abs(f);
      double share = 1.0;
      while (share > 1e-3 && 0.5 * cost(x + share * step) + weight * std::abs(value(x + share * step)) > merit)
        share *= 0.5;
      x += share * step;
      if (step.norm() < kConverged) break;
      if (step.norm() > kNewtonRange || joints_.size() > kFewJoints) continue;
      if (const std::optional<VectorX> end = newton(x, mu)) return restored(*end);
    }
    return restored(x);
  }

  /// Newton's method on x = target + mu g, f = 0; none where that does not settle nearby in the box.
  std::optional<VectorX> newton(const VectorX& start, double mu) const {
    const Eigen::Index n = start.size();
    VectorX x = start;
    for (int i = 0; i < 8; ++i) {
      const VectorX g = gradient(x);
      MatrixX A = MatrixX::Zero(n + 1, n + 1);
      for (Eigen::Index k = 0; k < n; ++k) {
        VectorX moved = x;
        moved[k] += kHessianDifference;
        A.col(k).head(n) = -mu / kHessianDifference * (gradient(moved) - g);
      }
      A.topLeftCorner(n, n) += MatrixX::Identity(n, n);
      A.col(n).head(n) = -g;
      A.row(n).head(n) = g.transpose();
      VectorX residual(n + 1);
      residual << x - target_ - mu * g, value(x);
      const VectorX step = A.partialPivLu().solve(-residual);
      if (!step.allFinite()) return std::nullopt;
      x += step.head(n);
      mu += step[n];
      if ((x - start).norm() > 4.0 * kNewtonRange || x != clamped(x)) return std::nullopt;
      if (step.head(n).norm() < kConverged) return x;
    }
    return std::nullopt;
  }

  /// The zero next to x: Newton steps along the gradient of the joints that are not held at a bound.
  VectorX restored(VectorX x) const {
    for (int i = 0; i < 8; ++i) {
      VectorX g = gradient(x);
      const double f = value(x);
      const VectorX wanted = x - f * g;
      for (Eigen::Index k = 0; k < x.size(); ++k) {
        if (wanted[k] < lower_[k] || wanted[k] > upper_[k]) g[k] = 0.0;
      }
      if (g.squaredNorm() == 0.0) break;
      x = clamped(x - f / g.squaredNorm() * g);
    }
    return x;
  }

  const JointFunction& f_;
  std::vector<int> joints_;
  VectorX full_;
  VectorX target_;
  VectorX lower_;
  VectorX upper_;
  VectorX reach_;  ///< How far each joint is scanned.
};

}  // namespace

std::optional<VectorX> nearestZero(const JointFunction& f, const SerialChain& chain, const std::vector<int>& joints,
                                   const VectorX& q, const Box& box) {
  return ZeroSurface(f, chain, joints, q, box).nearest();
}

}  // namespace screwline
