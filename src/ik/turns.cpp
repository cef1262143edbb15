#include "turns.h"

#include <algorithm>
#include <cmath>

#include "screwline/exception.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

bool isInside(const JointLimits& limits, double value, double band) {
  return value >= limits.lower - band && value <= limits.upper + band;
}

double onLimit(const JointLimits& limits, double value) {
  return std::clamp(value, limits.lower, limits.upper);
}

/// wrapAngle() that puts values just above -pi on pi: there, rounding alone would choose the end.
double wrapped(double value, double band) {
  const double angle = wrapAngle(value);
  return angle <= -kPi + band ? std::min(kPi, angle + kTwoPi) : angle;
}

/// The turn of `value` inside the limits nearest to `wish`; false where there is none.
bool turnInside(const JointLimits& limits, double wish, double band, double& value) {
  const double nearest = wish + withoutTurns(value - wish);
  const double lowest = nearest + kTwoPi * std::ceil((limits.lower - band - nearest) / kTwoPi);
  const double highest = nearest + kTwoPi * std::floor((limits.upper + band - nearest) / kTwoPi);
  for (double candidate : {nearest, nearest < limits.lower ? lowest : highest}) {
    if (!isInside(limits, candidate, band)) continue;
    value = candidate;
    return true;
  }
  return false;
}

}  // namespace

Turned chooseTurns(const SerialChain& chain, const VectorX& q, const VectorX& reference, bool has_seed,
                   bool ignore_limits, double band) {
  Turned turned{q, true};
  for (int i = 0; i < chain.size(); ++i) {
    const JointLimits& limits = chain.joint(i).limits;
    double& value = turned.q[i];
    bool inside = isInside(limits, value, band);
    if (chain.joint(i).isRevolute()) {
      const double wish = has_seed ? reference[i] : wrapped(value, 1e-12);
      if (!has_seed) value = wish;
      inside = turnInside(limits, wish, band, value);
      if (!inside || ignore_limits) value = wish + withoutTurns(value - wish);
      if (ignore_limits) inside = isInside(limits, value, band);
    }
    if (inside) value = onLimit(limits, value);
    turned.within_limits = turned.within_limits && inside;
  }
  return turned;
}

std::vector<VectorX> allTurns(const SerialChain& chain, const VectorX& chosen, bool ignore_limits, double band) {
  std::vector<VectorX> all = {chosen};
  if (ignore_limits) return all;
  for (int i = 0; i < chain.size(); ++i) {
    const JointLimits& limits = chain.joint(i).limits;
    if (!chain.joint(i).isRevolute() || std::isinf(limits.lower) || std::isinf(limits.upper)) continue;
    const double first = std::ceil((limits.lower - band - chosen[i]) / kTwoPi);
    const double last = std::floor((limits.upper + band - chosen[i]) / kTwoPi);
    const double count = std::max(1.0, last - first + 1.0);
    if (static_cast<double>(all.size()) * count > static_cast<double>(kMaxTurns)) {
      throw InputError(AnswerCode::kTooLarge, "all_turns asks for more than " + std::to_string(kMaxTurns) +
                                                  " turns of one solution; narrow the limits of joint '" +
                                                  chain.joint(i).name + "'");
    }
    const std::vector<VectorX> before = all;
    for (double turn = first; turn <= last; ++turn) {
      if (turn == 0.0) continue;
      for (VectorX q : before) {
        q[i] = onLimit(limits, q[i] + turn * kTwoPi);
        all.push_back(q);
      }
    }
  }
  return all;
}

}  // namespace screwline
