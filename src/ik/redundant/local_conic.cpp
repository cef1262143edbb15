#include "local_conic.h"

#include <algorithm>
#include <cmath>

namespace screwline {
namespace {

using Eigen::Vector2d;

constexpr int kLoopNodes = 32;
constexpr double kMostGain = 1e-3;   // Of a node on a small loop.
constexpr double kFormNoise = 2e-9;  // Second derivatives over the chain's length: twenty times their rounding.
constexpr double kMostSize = 0.01;   // [rad] Half a loop's longer axis, and how far from its centre a hyperbola holds.
constexpr double kStrong = 1e-5;     // Of the largest gain: of the directions that carry the conic to its place.
constexpr double kMostError = 0.1;   // Of the error in a loop's centre; terms of third order are worth it.
constexpr double kSteady = 1e-7;     // Gain from which Newton's method may decide across the curve.
constexpr double kStep = 0.4;        // Of a hyperbola's parameter: at its vertex the curve turns by as much.
constexpr double kMostPassage = 30.0;
constexpr double kMostCorrection = 0.2;   // Of the distance from the centre.
constexpr double kNear = 1e-2;            // Gain where another curve may be near,
constexpr double kFarthestAcross = 0.01;  // and how far [rad] to its centre.

/// slopes . x + values . x^2 / 2 = 0 about its centre, x along `vectors` from a node.
struct Conic {
  explicit Conic(const PoseCurve::SecondOrder& form)
      : values(form.values),
        vectors(form.vectors),
        center(-form.slopes.cwiseQuotient(form.values)),
        square(form.values.dot(center.cwiseAbs2())) {}

  /// Of a place that terms of third order leave where the conic has it.
  double mostError() const { return std::max(kMostError * 0.5 * std::abs(square), PoseCurve::kErrorNoise); }

  Vector2d values;
  Eigen::Matrix<double, kRedundantJoints, 2> vectors;
  Vector2d center;
  double square;  ///< values . y^2 along it, y from the centre.
};

std::optional<Conic> conicAt(PoseCurve& pose, const Vector7& q, bool ellipse) {
  const PoseCurve::SecondOrder form = pose.secondOrder(q);
  if (!form.is_known || std::abs(form.values[0]) < kFormNoise) return std::nullopt;
  if ((form.values[0] * form.values[1] > 0.0) != ellipse) return std::nullopt;
  return Conic(form);
}

/// Brings a place of the conic onto the curve; its tangent is `way` as well as the Jacobian tells it.
bool settle(PoseCurve& pose, const Vector7& q, const Vector7& way, double most_error, SelfMotionNode& node) {
  if (!pose.correctAbove(kStrong, q, kMostSize, node) || pose.errorAt(node.q) > most_error) return false;
  const double along = pose.dot(node.tangent, way) / pose.norm(way);
  if (std::abs(along) < 0.9) {
    node.tangent = way / pose.norm(way);
  } else if (along < 0.0) {
    node.tangent = -node.tangent;
  }
  return true;
}

/// A hyperbola in the coordinates of its asymptotes, in which s t is constant, and the nodes on the way along it.
class Hyperbola {
 public:
  Hyperbola(PoseCurve& pose, const SelfMotionNode& at, const Conic& conic)
      : pose_(pose), start_(at), conic_(conic), before_(at) {
    const Vector2d root = conic.values.cwiseAbs().cwiseSqrt();
    to_asymptotes_ << root[0], root[1], root[0], -root[1];
    from_asymptotes_ = to_asymptotes_.inverse();
  }

  Vector2d place() const { return to_asymptotes_ * -conic_.center; }
  Vector2d way() const {
    const auto along = [&](int k) { return pose_.dot(start_.tangent, conic_.vectors.col(k)); };
    return to_asymptotes_ * Vector2d(along(0), along(1));
  }

  /// A node at a place further on, where the coordinates change at a rate.
  bool add(const Vector2d& place, const Vector2d& rate, std::vector<SelfMotionNode>& nodes) {
    const Vector2d y = from_asymptotes_ * place;
    SelfMotionNode node;
    const Vector7 q = start_.q + conic_.vectors * (conic_.center + y);
    if (!settle(pose_, q, conic_.vectors * (from_asymptotes_ * rate), conic_.mostError(), node)) return false;
    if (conic_.values.cwiseProduct(y).norm() > kSteady) {
      const Vector7 tangent = node.tangent;
      if (!pose_.correct(node.q, kMostCorrection * y.norm(), node)) return false;
      if (pose_.dot(node.tangent, tangent) < 0.0) node.tangent = -node.tangent;
    }
    node.arc = before_.arc + pose_.norm(node.q - before_.q);
    nodes.push_back(node);
    before_ = node;
    return true;
  }

 private:
  PoseCurve& pose_;
  const SelfMotionNode& start_;
  const Conic& conic_;
  SelfMotionNode before_;
  Eigen::Matrix2d to_asymptotes_;
  Eigen::Matrix2d from_asymptotes_;
};

}  // namespace

bool traceSmallLoop(PoseCurve& pose, const SelfMotionNode& start, SelfMotionCurve& curve) {
  if (start.gain > kMostGain) return false;
  const std::optional<Conic> conic = conicAt(pose, start.q, true);
  if (!conic) return false;
  const Vector2d half = (conic->square * conic->values.cwiseInverse()).cwiseSqrt();
  if (!(half[0] > 0.0 && half[1] > 0.0) || half[0] > kMostSize) return false;
  curve = SelfMotionCurve();
  for (int i = 0; i < kLoopNodes; ++i) {
    const double angle = kTwoPi * i / kLoopNodes;
    const Vector2d place = conic->center + half.cwiseProduct(Vector2d(std::cos(angle), std::sin(angle)));
    const Vector2d way = half.cwiseProduct(Vector2d(-std::sin(angle), std::cos(angle)));
    SelfMotionNode node;
    if (!settle(pose, start.q + conic->vectors * place, conic->vectors * way, conic->mostError(), node)) return false;
    if (i > 0) node.arc = curve.nodes.back().arc + pose.norm(node.q - curve.nodes.back().q);
    curve.nodes.push_back(node);
  }
  SelfMotionNode last = curve.nodes.front();
  last.arc = curve.nodes.back().arc + pose.norm(last.q - curve.nodes.back().q);
  curve.nodes.push_back(last);
  curve.closed = true;
  return true;
}

std::optional<Passage> passCrossing(PoseCurve& pose, const SelfMotionNode& at) {
  const std::optional<Conic> conic = conicAt(pose, at.q, false);
  if (!conic || conic->center.norm() > kMostSize) return std::nullopt;
  Hyperbola hyperbola(pose, at, *conic);
  const Vector2d place = hyperbola.place();
  const int along = std::abs(place[0]) > std::abs(place[1]) ? 0 : 1;
  const int aside = 1 - along;
  if (place[along] * hyperbola.way()[along] >= 0.0) return std::nullopt;
  Passage passage;
  if (0.5 * std::abs(conic->square) <= PoseCurve::kErrorNoise) {
    passage.crossing = at.q + conic->vectors * conic->center;
    Vector2d behind = Vector2d::Zero();
    behind[along] = -place[along];
    if (!hyperbola.add(behind, behind, passage.nodes)) return std::nullopt;
    return passage;
  }
  const double end = std::log(std::abs(place[along] / place[aside]));
  if (!(end < kMostPassage)) return std::nullopt;
  const int steps = static_cast<int>(std::ceil(end / kStep));
  for (int i = 1; i <= steps; ++i) {
    const double factor = std::exp(end * i / steps);
    Vector2d next = place;
    next[along] /= factor;
    next[aside] *= factor;
    Vector2d rate = next;
    rate[along] = -rate[along];
    if (!hyperbola.add(next, rate, passage.nodes)) return std::nullopt;
  }
  return passage;
}

std::vector<Vector7> nearCrossings(PoseCurve& pose, const SelfMotionCurve& curve) {
  std::vector<Vector7> centers;
  const std::size_t count = curve.nodes.size() - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const SelfMotionNode& node = curve.nodes[i];
    if (i == 0 && !curve.closed) continue;
    const double before = curve.nodes[i == 0 ? count - 1 : i - 1].gain;
    if (node.gain > kNear || node.gain > before || node.gain >= curve.nodes[i + 1].gain) continue;
    const std::optional<Conic> conic = conicAt(pose, node.q, false);
    if (conic && conic->center.norm() <= kFarthestAcross) centers.push_back(node.q + conic->vectors * conic->center);
  }
  return centers;
}

}  // namespace screwline
