#include "small_loop.h"

#include <algorithm>
#include <cmath>

namespace screwline {
namespace {

constexpr int kNodes = 32;
constexpr double kMostGain = 1e-3;   // Of a node on such a loop.
constexpr double kLeastForm = 1e-4;  // Second derivatives over the chain's length.
constexpr double kMostSize = 0.01;   // [rad] Half the longer axis.
constexpr double kStrong = 1e-5;     // Of the largest gain: of the directions that carry the ellipse to its place.
constexpr double kMostError = 0.1;   // Of the error in the ellipse's centre; terms of third order are worth it.
constexpr double kRounding = 1e-14;  // Of errors.

}  // namespace

bool traceSmallLoop(PoseCurve& pose, const SelfMotionNode& start, SelfMotionCurve& curve) {
  if (start.gain > kMostGain) return false;
  const PoseCurve::SecondOrder form = pose.secondOrder(start.q);
  if (!form.is_known || std::abs(form.values[0]) < kLeastForm || form.values[0] * form.values[1] < 0.0) return false;
  // slopes . x + values . x^2 / 2 = 0 about its centre.
  const Eigen::Vector2d center = -form.slopes.cwiseQuotient(form.values);
  const double square = form.values.dot(center.cwiseAbs2());
  const Eigen::Vector2d half = (square * form.values.cwiseInverse()).cwiseSqrt();
  if (!(half[0] > 0.0 && half[1] > 0.0) || half[0] > kMostSize) return false;
  const double most_error = std::max(kMostError * 0.5 * std::abs(square), kRounding);
  curve = SelfMotionCurve();
  for (int i = 0; i < kNodes; ++i) {
    const double angle = kTwoPi * i / kNodes;
    const Eigen::Vector2d place = center + half.cwiseProduct(Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    const Eigen::Vector2d way = half.cwiseProduct(Eigen::Vector2d(-std::sin(angle), std::cos(angle)));
    SelfMotionNode node;
    const Vector7 q = start.q + form.vectors * place;
    if (!pose.correctAbove(kStrong, q, kMostSize, node) || pose.errorAt(node.q) > most_error) return false;
    if (pose.dot(node.tangent, form.vectors * way) < 0.0) node.tangent = -node.tangent;
    if (i > 0) node.arc = curve.nodes.back().arc + pose.norm(node.q - curve.nodes.back().q);
    curve.nodes.push_back(node);
  }
  SelfMotionNode last = curve.nodes.front();
  last.arc = curve.nodes.back().arc + pose.norm(last.q - curve.nodes.back().q);
  curve.nodes.push_back(last);
  curve.closed = true;
  return true;
}

}  // namespace screwline
