#include "candidate.h"

#include <algorithm>
#include <cmath>

#include "screwline/spatial/rotation.h"

namespace screwline {

VectorX nearestTurns(const SerialChain& chain, VectorX q, const VectorX& reference) {
  for (int i = 0; i < chain.size(); ++i) {
    if (chain.joint(i).isRevolute()) q[i] = reference[i] + std::remainder(q[i] - reference[i], kTwoPi);
  }
  return q;
}

namespace {

double jointDifference(const SerialChain& chain, const VectorX& a, const VectorX& b, int i) {
  const double difference = a[i] - b[i];
  return std::abs(chain.joint(i).isRevolute() ? std::remainder(difference, kTwoPi) : difference);
}

}  // namespace

double largestDifference(const SerialChain& chain, const VectorX& a, const VectorX& b) {
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
