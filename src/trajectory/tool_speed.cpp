#include "screwline/trajectory/tool_speed.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "screwline/kinematics/jacobian.h"
#include "screwline/trajectory/enclosure.h"

namespace screwline {
namespace {

constexpr double kExcess = 1e-4;
constexpr int kMostHalvings = 6;
constexpr double kAtRest = 1e-6;  ///< Of the reach times the joints' largest rates.

/// The way from an axis to the tip is never longer than link by link: between the nearest points of neighbours, on the
/// axes, which turns do not change, and by what prismatic joints add.
double reachOf(const SerialChain& chain, const JointPath& path) {
  const auto& axes = chain.axes();
  Vector3 point = chain.home().p;
  double way = 0.0;
  double reach = 0.0;
  for (auto axis = axes.rbegin(); axis != axes.rend(); ++axis) {
    if (axis->prismatic) {
      way += std::abs(axis->multiplier) * path.curve().extrema(axis->source).position.peak();
      reach = std::max(reach, 1.0);
      continue;
    }
    const Vector3 nearest = axis->point + axis->direction * axis->direction.dot(point - axis->point);
    way += (point - nearest).norm();
    point = nearest;
    reach = std::max(reach, way);
  }
  return reach;
}

}  // namespace

ToolSpeed::ToolSpeed(const SerialChain& chain, const JointPath& path)
    : chain_(chain), path_(path), reach_(reachOf(chain, path)), weights_(VectorX::Zero(chain.size())) {
  for (const Axis& axis : chain.axes()) weights_[axis.source] += std::abs(axis.multiplier);
  double rates = 0.0;
  for (int j = 0; j < path.joints(); ++j) rates += weights_[j] * path.curve().extrema(j).velocity;
  least_ = kAtRest * reach_ * rates;
}

double ToolSpeed::at(double u) const {
  const Eigen::Index n = path_.joints();
  VectorX q(n), first(n), second(n), third(n);
  path_.at(u, q.data(), first.data(), second.data(), third.data());
  Matrix6X jacobian(6, n);
  geometricJacobian(chain_, q, jacobian);
  return (jacobian.topRows<3>() * first).norm();
}

/// By the chain rule: the joints' derivatives, each at its largest on the interval, times the reach.
double ToolSpeed::thirdDerivative(double from, double to) const {
  const PiecewisePolynomial& curve = path_.curve();
  const std::size_t k = path_.segmentAt(0.5 * (from + to));
  const double r = path_.inverseLength(k);
  const double low = (from - curve.breaks[k]) * r;
  const double high = (to - curve.breaks[k]) * r;
  std::array<double, 4> sums{};
  for (int j = 0; j < path_.joints(); ++j) {
    Polynomial derivative = curve.piece(k, j);
    double rate = weights_[j];
    for (std::size_t order = 1; order <= 3; ++order) {
      derivative = derivative.derivative();
      rate *= r;
      sums[order] += rate * enclosure(derivative, low, high).peak();
    }
  }
  return reach_ * (sums[3] + 3.0 * sums[2] * sums[1] + sums[1] * sums[1] * sums[1]);
}

/// Between two places dp/du is off the line between its values by at most an eighth of the squared distance times its
/// second derivative.
double ToolSpeed::onInterval(double from, double at_from, double to, double at_to, int halvings) const {
  const double excess = 0.125 * (to - from) * (to - from) * thirdDerivative(from, to);
  const double ends = std::max(at_from, at_to);
  if (excess <= kExcess * std::max(ends, least_) || halvings == 0) return ends + excess;
  const double middle = 0.5 * (from + to);
  const double at_middle = at(middle);
  return std::max(onInterval(from, at_from, middle, at_middle, halvings - 1),
                  onInterval(middle, at_middle, to, at_to, halvings - 1));
}

double ToolSpeed::greatest(double from, double to) const {
  const auto& breaks = path_.breaks();
  double largest = 0.0;
  for (std::size_t k = path_.segmentAt(from); k + 1 < breaks.size() && (breaks[k] < to || from >= to); ++k) {
    const double low = std::max(from, breaks[k]);
    const double high = std::min(to, breaks[k + 1]);
    if (high < low) break;
    largest = std::max(largest, onInterval(low, at(low), high, at(high), kMostHalvings));
    if (from >= to) break;
  }
  return largest;
}

RateBound toolSpeedBound(const SerialChain& chain, const JointPath& path, double speed) {
  return [tool = ToolSpeed(chain, path), speed](double from, double to) { return speed / tool.greatest(from, to); };
}

}  // namespace screwline
