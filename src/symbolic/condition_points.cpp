#include "condition_points.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/QR>

#include "../kinematics/sampling.h"
#include "screwline/kinematics/singularity.h"

namespace screwline {
namespace {

constexpr int kFirstSample = 400;   ///< Apart from the configurations at which factors are found and named.
constexpr double kSameRoot = 1e-7;  ///< [rad, m]
constexpr double kMet = 1e-12;      ///< Of a factor's typical magnitude.
constexpr double kStep = 1e-6;      ///< [rad, m] of the differences.
constexpr double kRank = 1e-7;
constexpr int kNewtonSteps = 60;
constexpr double kLongestStep = 0.5;  ///< [rad, m]

/// Values of some of the joints.
struct Fixed {
  std::vector<bool> is_fixed;
  VectorX q;
};

/// Every combination of the zeros of the factors that depend on one joint.
std::vector<Fixed> fixedCombinations(const SerialChain& chain, const std::vector<const SingularityFactor*>& factors) {
  std::vector<Fixed> all = {
      {std::vector<bool>(static_cast<std::size_t>(chain.size()), false), VectorX::Zero(chain.size())}};
  for (const SingularityFactor* factor : factors) {
    if (factor->joints.size() != 1) continue;
    const int joint = factor->joints.front();
    std::vector<Fixed> next;
    for (const Fixed& fixed : all) {
      double last = -1e9;
      for (const double root : factor->roots) {
        if (std::abs(root - last) < kSameRoot) continue;
        last = root;
        const bool taken = fixed.is_fixed[static_cast<std::size_t>(joint)];
        if (taken && std::abs(fixed.q[joint] - root) > kSameRoot) continue;
        next.push_back(fixed);
        next.back().is_fixed[static_cast<std::size_t>(joint)] = true;
        next.back().q[joint] = root;
      }
    }
    all = std::move(next);
  }
  return all;
}

VectorX residualAt(const std::vector<const SingularityFactor*>& factors, const VectorX& q) {
  VectorX residual(static_cast<Eigen::Index>(factors.size()));
  for (std::size_t i = 0; i < factors.size(); ++i)
    residual[static_cast<Eigen::Index>(i)] = factors[i]->value(q) / std::max(factors[i]->scale, 1e-300);
  return residual;
}

/// Moves the free joints to where all factors are zero; false where that does not come to an end.
bool meet(const std::vector<const SingularityFactor*>& factors, const std::vector<int>& free, VectorX& q) {
  for (int step = 0; step < kNewtonSteps; ++step) {
    const VectorX residual = residualAt(factors, q);
    if (residual.size() == 0 || residual.cwiseAbs().maxCoeff() <= kMet) return true;
    if (free.empty()) return false;
    MatrixX slope(residual.size(), static_cast<Eigen::Index>(free.size()));
    for (std::size_t k = 0; k < free.size(); ++k) {
      VectorX after = q;
      VectorX before = q;
      after[free[k]] += kStep;
      before[free[k]] -= kStep;
      slope.col(static_cast<Eigen::Index>(k)) =
          (residualAt(factors, after) - residualAt(factors, before)) / (2.0 * kStep);
    }
    VectorX move = slope.completeOrthogonalDecomposition().solve(-residual);
    move *= std::min(1.0, kLongestStep / std::max(move.norm(), 1e-300));
    for (std::size_t k = 0; k < free.size(); ++k) q[free[k]] += move[static_cast<Eigen::Index>(k)];
  }
  return false;
}

}  // namespace

std::vector<VectorX> commonZeros(const SerialChain& chain, const std::vector<const SingularityFactor*>& factors,
                                 int starts) {
  std::vector<const SingularityFactor*> open;
  for (const SingularityFactor* factor : factors) {
    if (factor->joints.size() != 1) open.push_back(factor);
  }
  std::vector<VectorX> found;
  for (const Fixed& fixed : fixedCombinations(chain, factors)) {
    std::vector<int> free;
    for (int i = 0; i < chain.size(); ++i) {
      if (!fixed.is_fixed[static_cast<std::size_t>(i)]) free.push_back(i);
    }
    for (int start = 0; start < starts; ++start) {
      VectorX q = sampleConfiguration(chain, kFirstSample + start);
      for (int i = 0; i < chain.size(); ++i) {
        if (fixed.is_fixed[static_cast<std::size_t>(i)]) q[i] = fixed.q[i];
      }
      if (meet(open, free, q)) found.push_back(q);
    }
  }
  return found;
}

int rankAt(const SerialChain& chain, const Task& task, const VectorX& q) {
  Matrix6X J;
  const Matrix3 R_BT = geometricJacobian(chain, q, J).R;
  const VectorX values = singularValues(taskJacobian(task, J, R_BT));
  const double least = std::max(kRank * values[0], jacobianNoise(J));
  return static_cast<int>((values.array() > least).count());
}

std::vector<int> ranksAt(const SerialChain& chain, const Task& task, const std::vector<VectorX>& configurations) {
  std::set<int> ranks;
  for (const VectorX& q : configurations) ranks.insert(rankAt(chain, task, q));
  return {ranks.begin(), ranks.end()};
}

}  // namespace screwline
