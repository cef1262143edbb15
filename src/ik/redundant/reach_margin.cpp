#include "reach_margin.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../closed_form/eliminant.h"
#include "screwline/model/structure.h"
#include "screwline/spatial/screw.h"

namespace screwline {
namespace {

constexpr double kLeastMargin = -1e-9;  // A maximum that rounding may have put below zero.
constexpr int kBisections = 60;
constexpr double kNone = -std::numeric_limits<double>::infinity();

using Dual = ReachMargin::Dual;

Dual operator+(const Dual& a, const Dual& b) {
  return {a.value + b.value, a.slope + b.slope};
}
Dual operator*(double factor, const Dual& a) {
  return {factor * a.value, factor * a.slope};
}
Dual operator-(const Dual& a, const Dual& b) {
  return a + -1.0 * b;
}
Dual abs(const Dual& a) {
  return a.value < 0.0 ? -1.0 * a : a;
}
Dual min(const Dual& a, const Dual& b) {
  return b.value < a.value ? b : a;
}
/// Of a vector and its rate.
Dual norm(const Vector3& r, const Vector3& rate) {
  const double value = r.norm();
  return {value, value > 0.0 ? r.dot(rate) / value : 0.0};
}
Vector3 across(const Vector3& axis, const Vector3& r) {
  return r - axis.dot(r) * axis;
}

/// Negative where three sides do not close to a triangle.
Dual triangleMargin(const Dual& a, const Dual& b, const Dual& c) {
  return min(a + b - c, min(a - b + c, b + c - a));
}

}  // namespace

std::optional<ReachMargin> ReachMargin::compile(const SerialChain& chain, int parameter) {
  if (parameter != 0 && parameter != kRedundantJoints - 1) return std::nullopt;
  ReachMargin margin;
  margin.first_ = parameter == 0;
  margin.home_ = chain.home();
  const Axis& given = chain.axes()[static_cast<std::size_t>(parameter)];
  margin.parameter_ = given.prismatic ? prismaticScrew(given.direction) : revoluteScrew(given.direction, given.point);
  if (!margin.first_) margin.parameter_ = adjoint(chain.home().inverse()) * margin.parameter_;
  const int offset = margin.first_ ? 1 : 0;
  const auto axis = [&](int i) { return chain.axes()[static_cast<std::size_t>(offset + i)]; };
  for (int place : {3, 0}) {
    for (const ConcurrentGroup& group : structureOf(chain).spherical) {
      if (group.first > offset + place || group.first + group.count < offset + place + 3) continue;
      margin.wrist_ = place == 3;
      margin.center_ = group.center;
      const std::array<Axis, 3> axes = margin.wrist_ ? std::array<Axis, 3>{axis(0), axis(1), axis(2)}
                                                     : std::array<Axis, 3>{axis(5), axis(4), axis(3)};
      if (axes[0].prismatic || axes[1].prismatic || axes[2].prismatic) continue;
      const std::optional<PositionProblem> problem = PositionProblem::compile(axes, chain.characteristicLength());
      if (!problem || problem->kind() == PositionKind::kSkewAxes) continue;
      if (problem->kind() == PositionKind::kArmPlane && problem->geometry().offset != 0.0) continue;
      margin.geometry_ = problem->geometry();
      return margin;
    }
  }
  return std::nullopt;
}

ReachMargin::Goal ReachMargin::goalAt(const Pose& target, double value) const {
  // The parameter joint carries the point, and `rest` brings it to the frame of the three others.
  const Pose rest = wrist_ ? (first_ ? Pose() : target) : (first_ ? home_ * target.inverse() : home_);
  const Vector3 start = wrist_ ? (first_ ? target * (home_.inverse() * center_) : home_.inverse() * center_)
                               : (first_ ? center_ : target.inverse() * center_);
  const double way = wrist_ ? -1.0 : 1.0;
  const Vector3 p = screwExponential(parameter_, way * value) * start;
  const Vector3 rate = parameter_.head<3>() + parameter_.tail<3>().cross(p);
  return {rest * p, way * (rest.R * rate)};
}

ReachMargin::Dual ReachMargin::at(const Pose& target, double value, double side) const {
  const PositionGeometry& g = geometry_;
  const Goal goal = goalAt(target, value);
  const Vector3 r = goal.point - g.axes[0].point;
  const Dual height = {g.axes[0].direction.dot(r), g.axes[0].direction.dot(goal.rate)};
  const Dual radius = norm(across(g.axes[0].direction, r), across(g.axes[0].direction, goal.rate));
  const CarriedPoint carried(g.axes[2], center_);
  const bool meeting = g.kind != PositionKind::kParallelAxes;
  const Form along = carried.along(g.axes[1].direction, g.axes[1].point);
  // What the third axis has to bring: a distance where the others meet, a height where they are parallel.
  const Form left = meeting ? carried.squareFrom(g.axes[1].point) : g.cosine * along;
  const Dual brought = meeting ? Dual{r.squaredNorm(), 2.0 * r.dot(goal.rate)} : height;
  const double amplitude = std::hypot(left.a, left.b);
  if (amplitude == 0.0) return {-1.0, 0.0};
  const Dual cosine = 1.0 / amplitude * (brought - Dual{left.k, 0.0});
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine.value * cosine.value));
  const double turn = std::atan2(left.b, left.a) + side * std::acos(std::clamp(cosine.value, -1.0, 1.0));
  const double turn_rate = sine > 0.0 ? -side * cosine.slope / sine : 0.0;
  const Vector3 u = carried.at(turn) - g.axes[1].point;
  const Vector3 u_rate = turn_rate * (carried.at(turn + 0.5 * kPi) - carried.center);
  const Dual along_second = {g.axes[1].direction.dot(u), g.axes[1].direction.dot(u_rate)};
  const Dual second =
      meeting ? radius - 1.0 / g.sine * abs(g.cosine * height - along_second)
              : triangleMargin({g.offset, 0.0},
                               norm(across(g.axes[1].direction, u), across(g.axes[1].direction, u_rate)), radius);
  const double unit = std::min(1.0, amplitude / (g.length * g.length));
  return min(unit * (Dual{1.0, 0.0} - abs(cosine)), 1.0 / g.length * second);
}

std::vector<double> ReachMargin::maxima(const Pose& target, double first, double last, int samples) const {
  std::vector<double> found;
  const double step = (last - first) / samples;
  std::vector<double> values(static_cast<std::size_t>(samples));
  const bool turns = !parameter_.tail<3>().isZero(0.0);  // The last value is next to the first one.
  for (double side : {1.0, -1.0}) {
    for (int i = 0; i < samples; ++i) values[static_cast<std::size_t>(i)] = at(target, first + i * step, side).value;
    for (int i = 0; i < samples; ++i) {
      const double here = values[static_cast<std::size_t>(i)];
      const double before = turns || i > 0 ? values[static_cast<std::size_t>((i + samples - 1) % samples)] : kNone;
      const double after = turns || i + 1 < samples ? values[static_cast<std::size_t>((i + 1) % samples)] : kNone;
      // Where the neighbours are well within reach, slices have seen it.
      if (here < before || here < after || (before > 0.0 && after > 0.0)) continue;
      // By the slope: values tell a smooth top to the root of rounding only.
      double low = first + (turns || i > 0 ? i - 1 : i) * step;
      double high = first + (turns || i + 1 < samples ? i + 1 : i) * step;
      for (int k = 0; k < kBisections; ++k) {
        const double middle = 0.5 * (low + high);
        (at(target, middle, side).slope > 0.0 ? low : high) = middle;
      }
      const double best = 0.5 * (low + high);
      if (at(target, best, side).value >= kLeastMargin) found.push_back(best);
    }
  }
  return found;
}

}  // namespace screwline
