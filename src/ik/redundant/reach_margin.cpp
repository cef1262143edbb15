#include "reach_margin.h"

#include <algorithm>
#include <cmath>

#include "../closed_form/eliminant.h"
#include "screwline/model/structure.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr double kLeastMargin = -1e-9;  // A maximum that rounding may have put below zero.

/// Negative where three sides do not close to a triangle.
double triangleMargin(double a, double b, double c) {
  return std::min({a + b - c, a - b + c, -a + b + c});
}

}  // namespace

std::optional<ReachMargin> ReachMargin::compile(const SerialChain& chain, int parameter) {
  if (parameter != 0 && parameter != kRedundantJoints - 1) return std::nullopt;
  ReachMargin margin;
  margin.first_ = parameter == 0;
  margin.home_ = chain.home();
  margin.parameter_ = chain.axes()[static_cast<std::size_t>(parameter)];
  if (!margin.first_) {
    const Pose X_TB = chain.home().inverse();
    margin.parameter_.direction = X_TB.R * margin.parameter_.direction;
    margin.parameter_.point = X_TB * margin.parameter_.point;
  }
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

Vector3 ReachMargin::goalAt(const Pose& target, double value) const {
  Pose X{Matrix3::Identity(), -value * parameter_.direction};
  if (!parameter_.prismatic) {
    X.R = rotationAbout(parameter_.direction, -value);
    X.p = parameter_.point - X.R * parameter_.point;
  }
  const Pose rest = first_ ? X * target : target * X;
  return wrist_ ? rest * (home_.inverse() * center_) : home_ * (rest.inverse() * center_);
}

double ReachMargin::at(const Pose& target, double value, double side) const {
  const PositionGeometry& g = geometry_;
  const Vector3 r = goalAt(target, value) - g.axes[0].point;
  const double height = g.axes[0].direction.dot(r);
  const double radius = std::hypot(g.x1.dot(r), g.y1.dot(r));
  const CarriedPoint carried(g.axes[2], center_);
  const bool meeting = g.kind != PositionKind::kParallelAxes;
  const Form along = carried.along(g.axes[1].direction, g.axes[1].point);
  const Form left =
      meeting ? carried.squareFrom(g.axes[1].point) + -(height * height + radius * radius) : g.cosine * along + -height;
  const double amplitude = std::hypot(left.a, left.b);
  if (amplitude == 0.0) return -1.0;
  const double cosine = -left.k / amplitude;
  const double turn = std::atan2(left.b, left.a) + side * std::acos(std::clamp(cosine, -1.0, 1.0));
  const Vector3 u = carried.at(turn) - g.axes[1].point;
  const double along_second = g.axes[1].direction.dot(u);
  const double second = meeting ? radius - std::abs(height * g.cosine - along_second) / g.sine
                                : triangleMargin(g.offset, (u - along_second * g.axes[1].direction).norm(), radius);
  return std::min((1.0 - std::abs(cosine)) * std::min(1.0, amplitude / (g.length * g.length)), second / g.length);
}

std::vector<double> ReachMargin::maxima(const Pose& target, double first, double last, int samples) const {
  std::vector<double> found;
  const double step = (last - first) / samples;
  std::vector<double> values(static_cast<std::size_t>(samples));
  for (double side : {1.0, -1.0}) {
    for (int i = 0; i < samples; ++i) values[static_cast<std::size_t>(i)] = at(target, first + i * step, side);
    for (int i = 0; i < samples; ++i) {
      const double here = values[static_cast<std::size_t>(i)];
      const double before = values[static_cast<std::size_t>((i + samples - 1) % samples)];
      const double after = values[static_cast<std::size_t>((i + 1) % samples)];
      // Where the neighbours are well within reach, slices have seen it.
      if (here < before || here < after || (before > 0.0 && after > 0.0)) continue;
      constexpr double kGolden = 0.6180339887498949;
      double low = first + (i - 1) * step;
      double high = first + (i + 1) * step;
      while (high - low > 1e-9 * (1.0 + std::abs(high))) {
        const double x = high - kGolden * (high - low);
        const double y = low + kGolden * (high - low);
        if (at(target, x, side) >= at(target, y, side))
          high = y;
        else
          low = x;
      }
      const double best = 0.5 * (low + high);
      if (at(target, best, side) >= kLeastMargin) found.push_back(best);
    }
  }
  return found;
}

}  // namespace screwline
