#include "curve_tracer.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "local_conic.h"

namespace screwline {
namespace {

constexpr double kFirstStep = 0.02;
constexpr double kLongestStep = 0.5;
constexpr double kFinerStep = 0.1;      // Where those reach from one curve to another.
constexpr double kFineStep = 0.02;      // Where these do as well.
constexpr double kShortestStep = 1e-7;  // Below it, branches that do not join cannot be told from a crossing.
constexpr double kBlurredGain = 3e-8;   // Of a curve told twice within rounding: its orientation changes at random.
constexpr double kConicStep = 1e-5;     // Where steps or the gain are as small, the conic tells how the curve runs.
constexpr double kConicGain = 1e-6;
constexpr double kConicReach = 1e-6;
constexpr double kLongestBlur = 1e-3;
constexpr double kMostTurn = 0.25;        // [rad] of the tangent in one step.
constexpr double kMostCorrection = 0.15;  // Of a step.
constexpr double kLookAhead = 2.0;        // Steps that the gain must not fall to zero in, and rise again.
constexpr double kSingularStart = 1e-14;  // Gain below which a start has no tangent.
constexpr double kFarthest = 1000.0;      // [rad, lengths] An open curve ends there.

/// Where the next step is to begin: the node, walked in `way` of its oriented tangent.
class Walk {
 public:
  Walk(PoseCurve& pose, const SelfMotionNode& start, double way, double longest_step)
      : pose_(pose), start_(start), at_(start), longest_(longest_step), way_(way) {
    at_.tangent *= way;
    at_.arc = 0.0;
    start_ = at_;
    mark_ = at_;
  }

  /// True where it comes back to the start.
  bool run(std::vector<SelfMotionNode>& nodes, std::vector<Vector7>& crossings) {
    nodes.push_back(at_);
    while (nodes.size() < kMaxCurveNodes) {
      const SelfMotionNode from = at_;
      step(crossings);
      if (passes(start_, from)) {
        nodes.push_back(closing(nodes.back()));
        return true;
      }
      nodes.push_back(at_);
      // A curve comes round to its start. One that comes round to another place has been left for another curve;
      // Brent's way to see that is a mark that is put down after twice as many steps each time.
      if (isOver() || passes(mark_, from)) break;
      if (nodes.size() == next_mark_) {
        mark_ = at_;
        next_mark_ *= 2;
      }
    }
    return false;
  }

 private:
  void step(std::vector<Vector7>& crossings) {
    const bool sharp = (h_ < kConicStep || at_.gain < kConicGain) && !passed_;
    if (!passage_.empty() || (sharp && startPassage(crossings))) {
      at_ = passage_.front();
      passage_.pop_front();
      return;
    }
    const double least = std::clamp(PoseCurve::kErrorNoise / at_.gain, kShortestStep, kLongestBlur);
    for (;;) {
      SelfMotionNode next;
      h_ = std::max(h_, least);
      const bool shortest = h_ <= least;
      const Vector7 ahead = at_.q + h_ * at_.tangent + 0.5 * h_ * h_ * bend_;
      const double reach = (shortest ? 1.0 : kMostCorrection) * h_;
      const bool found = (at_.gain < kBlurredGain && pose_.correctAbove(kBlurredGain, ahead, reach, next)) ||
                         pose_.correct(ahead, reach, next);
      double along = found ? way_ * pose_.dot(next.tangent, at_.tangent) : 0.0;
      if (shortest && (!found || std::abs(along) < 0.5)) return jump(crossings);
      const bool blurred = found && std::max(at_.gain, next.gain) < kBlurredGain;
      if (blurred && along < 0.0) {
        way_ = -way_;
        along = -along;
      }
      if (shortest && along < 0.0) {
        way_ = -way_;
        along = -along;
        crossings.push_back(0.5 * (at_.q + next.q));
      }
      // The gain falls to zero towards a crossing and rises behind it: a step must not reach so far.
      const double slope = std::max(slope_, std::abs(next.gain - at_.gain) / h_);
      if (found && !shortest && !blurred && at_.gain + next.gain < kLookAhead * slope * h_) {
        h_ *= 0.5;
        continue;
      }
      if (along < std::cos(kMostTurn)) {
        if (!shortest) {
          h_ *= 0.5;
          continue;
        }
        // Beside a crossing the null vector is rounding's: the curve goes on as the step went.
        const Vector7 chord = next.q - at_.q;
        next.tangent = way_ / pose_.norm(chord) * chord;
        along = way_ * pose_.dot(next.tangent, at_.tangent);
      }
      return take(next, along);
    }
  }

  /// Past a place where the curve may bend more sharply than steps can follow.
  bool startPassage(std::vector<Vector7>& crossings) {
    const std::optional<Passage> passage = passCrossing(pose_, at_);
    SelfMotionNode behind;
    if (!passage || !pose_.correct(passage->nodes.back().q, kConicReach, behind)) return false;
    passage_.assign(passage->nodes.begin(), passage->nodes.end());
    way_ = std::copysign(1.0, pose_.dot(behind.tangent, passage_.back().tangent));
    bend_.setZero();
    passed_ = true;
    if (passage->crossing) crossings.push_back(*passage->crossing);
    return true;
  }

  void take(SelfMotionNode& next, double along) {
    const double turn = std::acos(std::min(1.0, along));
    next.tangent *= way_;
    next.arc = at_.arc + pose_.norm(next.q - at_.q) * (1.0 + turn * turn / 24.0);
    bend_ = (next.tangent - at_.tangent) / (next.arc - at_.arc);
    slope_ = std::abs(next.gain - at_.gain) / (next.arc - at_.arc);
    at_ = next;
    passed_ = false;
    const double growth = turn > 0.0 ? std::clamp(0.7 * kMostTurn / turn, 0.5, 2.0) : 2.0;
    h_ = std::min(growth * h_, longest_);
  }

  /// Straight over a singular point that no step comes near enough to.
  void jump(std::vector<Vector7>& crossings) {
    for (double h : {3e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
      if (h < h_) continue;
      SelfMotionNode next;
      if (!pose_.correct(at_.q + h * at_.tangent, 0.5 * h, next)) continue;
      const double along = pose_.dot(next.tangent, at_.tangent);
      if (std::abs(along) < 0.9) continue;
      crossings.push_back(0.5 * (at_.q + next.q));
      way_ = std::copysign(1.0, along);
      h_ = 1e-6;
      return take(next, std::abs(along));
    }
    crossings.push_back(at_.q);
    ended_ = true;
  }

  /// Whether the last step went past a place, the way of the walk there.
  bool passes(const SelfMotionNode& place, const SelfMotionNode& from) const {
    const double h = at_.arc - from.arc;
    const Vector7 before = pose_.difference(from.q, place.q);
    const double ahead = pose_.dot(before, from.tangent);
    if (from.arc == place.arc || pose_.norm(before) > 1.2 * h || ahead <= 0.0) return false;
    const Vector7 behind = pose_.difference(at_.q, place.q);
    if (pose_.dot(behind, at_.tangent) > 0.0) return false;
    const double off = (before - ahead * from.tangent).norm();
    return off <= 0.2 * h && pose_.dot(place.tangent, from.tangent) > 0.8;
  }

  SelfMotionNode closing(const SelfMotionNode& last) const {
    SelfMotionNode node = start_;
    const Vector7 step = pose_.difference(last.q, start_.q);
    node.q = last.q + step;
    node.arc = last.arc + pose_.norm(step);
    return node;
  }

  bool isOver() const {
    if (ended_) return true;
    for (int i = 0; i < kRedundantJoints; ++i) {
      if (!pose_.isRevolute(i) && std::abs(at_.q[i]) > kFarthestSlide * pose_.chain().characteristicLength())
        return true;
    }
    return at_.arc > kFarthest;
  }

  PoseCurve& pose_;
  SelfMotionNode start_;
  SelfMotionNode at_;
  SelfMotionNode mark_;
  std::deque<SelfMotionNode> passage_;  ///< Nodes ahead that are known.
  std::size_t next_mark_ = 64;
  double longest_;
  Vector7 bend_ = Vector7::Zero();
  double slope_ = 1.0;  ///< Of the gain along the last step; 1 is a usual arm's steepest.
  double h_ = kFirstStep;
  double way_;           ///< Of the walk against the oriented tangents: 1 or -1.
  bool passed_ = false;  ///< By a passage, since the last step: where conics repeat themselves, steps go on.
  bool ended_ = false;
};

constexpr int kMaxDepth = 40;     // Of splitting; not reached but where rounding makes tangents turn at random.
constexpr double kStill = 1e-11;  // Tangents below it are rounding: the joint does not move.

bool isStill(const SelfMotionNode& a, const SelfMotionNode& b, int joint) {
  const double rounding = std::max({kStill, a.noise, b.noise});
  return std::max(std::abs(a.tangent[joint]), std::abs(b.tangent[joint])) <= rounding;
}

/// The joint that turns back between two nodes, not at one of them to rounding; -1: none.
int turningJoint(const SelfMotionNode& a, const SelfMotionNode& b) {
  const double rounding = std::max({kStill, a.noise, b.noise});
  for (int i = 0; i < kRedundantJoints; ++i) {
    const double least = std::min(std::abs(a.tangent[i]), std::abs(b.tangent[i]));
    if (a.tangent[i] * b.tangent[i] < 0.0 && least > rounding) return i;
  }
  return -1;
}

/// Joints that could turn back twice between two nodes, as bits: tangents deviate from the line between them by an
/// eighth of the square of the turn where the curvature is even; the square is on the safe side.
unsigned suspectJoints(const SelfMotionNode& a, const SelfMotionNode& b, double turn) {
  unsigned suspects = 0;
  for (int i = 0; i < kRedundantJoints; ++i) {
    const double least = std::min(std::abs(a.tangent[i]), std::abs(b.tangent[i]));
    if (least < turn * turn && !isStill(a, b, i)) suspects |= 1U << i;
  }
  return suspects;
}

/// Whether the node half-way shows that the suspects do turn back, or leaves it open.
bool isUncertain(const SelfMotionNode& a, const SelfMotionNode& middle, const SelfMotionNode& b, unsigned suspects) {
  for (int i = 0; i < kRedundantJoints; ++i) {
    if ((suspects >> i & 1U) == 0U) continue;
    const double f = middle.tangent[i];
    const double ends = a.tangent[i] + b.tangent[i];
    double least = std::abs(f);
    for (double end : {a.tangent[i], b.tangent[i]}) {
      if (end != 0.0) least = std::min(least, std::abs(end));
    }
    if (f * ends <= 0.0 || 3.0 * std::abs(f - 0.5 * ends) > least) return true;
  }
  return false;
}

/// Nodes behind `a` up to `b` such that joint values are monotone between them.
void append(PoseCurve& pose, const SelfMotionNode& a, const SelfMotionNode& b, int depth,
            std::vector<SelfMotionNode>& nodes) {
  SelfMotionNode node;
  bool split = false;
  const int joint = turningJoint(a, b);
  if (joint >= 0) {
    split = nodeAtZero(
                pose, a, b, [joint](const SelfMotionNode& n) { return n.tangent[joint]; }, node) &&
            node.arc > a.arc && node.arc < b.arc;
    if (split) node.tangent[joint] = 0.0;
  } else if (b.arc - a.arc > kNodeResolution) {
    const unsigned suspects = suspectJoints(a, b, pose.norm(b.tangent - a.tangent));
    split = suspects != 0U && pose.between(a, b, 0.5, node) && isUncertain(a, node, b, suspects);
  }
  if (split && depth < kMaxDepth && nodes.size() < kMaxCurveNodes) {
    append(pose, a, node, depth + 1, nodes);
    append(pose, node, b, depth + 1, nodes);
  } else {
    nodes.push_back(b);
  }
}

}  // namespace

bool traceCurve(PoseCurve& pose, const Vector7& start, SelfMotionCurve& curve) {
  SelfMotionNode node;
  if (!pose.correct(start, 0.1, node) || node.gain <= kSingularStart) return false;
  if (traceSmallLoop(pose, node, curve)) return true;
  bool bounded = true;
  for (int i = 0; i < kRedundantJoints; ++i) bounded = bounded && pose.isRevolute(i);
  // A curve of turns alone comes round; where it does not, a step was too long.
  for (double longest : {kLongestStep, kFinerStep, kFineStep}) {
    curve = SelfMotionCurve();
    curve.closed = Walk(pose, node, 1.0, longest).run(curve.nodes, curve.crossings);
    if (curve.closed) return true;
    if (!bounded) break;
  }
  std::vector<SelfMotionNode> behind;
  Walk(pose, node, -1.0, kLongestStep).run(behind, curve.crossings);
  std::reverse(behind.begin(), behind.end());
  const double length = behind.front().arc;
  for (SelfMotionNode& n : behind) {
    n.arc = length - n.arc;
    n.tangent = -n.tangent;
  }
  for (SelfMotionNode& n : curve.nodes) n.arc += length;
  behind.pop_back();
  curve.nodes.insert(curve.nodes.begin(), behind.begin(), behind.end());
  return true;
}

void splitAtExtrema(PoseCurve& pose, SelfMotionCurve& curve) {
  std::vector<SelfMotionNode> nodes = {curve.nodes.front()};
  for (std::size_t i = 0; i + 1 < curve.nodes.size(); ++i) append(pose, curve.nodes[i], curve.nodes[i + 1], 0, nodes);
  curve.nodes = std::move(nodes);
}

}  // namespace screwline
