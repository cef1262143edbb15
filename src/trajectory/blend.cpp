#include "screwline/trajectory/blend.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"

namespace screwline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSameDirection = 1e-12;  // Of unit vectors: what differs by less goes straight on.

/// A line between two waypoints that differ.
struct Leg {
  Eigen::Index goal = 0;  ///< Column of the first waypoint at its end.
  VectorX direction;      ///< Unit length.
  double length = 0.0;
  double speed = kInfinity;         ///< Greatest along it that all joints allow.
  double acceleration = kInfinity;  ///< The same.
};

/// Where two legs meet. With x the square of the speed, the blend reaches x * rest / 2 to either side.
struct Corner {
  VectorX bend;         ///< Difference of the two directions.
  double rest = 0.0;    ///< [s^2/rad] Time of the blend per speed: the slowest joint's |bend| / acceleration.
  double bound = 0.0;   ///< Of the reach.
  double square = 0.0;  ///< x.
  bool halved = false;  ///< Half of a leg decides the bound.

  double reach() const { return 0.5 * square * rest; }
};

std::vector<Leg> legsThrough(const MatrixX& positions, const Limits& limits) {
  std::vector<Leg> legs;
  for (Eigen::Index k = 1; k < positions.cols(); ++k) {
    const VectorX delta = positions.col(k) - positions.col(k - 1);
    Leg leg;
    leg.length = delta.norm();
    if (leg.length == 0.0) continue;
    leg.goal = k;
    leg.direction = delta / leg.length;
    for (Eigen::Index j = 0; j < delta.size(); ++j) {
      const double share = std::abs(leg.direction[j]);
      if (share == 0.0) continue;
      if (!std::isfinite(limits.acceleration[j])) {
        throw InputError(AnswerCode::kInvalidGoal, indexed("acceleration_limits", static_cast<std::size_t>(j)) +
                                                       " is infinite, blend_radius needs a finite one");
      }
      leg.speed = std::min(leg.speed, limits.velocity[j] / share);
      leg.acceleration = std::min(leg.acceleration, limits.acceleration[j] / share);
    }
    legs.push_back(std::move(leg));
  }
  return legs;
}

/// [s] From rest to rest along all legs with a stop at each end.
double stopDuration(const std::vector<Leg>& legs) {
  double sum = 0.0;
  for (const Leg& leg : legs) {
    const double ramps = leg.speed * leg.speed / leg.acceleration;
    sum += ramps < leg.length ? leg.length / leg.speed + leg.speed / leg.acceleration
                              : 2.0 * std::sqrt(leg.length / leg.acceleration);
  }
  return sum;
}

/// A blend takes at least this of the whole duration: the instants of a shorter one would be rounded to more than the
/// limits tolerate. Gentler then, or slower where its reach is bounded.
constexpr double kShortestBlend = 1e-6;

void takeAtLeast(double time, Corner& corner) {
  const double speed = std::sqrt(corner.square);
  if (corner.rest == 0.0 || !std::isfinite(speed) || speed * corner.rest >= time) return;
  const double bounded = std::min(speed, 2.0 * corner.bound / time);
  corner.square = bounded * bounded;
  corner.rest = time / bounded;
}

Corner cornerBetween(const Leg& before, const Leg& after, const Limits& limits, double radius) {
  Corner corner;
  corner.bend = after.direction - before.direction;
  if (corner.bend.cwiseAbs().maxCoeff() > kSameDirection) {
    corner.rest = corner.bend.cwiseAbs().cwiseQuotient(limits.acceleration).maxCoeff();
  }
  const double half = 0.5 * std::min(before.length, after.length);
  corner.halved = half < radius;
  corner.bound = std::min(half, radius);
  const double speed = std::min(before.speed, after.speed);
  corner.square = std::min(speed * speed, corner.rest > 0.0 ? 2.0 * corner.bound / corner.rest : kInfinity);
  corner.halved = corner.halved && corner.square < speed * speed;
  return corner;
}

/// The greatest square at the corner from which, or to which, the speed can change on the leg to a neighbour's.
double reachable(const Corner& corner, const Corner& neighbour, const Leg& leg) {
  const double room = 2.0 * leg.acceleration * (leg.length - neighbour.reach());
  return (neighbour.square + room) / (1.0 + leg.acceleration * corner.rest);
}

/// Corners between the legs, with one of rest at either end.
std::vector<Corner> cornersOf(const std::vector<Leg>& legs, const Limits& limits, double radius) {
  std::vector<Corner> corners(legs.size() + 1);
  const double shortest = kShortestBlend * stopDuration(legs);
  for (std::size_t k = 1; k < legs.size(); ++k) {
    corners[k] = cornerBetween(legs[k - 1], legs[k], limits, radius);
    takeAtLeast(shortest, corners[k]);
  }
  for (std::size_t k = legs.size() - 1; k > 0; --k) {
    corners[k].square = std::min(corners[k].square, reachable(corners[k], corners[k + 1], legs[k]));
  }
  for (std::size_t k = 1; k < legs.size(); ++k) {
    corners[k].square = std::min(corners[k].square, reachable(corners[k], corners[k - 1], legs[k - 1]));
  }
  return corners;
}

/// Gathers pieces of degree 2 by what they take of a leg, or by their control points.
class Layer {
 public:
  /// From `from` to `to` of the way along the leg, the speed changing evenly.
  void line(const VectorX& origin, const VectorX& direction, double from, double to, double v0, double v1) {
    if (!(to > from)) return;
    const double h = 2.0 * (to - from) / (v0 + v1);
    append(origin + from * direction, (v0 * h) * direction, (to - from - v0 * h) * direction, h);
  }
  void parabola(const VectorX& waypoint, const Leg& before, const Corner& corner) {
    const double reach = corner.reach();
    if (!(reach > 0.0)) return;
    append(waypoint - reach * before.direction, 2.0 * reach * before.direction, reach * corner.bend,
           2.0 * reach / std::sqrt(corner.square));
  }

  double time() const { return breaks_.back(); }

  PiecewisePolynomial finish(int joints) const {
    PiecewisePolynomial motion(joints, 2, breaks_, 1);
    for (std::size_t k = 0; k < motion.segments(); ++k) {
      for (int j = 0; j < joints; ++j) {
        for (int power = 0; power < 3; ++power)
          motion.at(k, power, j) = rows_[3 * k + static_cast<std::size_t>(power)][j];
      }
    }
    return motion;
  }

 private:
  void append(const VectorX& c0, const VectorX& c1, const VectorX& c2, double h) {
    if (!(time() + h > time())) return;
    rows_.insert(rows_.end(), {c0, c1, c2});
    breaks_.push_back(time() + h);
  }

  std::vector<double> breaks_{0.0};
  std::vector<VectorX> rows_;
};

/// Faster, as fast as the leg allows, slower: between the speeds and reaches of its corners.
void layLeg(const Leg& leg, const VectorX& origin, const Corner& first, const Corner& last, Layer& layer) {
  const double from = first.reach();
  const double to = leg.length - last.reach();
  const double most = 0.5 * (2.0 * leg.acceleration * (to - from) + first.square + last.square);
  const double peak = std::max({std::min(leg.speed * leg.speed, most), first.square, last.square});
  const double up = from + (peak - first.square) / (2.0 * leg.acceleration);
  const double down = std::max(up, to - (peak - last.square) / (2.0 * leg.acceleration));
  const double v = std::sqrt(peak);
  layer.line(origin, leg.direction, from, std::min(up, to), std::sqrt(first.square), v);
  layer.line(origin, leg.direction, std::min(up, to), std::min(down, to), v, v);
  layer.line(origin, leg.direction, std::min(down, to), to, v, std::sqrt(last.square));
}

BlendedCorner described(const Corner& corner) {
  const double reach = corner.reach();
  return {reach, 0.25 * reach * corner.bend.norm(), std::sqrt(corner.square),
          corner.halved && reach >= 0.999 * corner.bound};
}

}  // namespace

BlendedLines blendLines(const MatrixX& positions, const Limits& limits, double radius) {
  const std::vector<Leg> legs = legsThrough(positions, limits);
  const std::vector<Corner> corners = cornersOf(legs, limits, radius);
  BlendedLines result;
  result.times = {0.0};
  result.corners.resize(static_cast<std::size_t>(positions.cols()));
  Layer layer;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    const VectorX origin = positions.col(legs[k].goal - 1);
    layLeg(legs[k], origin, corners[k], corners[k + 1], layer);
    const bool last = k + 1 == legs.size();
    const double begin = layer.time();
    if (!last) layer.parabola(positions.col(legs[k].goal), legs[k], corners[k + 1]);
    const double instant = 0.5 * (begin + layer.time());
    const Eigen::Index next = last ? positions.cols() : legs[k + 1].goal;
    result.times.resize(static_cast<std::size_t>(legs[k].goal), result.times.back());
    for (Eigen::Index i = legs[k].goal; i < next; ++i) {
      result.times.push_back(instant);
      if (!last) result.corners[static_cast<std::size_t>(i)] = described(corners[k + 1]);
    }
  }
  result.motion = layer.finish(static_cast<int>(positions.rows()));
  return result;
}

}  // namespace screwline
