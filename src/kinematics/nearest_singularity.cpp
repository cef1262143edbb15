#include "nearest_singularity.h"

#include <algorithm>
#include <cmath>

#include "nearest_zero.h"
#include "screwline/kinematics/singularity.h"

namespace screwline {
namespace {

bool isSingular(const TaskDeterminant& determinant, const VectorX& q) {
  Matrix6X J;
  const Matrix3 R_BT = geometricJacobian(determinant.chain(), q, J).R;
  const VectorX sigma = singularValues(taskJacobian(determinant.task(), J, R_BT));
  return rankOf(sigma, jacobianNoise(J)) < sigma.size();
}

/// The value of a factor's joint nearest to q that makes it zero, within bounds.
std::optional<double> nearestRoot(const SingularityFactor& factor, bool revolute, double q, double lower,
                                  double upper) {
  std::optional<double> best;
  for (double root : factor.roots) {
    double value = root;
    if (revolute) {
      value += kTwoPi * std::round((q - root) / kTwoPi);
      if (value > upper) value -= kTwoPi * std::ceil((value - upper) / kTwoPi);
      if (value < lower) value += kTwoPi * std::ceil((lower - value) / kTwoPi);
    }
    if (value < lower || value > upper) continue;
    if (!best || std::abs(value - q) < std::abs(*best - q)) best = value;
  }
  return best;
}

/// Candidate of one factor.
std::optional<VectorX> candidateOf(const TaskDeterminant& determinant, const SingularityFactor& factor,
                                   const VectorX& q, const Box& box) {
  const SerialChain& chain = determinant.chain();
  if (!factor.isExplicit() && !determinant.isSquare()) return nearestRankDrop(determinant, q, box);
  if (!factor.isExplicit()) {
    return nearestZero([&determinant](const VectorX& x) { return determinant(x); }, chain, factor.joints, q, box);
  }
  if (factor.roots.empty()) {
    return nearestZero([&factor](const VectorX& x) { return factor.value(x); }, chain, factor.joints, q, box);
  }
  const int joint = factor.joints.front();
  const std::optional<double> root =
      nearestRoot(factor, chain.joint(joint).isRevolute(), q[joint], box.lower[joint], box.upper[joint]);
  if (!root) return std::nullopt;
  VectorX candidate = box.clamped(q);
  candidate[joint] = *root;
  return candidate;
}

std::string noteOf(const std::vector<SingularityFactor>& factors, bool within_limits) {
  const bool exact =
      std::all_of(factors.begin(), factors.end(), [](const SingularityFactor& f) { return !f.roots.empty(); });
  const std::string where =
      within_limits ? "" : "; no singular configuration was found within the limits, this one is outside";
  if (exact) return "exact: each factor of the determinant depends on one joint, its zeros are known" + where;
  return "upper bound on the distance: zeros of the determinant's factors along the joints, moved to where the "
         "distance is stationary "
         "(sequential quadratic programming); the result is singular to the rank's tolerance" +
         where;
}

}  // namespace

NearestSingularity nearestSingularity(const TaskDeterminant& determinant, const VectorX& q,
                                      const std::vector<SingularityFactor>& factors, bool singular) {
  const SerialChain& chain = determinant.chain();
  const Box limits = {chain.lower(), chain.upper()};
  if (singular) return {q, 0.0, q == limits.clamped(q), "the configuration itself is singular"};
  NearestSingularity nearest;
  if (factors.empty()) {
    nearest.note = "the task is never singular: its determinant has no zero";
    return nearest;
  }
  const VectorX infinite = VectorX::Constant(q.size(), std::numeric_limits<double>::infinity());
  for (const Box& box : {limits, Box{-infinite, infinite}}) {
    for (const SingularityFactor& factor : factors) {
      const std::optional<VectorX> candidate = candidateOf(determinant, factor, q, box);
      if (!candidate || !isSingular(determinant, *candidate)) continue;
      const double distance = (*candidate - q).norm();
      if (distance >= nearest.distance) continue;
      nearest.q = *candidate;
      nearest.distance = distance;
    }
    if (nearest.q.size() == 0) continue;
    nearest.within_limits = nearest.q == limits.clamped(nearest.q);
    nearest.note = noteOf(factors, nearest.within_limits);
    return nearest;
  }
  nearest.note = "no singular configuration was found";
  return nearest;
}

}  // namespace screwline
