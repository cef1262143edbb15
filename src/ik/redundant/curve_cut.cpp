#include "curve_cut.h"

#include <algorithm>
#include <cmath>

#include "curve_tracer.h"

namespace screwline {
namespace {

constexpr double kOnLimit = 1e-12;   // [rad, m]
constexpr double kRounding = 1e-15;  // [rad, m] A parameter joint that moves less stands still.
constexpr int kMaxDepth = 64;        // Limits between two nodes.
constexpr double kTouching = 1e-10;  // [rad, m] A curve this near to the box touches it.

bool cuts(const Joint& joint) {
  return !joint.isRevolute() || joint.limits.upper - joint.limits.lower < kTwoPi + 1e-9;
}

/// A limit strictly between two values of a joint.
bool limitBetween(const Joint& joint, double from, double to, double& value) {
  if (!cuts(joint)) return false;
  const double low = std::min(from, to) + kOnLimit;
  const double high = std::max(from, to) - kOnLimit;
  for (double limit : {joint.limits.lower, joint.limits.upper}) {
    if (std::isinf(limit)) continue;
    const double turned = joint.isRevolute() ? limit + kTwoPi * std::ceil((low - limit) / kTwoPi) : limit;
    if (turned < low || turned > high) continue;
    value = turned;
    return true;
  }
  return false;
}

void append(PoseCurve& pose, const SelfMotionNode& a, const SelfMotionNode& b, int depth,
            std::vector<SelfMotionNode>& nodes) {
  for (int i = 0; i < kRedundantJoints && depth < kMaxDepth; ++i) {
    double limit = 0.0;
    if (!limitBetween(pose.chain().joint(i), a.q[i], b.q[i], limit)) continue;
    SelfMotionNode node;
    if (!nodeAtZero(
            pose, a, b, [i, limit](const SelfMotionNode& n) { return n.q[i] - limit; }, node))
      continue;
    if (std::abs(node.q[i] - limit) > kTouching || node.arc <= a.arc || node.arc >= b.arc) continue;
    node.q[i] = limit;
    append(pose, a, node, depth + 1, nodes);
    append(pose, node, b, depth + 1, nodes);
    return;
  }
  nodes.push_back(b);
}

bool isWithin(const SerialChain& chain, const Vector7& q, double band) {
  for (int i = 0; i < kRedundantJoints; ++i) {
    if (!isWithin(chain.joint(i), q[i], band)) return false;
  }
  return true;
}

/// Values are monotone between nodes and no limit lies between: half-way decides for all. A joint that moves by less
/// than rounding is on its limit where it is near it.
bool isSegmentWithin(const SerialChain& chain, const SelfMotionNode& a, const SelfMotionNode& b) {
  return isWithin(chain, 0.5 * (a.q + b.q), kTouching);
}

}  // namespace

bool isWithin(const Joint& joint, double value, double band) {
  const double low = joint.limits.lower - band;
  const double high = joint.limits.upper + band;
  if (value >= low && value <= high) return true;
  if (!joint.isRevolute()) return false;
  if (high - low >= kTwoPi) return true;
  return value - kTwoPi * std::floor((value - low) / kTwoPi) <= high;
}

void keepWhole(SelfMotionCurve& curve) {
  curve.intervals = {{0, static_cast<int>(curve.nodes.size()) - 1, true}};
}

void cutByLimits(PoseCurve& pose, SelfMotionCurve& curve) {
  const SerialChain& chain = pose.chain();
  std::vector<SelfMotionNode> nodes = {curve.nodes.front()};
  for (std::size_t i = 0; i + 1 < curve.nodes.size(); ++i) append(pose, curve.nodes[i], curve.nodes[i + 1], 0, nodes);
  curve.nodes = std::move(nodes);
  curve.intervals.clear();
  const int count = static_cast<int>(curve.nodes.size()) - 1;  // Segments.
  std::vector<bool> good(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    good[k] = isSegmentWithin(chain, curve.nodes[k], curve.nodes[k + 1]);
  }
  if (std::find(good.begin(), good.end(), false) == good.end()) return keepWhole(curve);
  const auto isGood = [&](int i) {
    if (i < 0 || i >= count) return curve.closed && good[static_cast<std::size_t>((i + count) % count)];
    return static_cast<bool>(good[static_cast<std::size_t>(i)]);
  };
  for (int i = 0; i < count + (curve.closed ? 0 : 1); ++i) {
    if (isGood(i) && !isGood(i - 1)) {
      int last = i;
      while (isGood(last % (curve.closed ? count : count + 1)) && last - i < count) ++last;
      curve.intervals.push_back({i, last, false});
    } else if (!isGood(i) && !isGood(i - 1) && isWithin(chain, curve.nodes[static_cast<std::size_t>(i)].q, kTouching)) {
      curve.intervals.push_back({i, i, false});
    }
  }
}

void splitAtFolds(SelfMotionCurve& curve, int parameter) {
  curve.folds.clear();
  curve.arcs.clear();
  const int count = static_cast<int>(curve.nodes.size()) - 1;
  if (parameter >= 0) {
    for (int i = curve.closed ? 0 : 1; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const auto before = static_cast<std::size_t>(i == 0 ? count - 1 : i - 1);
      const double behind = curve.nodes[before + 1].q[parameter] - curve.nodes[before].q[parameter];
      const double ahead = curve.nodes[k + 1].q[parameter] - curve.nodes[k].q[parameter];
      if (behind * ahead < 0.0 && std::min(std::abs(behind), std::abs(ahead)) > kRounding) curve.folds.push_back(i);
    }
  }
  if (curve.folds.empty()) {
    curve.arcs = {{0, count, ""}};
    return;
  }
  if (!curve.closed) curve.arcs.push_back({0, curve.folds.front(), ""});
  for (std::size_t i = 0; i + 1 < curve.folds.size(); ++i)
    curve.arcs.push_back({curve.folds[i], curve.folds[i + 1], ""});
  curve.arcs.push_back({curve.folds.back(), curve.closed ? curve.folds.front() + count : count, ""});
}

}  // namespace screwline
