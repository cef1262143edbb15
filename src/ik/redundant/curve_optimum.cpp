#include "curve_optimum.h"

#include <algorithm>
#include <cmath>

#include "curve_tracer.h"

namespace screwline {
namespace {

constexpr double kBand = 1e-10;    // [rad, m] beyond a limit that rounding may bring.
constexpr double kLevel = 1e-7;    // Slope of the distance at its least value, of 1 + the distance.
constexpr int kMostHalvings = 36;  // Of a step: to where a joint changes its turn at a limit, to 1e-11 rad.
constexpr int kBestCount = 6;      // Of the places where a maximum may be, so many are refined.

double turnedValue(const Joint& joint, double value, double seed, bool ignore_limits) {
  const JointLimits& limits = joint.limits;
  if (!joint.isRevolute()) {
    const bool rounded = value >= limits.lower - kBand && value <= limits.upper + kBand;
    return rounded && !ignore_limits ? std::clamp(value, limits.lower, limits.upper) : value;
  }
  const double nearest = seed + std::remainder(value - seed, kTwoPi);
  if (ignore_limits) return nearest;
  double turned = nearest;
  if (nearest < limits.lower - kBand)
    turned += kTwoPi * std::ceil((limits.lower - kBand - nearest) / kTwoPi);
  else if (nearest > limits.upper + kBand)
    turned -= kTwoPi * std::ceil((nearest - limits.upper - kBand) / kTwoPi);
  // Of a joint that is nowhere within, the value as it is.
  if (turned < limits.lower - kBand || turned > limits.upper + kBand) return nearest;
  return std::clamp(turned, limits.lower, limits.upper);
}

/// Where on the interval f is largest between two indices: golden section over a stretch of segments.
SelfMotionNode refine(PoseCurve& pose, const SelfMotionNode& a, const SelfMotionNode& b,
                      const std::function<double(const Vector7&)>& value) {
  constexpr double kGolden = 0.6180339887498949;
  SelfMotionNode left;
  SelfMotionNode right;
  double low = 0.0;
  double high = 1.0;
  const auto at = [&](double share, SelfMotionNode& node) {
    return pose.between(a, b, share, node) ? value(node.q) : -std::numeric_limits<double>::infinity();
  };
  double x = high - kGolden * (high - low);
  double y = low + kGolden * (high - low);
  double fx = at(x, left);
  double fy = at(y, right);
  while ((high - low) * (b.arc - a.arc) > 1e-9) {
    if (fx >= fy) {
      high = y;
      y = x;
      fy = fx;
      right = left;
      x = high - kGolden * (high - low);
      fx = at(x, left);
    } else {
      low = x;
      x = y;
      fx = fy;
      left = right;
      y = low + kGolden * (high - low);
      fy = at(y, right);
    }
  }
  return fx >= fy ? left : right;
}

/// The nearest of the points considered.
class NearestSearch {
 public:
  NearestSearch(PoseCurve& pose, const Vector7& seed, const Vector7& counts, bool ignore_limits,
                const SelfMotionNode& first)
      : pose_(pose),
        seed_(seed),
        counts_(counts),
        ignore_limits_(ignore_limits),
        best_(first),
        least_(off(first).norm()) {}

  const SelfMotionNode& best() const { return best_; }

  /// Whether that node is the nearest yet though its tangent, taken in a way of 1 or -1, leads to nearer ones.
  bool leadsOn(const SelfMotionNode& node, double way) const {
    return node.q == best_.q && way * off(node).dot(node.tangent) < -kLevel * (1.0 + least_);
  }

  void consider(const SelfMotionNode& node) {
    const double distance = off(node).norm();
    if (distance >= least_) return;
    least_ = distance;
    best_ = node;
  }

  /// The least distance between two nodes: where its derivative vanishes. Where a joint is nearer to the seed by
  /// another turn at one of them, there may be more than one: the parts are looked at.
  void refine(const SelfMotionNode& a, const SelfMotionNode& b, int depth) {
    // No point between is nearer than this.
    const double stretch = std::max(1.0, pose_.chain().characteristicLength());
    if (std::min(off(a).norm(), off(b).norm()) - stretch * (b.arc - a.arc) >= least_) return;
    SelfMotionNode node;
    if (depth < kMostHalvings && (shift(a) - shift(b)).cwiseAbs().maxCoeff() > kPi) {
      if (!pose_.between(a, b, 0.5, node)) return;
      consider(node);
      refine(a, node, depth + 1);
      refine(node, b, depth + 1);
      return;
    }
    const auto slope = [this](const SelfMotionNode& at) { return off(at).dot(at.tangent); };
    if (slope(a) < 0.0 && slope(b) > 0.0 && nodeAtZero(pose_, a, b, slope, node)) consider(node);
  }

 private:
  Vector7 off(const SelfMotionNode& node) const {
    return counts_.cwiseProduct(turnedTo(pose_.chain(), node.q, seed_, ignore_limits_) - seed_);
  }
  /// Full turns.
  Vector7 shift(const SelfMotionNode& node) const {
    return counts_.cwiseProduct(turnedTo(pose_.chain(), node.q, seed_, ignore_limits_) - node.q);
  }

  PoseCurve& pose_;
  const Vector7& seed_;
  const Vector7& counts_;
  bool ignore_limits_;
  SelfMotionNode best_;
  double least_;
};

}  // namespace

Vector7 turnedTo(const SerialChain& chain, const Vector7& q, const Vector7& seed, bool ignore_limits) {
  Vector7 turned;
  for (int i = 0; i < kRedundantJoints; ++i) turned[i] = turnedValue(chain.joint(i), q[i], seed[i], ignore_limits);
  return turned;
}

SelfMotionNode nearestNode(PoseCurve& pose, const SelfMotionCurve& curve, const SelfMotionInterval& interval,
                           const Vector7& seed, const Vector7& counts, bool ignore_limits) {
  NearestSearch search(pose, seed, counts, ignore_limits, nodeAt(curve, interval.first));
  for (int i = interval.first; i <= interval.last; ++i) search.consider(nodeAt(curve, i));
  for (int i = interval.first; i < interval.last; ++i) search.refine(nodeAt(curve, i), nodeAt(curve, i + 1), 0);
  // Beside a crossing tangents are rounding's: what slopes do not show, distances do.
  const auto nearness = [&](const Vector7& q) {
    return -counts.cwiseProduct(turnedTo(pose.chain(), q, seed, ignore_limits) - seed).norm();
  };
  for (int i = interval.first; i < interval.last; ++i) {
    if (search.leadsOn(nodeAt(curve, i), 1.0) || search.leadsOn(nodeAt(curve, i + 1), -1.0))
      search.consider(refine(pose, nodeAt(curve, i), nodeAt(curve, i + 1), nearness));
  }
  return search.best();
}

SelfMotionNode largestNode(PoseCurve& pose, const SelfMotionCurve& curve, const SelfMotionInterval& interval,
                           const std::function<double(const Vector7&)>& value) {
  std::vector<SelfMotionNode> points;
  for (int i = interval.first; i <= interval.last; ++i) {
    points.push_back(nodeAt(curve, i));
    SelfMotionNode middle;
    if (i < interval.last && pose.between(points.back(), nodeAt(curve, i + 1), 0.5, middle)) points.push_back(middle);
  }
  std::vector<double> values;
  for (const SelfMotionNode& point : points) values.push_back(value(point.q));
  std::vector<std::size_t> peaks;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((i == 0 || values[i] >= values[i - 1]) && (i + 1 == points.size() || values[i] >= values[i + 1]))
      peaks.push_back(i);
  }
  std::sort(peaks.begin(), peaks.end(), [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
  peaks.resize(std::min<std::size_t>(peaks.size(), kBestCount));
  SelfMotionNode best = points[peaks.front()];
  double most = values[peaks.front()];
  for (std::size_t peak : peaks) {
    for (std::size_t i = peak == 0 ? 0 : peak - 1; i < std::min(peak + 1, points.size() - 1); ++i) {
      const SelfMotionNode node = refine(pose, points[i], points[i + 1], value);
      if (!(value(node.q) > most)) continue;
      most = value(node.q);
      best = node;
    }
  }
  return best;
}

}  // namespace screwline
