#include "joint_box.h"

#include <algorithm>
#include <cmath>

#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr double kNoLength = 2e-6;  ///< [m] characteristicLength() is at least half of it.
constexpr double kFarTurn = 1e3;    ///< [rad] beyond it a joint without bounds begins anew: digits are lost there.

int nextPrime(int after) {
  for (int candidate = after + 1;; ++candidate) {
    int divisor = 2;
    while (divisor * divisor <= candidate && candidate % divisor != 0) ++divisor;
    if (divisor * divisor > candidate) return candidate;
  }
}

}  // namespace

double lengthUnit(const SerialChain& chain) {
  if (chain.characteristicLength() > kNoLength) return chain.characteristicLength();
  double longest = 0.0;
  for (const Joint& joint : chain.joints()) {
    const double range = joint.limits.upper - joint.limits.lower;
    if (!joint.isRevolute() && std::isfinite(range)) longest = std::max(longest, range);
  }
  return longest > kNoLength ? longest : 1.0;
}

JointBox::JointBox(const SerialChain& chain, bool honour_limits, double reach) {
  const double infinity = std::numeric_limits<double>::infinity();
  const int n = chain.size();
  const double length = lengthUnit(chain);
  lower_ = honour_limits ? chain.lower() : VectorX::Constant(n, -infinity);
  upper_ = honour_limits ? chain.upper() : VectorX::Constant(n, infinity);
  unit_ = JointVector::Ones(n);
  half_span_ = JointVector::Constant(n, kPi);
  periodic_.fill(true);
  for (const Axis& axis : chain.axes()) {
    const bool whole = !axis.prismatic && axis.multiplier == std::round(axis.multiplier);
    periodic_[static_cast<std::size_t>(axis.source)] &= whole;
  }
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!chain.joint(i).isRevolute()) {
      unit_[i] = length;
      half_span_[i] = 2.0 * std::max(length, reach);
    }
    free_[k] = (std::isinf(lower_[i]) && std::isinf(upper_[i])) || (periodic_[k] && upper_[i] - lower_[i] >= kTwoPi);
  }
}

void JointBox::confine(JointVector& q) const {
  for (int i = 0; i < size(); ++i) {
    if (isPeriodic(i) && isFree(i)) {
      if (std::abs(q[i]) > kFarTurn && std::isinf(lower_[i]) && std::isinf(upper_[i])) {
        q[i] = wrapAngle(q[i]);
      } else if (q[i] < lower_[i]) {
        q[i] += kTwoPi * std::ceil((lower_[i] - q[i]) / kTwoPi);
      } else if (q[i] > upper_[i]) {
        q[i] -= kTwoPi * std::ceil((q[i] - upper_[i]) / kTwoPi);
      }
    }
    q[i] = std::min(std::max(q[i], lower_[i]), upper_[i]);
  }
}

void JointBox::wrapUnbounded(VectorX& q) const {
  for (int i = 0; i < size(); ++i) {
    const bool unbounded = std::isinf(lower_[i]) && std::isinf(upper_[i]);
    if (unbounded && isPeriodic(i) && std::abs(q[i]) > kPi) q[i] = wrapAngle(q[i]);
  }
}

double JointBox::distance(const ConstVectorRef& a, const ConstVectorRef& b) const {
  double largest = 0.0;
  for (int i = 0; i < size(); ++i) {
    double difference = a[i] - b[i];
    if (isPeriodic(i)) difference = std::remainder(difference, kTwoPi);
    largest = std::max(largest, std::abs(difference) / unit_[i]);
  }
  return largest;
}

VectorX JointBox::restart(int index) const {
  VectorX q(size());
  int prime = 1;
  for (int i = 0; i < size(); ++i) {
    prime = nextPrime(prime);
    double whole = 0.0;
    const double fraction = std::modf(0.5 + index * std::sqrt(static_cast<double>(prime)), &whole);
    const double half_span = half_span_[i];
    double from = lower_[i];
    double to = upper_[i];
    if (std::isinf(from)) from = std::isinf(to) ? -half_span : to - 2.0 * half_span;
    if (std::isinf(to)) to = from + 2.0 * half_span;
    q[i] = std::min(from + fraction * (to - from), to);
  }
  return q;
}

}  // namespace screwline
