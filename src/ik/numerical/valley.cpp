#include "valley.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "screwline/spatial/weak_directions.h"

namespace screwline {
namespace {

// Lengths in scaled joint units.
constexpr double kFirstStep = 0.05;
constexpr double kLongestStep = 0.2;
constexpr double kShortestStep = 1e-3;
constexpr double kLongestCorrection = 0.5;  ///< Further the curve is not looked for.
constexpr double kSettled = 1e-8;
constexpr double kTurn = 0.8;  ///< Cosine of what the curve and the lost direction may turn by in a step.
constexpr double kLongestWay = 25.0;
constexpr double kBeside = 0.12;  ///< Nearer to a curve: on it.
constexpr double kBracket = 1e-5;
constexpr double kTouching = 1e-9;   ///< Depth, in units of the chain's length, that may be zero, ...
constexpr double kRounding = 1e-12;  ///< ... and one that is, where it is nowhere more.
constexpr int kMostSteps = 400;
constexpr double kHigh = 0.3;  ///< Of the bound: what breaks off there may.
constexpr int kMaxCorrections = 12;
constexpr int kFewCorrections = 6;
constexpr int kMaxBisections = 40;
constexpr int kMaxTouches = 30;
constexpr int kMaxSlides = 20;

}  // namespace

Valley::Valley(TaskResidual& residual, const JointBox& box, double bound)
    : residual_(residual), box_(box), bound_(bound), rounding_(kRounding * lengthUnit(residual.chain())) {}

bool Valley::settle(Node& node, const Node* reference) {
  point_.q = node.q;
  const auto n = node.q.size();
  for (node.corrections = 0; node.corrections < kMaxCorrections; ++node.corrections) {
    residual_.evaluate(point_);
    SmallMatrix J = point_.J;
    for (Eigen::Index i = 0; i < n; ++i) J.col(i) *= box_.unit(static_cast<int>(i));
    const WeakDirections weak = weakDirectionsOf(J, J.norm());
    node.lost = weak.U.rightCols<1>();
    node.tangent = weak.V.rightCols<1>();
    node.depth = node.lost.dot(point_.residual);
    // Regular with the direction that is about to be lost, the residual's part along which is left alone.
    J += node.lost * node.tangent.transpose();
    const JointVector step = J.partialPivLu().solve(point_.residual - node.depth * node.lost);
    const double length = step.norm();
    if (!(length < kLongestCorrection)) return false;
    if (length < kSettled) break;
    for (Eigen::Index i = 0; i < n; ++i) point_.q[i] += step[i] * box_.unit(static_cast<int>(i));
  }
  if (node.corrections == kMaxCorrections) return false;
  node.q = point_.q;
  if (reference == nullptr) return true;
  // Both directions are known up to their sign, which is carried on along the curve.
  const double turn = node.tangent.dot(reference->tangent);
  const double lost_turn = node.lost.dot(reference->lost);
  if (turn < 0.0) node.tangent = -node.tangent;
  if (lost_turn < 0.0) {
    node.lost = -node.lost;
    node.depth = -node.depth;
  }
  return std::abs(turn) > kTurn && std::abs(lost_turn) > kTurn;
}

JointVector Valley::difference(const JointVector& a, const JointVector& b) const {
  JointVector d = a - b;
  for (int i = 0; i < box_.size(); ++i) {
    if (box_.isPeriodic(i)) d[i] = std::remainder(d[i], kTwoPi);
    d[i] /= box_.unit(i);
  }
  return d;
}

bool Valley::stepFrom(const Node& from, double length, Node& to) {
  to = from;
  for (int i = 0; i < box_.size(); ++i) to.q[i] += length * from.tangent[i] * box_.unit(i);
  return settle(to, &from) && difference(to.q, from.q).norm() < 2.0 * std::abs(length);
}

bool Valley::between(const Node& a, const Node& b, double fraction, Node& middle) {
  middle = a;
  middle.q += fraction * (b.q - a.q);
  return settle(middle, &a);
}

void Valley::bracket(Node a, Node b) {
  double weight_a = 1.0;  // Illinois rule: the end that stays counts half.
  double weight_b = 1.0;
  for (int k = 0; k < kMaxBisections && (b.q - a.q).norm() > kBracket; ++k) {
    const double da = weight_a * a.depth;
    const double db = weight_b * b.depth;
    Node middle;
    if (!between(a, b, std::min(std::max(da / (da - db), 0.01), 0.99), middle)) break;
    const bool replaces_a = (middle.depth > 0.0) == (a.depth > 0.0);
    weight_a = replaces_a ? 1.0 : 0.5 * weight_a;
    weight_b = replaces_a ? 0.5 * weight_b : 1.0;
    (replaces_a ? a : b) = middle;
  }
  roots_.push_back(std::abs(a.depth) < std::abs(b.depth) ? a.q : b.q);
}

void Valley::touch(Node a, Node b, Node c) {
  // Least |g| of one sign in [a, c], b the least known: golden sections.
  const double touching = kTouching * lengthUnit(residual_.chain());
  for (int k = 0; k < kMaxTouches && (c.q - a.q).norm() > kBracket; ++k) {
    const bool first_half = (b.q - a.q).norm() > (c.q - b.q).norm();
    Node middle;
    if (!between(b, first_half ? a : c, 0.382, middle)) return;
    if ((middle.depth > 0.0) != (b.depth > 0.0)) {
      bracket(first_half ? a : b, middle);
      bracket(middle, first_half ? b : c);
      return;
    }
    const bool less = std::abs(middle.depth) < std::abs(b.depth);
    if (first_half) {
      (less ? c : a) = less ? b : middle;
    } else {
      (less ? a : c) = less ? b : middle;
    }
    if (less) b = middle;
    // A parabola that stays clear of zero by far is left alone.
    if (k == 2 && std::abs(b.depth) > 0.5 * std::min(std::abs(a.depth), std::abs(c.depth))) {
      const double drop = std::max(std::abs(a.depth), std::abs(c.depth)) - std::abs(b.depth);
      if (drop < 0.5 * std::abs(b.depth)) return;
    }
  }
  if (std::abs(b.depth) <= touching) roots_.push_back(b.q);
}

bool Valley::hasPassed(const Node& origin, const Node& node, double direction) const {
  const JointVector back = difference(origin.q, node.q);
  return back.norm() < 2.0 * kLongestStep && direction * back.dot(node.tangent) <= 0.0;
}

bool Valley::follow(const Node& origin, double direction) {
  Node before = origin;
  Node node = origin;
  double step = kFirstStep;
  double way = 0.0;
  bool has_before = false;
  for (int tries = 0; way < kLongestWay; ++tries) {
    if (tries == kMostSteps) return false;
    Node next;
    if (!stepFrom(node, direction * step, next)) {
      step *= 0.5;
      if (step < kShortestStep) return std::abs(node.depth) > kHigh * bound_;
      continue;
    }
    way += step;
    path_.push_back(next.q);
    deepest_ = std::max(deepest_, std::abs(next.depth));
    const bool crosses = (next.depth > 0.0) != (node.depth > 0.0);
    if (crosses && deepest_ > rounding_) bracket(node, next);
    const bool same_sign = !crosses && (node.depth > 0.0) == (before.depth > 0.0);
    const double least = std::min(std::abs(before.depth), std::abs(next.depth));
    if (has_before && same_sign && std::abs(node.depth) <= least && deepest_ > rounding_) touch(before, node, next);
    if (std::abs(next.depth) > bound_) return true;
    if (way > 4.0 * kLongestStep && hasPassed(origin, next, direction)) return true;
    if (next.corrections <= kFewCorrections) step = std::min(kLongestStep, 1.4 * step);
    before = node;
    node = next;
    has_before = true;
  }
  return true;
}

bool Valley::trace(const ConstVectorRef& start) {
  continuum_ = false;
  last_path_ = path_.size();
  Node origin;
  origin.q = start;
  if (!settle(origin, nullptr)) return false;
  foot_ = origin.q;
  origin.tangent.cwiseAbs().maxCoeff(&free_joint_);
  deepest_ = std::abs(origin.depth);
  path_.push_back(origin.q);
  if (std::abs(origin.depth) > bound_) return true;
  const std::size_t known = roots_.size();
  // A least depth at the origin itself is seen by neither side: one step back first.
  Node behind;
  bool whole = stepFrom(origin, -kShortestStep, behind) && follow(behind, 1.0);
  whole = follow(origin, -1.0) && whole;
  continuum_ = whole && deepest_ < rounding_;
  if (continuum_) roots_.resize(known);
  return whole;
}

JointVector Valley::memberNear(const ConstVectorRef& preferred) {
  JointVector nearest = foot_;
  for (std::size_t i = last_path_; i < path_.size(); ++i) {
    if (difference(path_[i], preferred).norm() < difference(nearest, preferred).norm()) nearest = path_[i];
  }
  Node node;
  node.q = nearest;
  if (!settle(node, nullptr)) return nearest;
  node.tangent.cwiseAbs().maxCoeff(&free_joint_);
  for (int k = 0; k < kMaxSlides; ++k) {
    const double way = difference(preferred, node.q)[free_joint_] / node.tangent[free_joint_];
    Node next;
    if (std::abs(way) < kSettled || !stepFrom(node, std::min(std::max(way, -kLongestStep), kLongestStep), next)) break;
    node = next;
  }
  return node.q;
}

bool Valley::isNearAny(const JointBox& box, const std::vector<JointVector>& path, const ConstVectorRef& q) {
  return std::any_of(path.begin(), path.end(),
                     [&](const JointVector& point) { return box.distance(point, q) < kBeside; });
}

}  // namespace screwline
