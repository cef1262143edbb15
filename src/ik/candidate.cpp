#include "candidate.h"

#include <cmath>

#include "screwline/spatial/rotation.h"

namespace screwline {

VectorX nearestTurns(const SerialChain& chain, VectorX q, const VectorX& reference) {
  for (int i = 0; i < chain.size(); ++i) {
    if (chain.joint(i).isRevolute()) q[i] = reference[i] + std::remainder(q[i] - reference[i], kTwoPi);
  }
  return q;
}

double largestDifference(const SerialChain& chain, const VectorX& a, const VectorX& b) {
  double largest = 0.0;
  for (int i = 0; i < chain.size(); ++i) {
    const double difference = a[i] - b[i];
    largest =
        std::max(largest, std::abs(chain.joint(i).isRevolute() ? std::remainder(difference, kTwoPi) : difference));
  }
  return largest;
}

}  // namespace screwline
