#include "candidate.h"

#include <algorithm>
#include <cmath>

#include "screwline/ik/algebraic/algebraic_solver.h"
#include "screwline/spatial/rotation.h"

namespace screwline {

Candidate unnamed(const VectorX& q) {
  Candidate candidate;
  candidate.q = q;
  return candidate;
}

std::vector<Candidate> rootsOf(const AlgebraicSolver& solver, const Pose& target, bool& complete) {
  AlgebraicSolutions roots;
  solver.solve(target, roots);
  complete = roots.complete;
  std::vector<Candidate> candidates;
  for (const std::array<double, 6>& q : roots) candidates.push_back(unnamed(Eigen::Map<const VectorX>(q.data(), 6)));
  return candidates;
}

void bringNear(const SerialChain& chain, const Eigen::Ref<const VectorX>& reference, Eigen::Ref<VectorX> q) {
  for (int i = 0; i < chain.size(); ++i) {
    const double apart = q[i] - reference[i];
    if (chain.joint(i).isRevolute() && !(std::abs(apart) <= kPi)) q[i] = reference[i] + withoutTurns(apart);
  }
}

VectorX nearestTurns(const SerialChain& chain, VectorX q, const VectorX& reference) {
  bringNear(chain, reference, q);
  return q;
}

namespace {

double jointDifference(const SerialChain& chain, const Eigen::Ref<const VectorX>& a, const Eigen::Ref<const VectorX>& b,
                       int i) {
  const double difference = std::abs(a[i] - b[i]);
  return difference > kPi && chain.joint(i).isRevolute() ? std::abs(withoutTurns(difference)) : difference;
}

}  // namespace

double largestDifference(const SerialChain& chain, const Eigen::Ref<const VectorX>& a,
                         const Eigen::Ref<const VectorX>& b) {
  double largest = 0.0;
  for (int i = 0; i < chain.size(); ++i) largest = std::max(largest, jointDifference(chain, a, b, i));
  return largest;
}

bool isSameConfiguration(const SerialChain& chain, const VectorX& a, const VectorX& b) {
  for (int i = 0; i < chain.size(); ++i) {
    if (!(jointDifference(chain, a, b, i) <= kSameSolution)) return false;
  }
  return true;
}

}  // namespace screwline
