#include "screwline/trajectory/blend.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "joint_legs.h"
#include "screwline/exception.h"
#include "screwline/trajectory/format.h"

namespace screwline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoStep = 1e-12;  // Of the time: less is what rounding leaves of a line that corners share.

/// A line between two waypoints that differ, with what all joints allow along it.
struct Leg : JointLeg {
  double speed = kInfinity;
  double acceleration = kInfinity;
};

/// Where two legs meet. With x the square of the speed, the blend reaches x * rest / 2 to either side.
struct Passage {
  VectorX bend;         ///< Difference of the two directions.
  double rest = 0.0;    ///< [s^2/rad] Time of the blend per speed: the slowest joint's |bend| / acceleration.
  double bound = 0.0;   ///< Of the reach.
  double square = 0.0;  ///< x.

  double reach() const { return 0.5 * square * rest; }
};

Leg limited(JointLeg line, const Limits& limits) {
  Leg leg{std::move(line)};
  for (Eigen::Index j = 0; j < leg.direction.size(); ++j) {
    const double share = std::abs(leg.direction[j]);
    if (share == 0.0) continue;
    if (!std::isfinite(limits.acceleration[j])) {
      throw InputError(AnswerCode::kInvalidGoal, indexed("acceleration_limits", static_cast<std::size_t>(j)) +
                                                     " is infinite, blend_radius needs a finite one");
    }
    leg.speed = std::min(leg.speed, limits.velocity[j] / share);
    leg.acceleration = std::min(leg.acceleration, limits.acceleration[j] / share);
  }
  return leg;
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

void takeAtLeast(double time, Passage& corner) {
  const double speed = std::sqrt(corner.square);
  if (corner.rest == 0.0 || corner.bound == 0.0 || !std::isfinite(speed) || speed * corner.rest >= time) return;
  const double bounded = std::min(speed, 2.0 * corner.bound / time);
  corner.square = bounded * bounded;
  corner.rest = time / bounded;
}

Passage passageBetween(const Leg& before, const Leg& after, const Limits& limits, double bound) {
  Passage passage;
  passage.bend = after.direction - before.direction;
  if (bendBetween(before.direction, after.direction) != Bend::kNone)
    passage.rest = passage.bend.cwiseAbs().cwiseQuotient(limits.acceleration).maxCoeff();
  passage.bound = bound;
  const double speed = std::min(before.speed, after.speed);
  passage.square = std::min(speed * speed, passage.rest > 0.0 ? 2.0 * bound / passage.rest : kInfinity);
  return passage;
}

/// The greatest square at the corner from which, or to which, the speed can change on the leg to a neighbour's.
double reachable(const Passage& corner, const Passage& neighbour, const Leg& leg) {
  const double room = 2.0 * leg.acceleration * (leg.length - neighbour.reach());
  return (neighbour.square + room) / (1.0 + leg.acceleration * corner.rest);
}

/// Passages between the legs, with one of rest at either end.
std::vector<Passage> passagesOf(const std::vector<Leg>& legs, const std::vector<double>& reaches,
                                const Limits& limits) {
  std::vector<Passage> passages(legs.size() + 1);
  const double shortest = kShortestBlend * stopDuration(legs);
  for (std::size_t k = 1; k < legs.size(); ++k) {
    passages[k] = passageBetween(legs[k - 1], legs[k], limits, reaches[k]);
    takeAtLeast(shortest, passages[k]);
  }
  for (std::size_t k = legs.size() - 1; k > 0; --k) {
    passages[k].square = std::min(passages[k].square, reachable(passages[k], passages[k + 1], legs[k]));
  }
  for (std::size_t k = 1; k < legs.size(); ++k) {
    passages[k].square = std::min(passages[k].square, reachable(passages[k], passages[k - 1], legs[k - 1]));
  }
  return passages;
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
  void parabola(const VectorX& waypoint, const Leg& before, const Passage& corner) {
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
    if (!(h > kNoStep * time())) return;
    rows_.insert(rows_.end(), {c0, c1, c2});
    breaks_.push_back(time() + h);
  }

  std::vector<double> breaks_{0.0};
  std::vector<VectorX> rows_;
};

/// Faster, as fast as the leg allows, slower: between the speeds and reaches of its corners.
void layLeg(const Leg& leg, const VectorX& origin, const Passage& first, const Passage& last, Layer& layer) {
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

Corner described(const Leg& before, const Leg& after, const Passage& passage, double radius) {
  const double reach = passage.reach();
  Corner corner = describeCorner(reach, 0.25 * reach, before.direction, after.direction);
  corner.stops = passage.square == 0.0;
  corner.shortened = !corner.stops && passage.bound < radius && reach >= 0.999 * passage.bound;
  return corner;
}

}  // namespace

BlendedLines blendLines(const MatrixX& positions, const Limits& limits, double radius) {
  std::vector<JointLeg> lines = jointLegs(positions);
  const std::vector<double> reaches = reachesOf(lines, radius);
  std::vector<Leg> legs;
  for (JointLeg& line : lines) legs.push_back(limited(std::move(line), limits));
  const std::vector<Passage> passages = passagesOf(legs, reaches, limits);
  BlendedLines result;
  result.times = {0.0};
  result.corners.resize(static_cast<std::size_t>(positions.cols()));
  Layer layer;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    layLeg(legs[k], positions.col(legs[k].start), passages[k], passages[k + 1], layer);
    const bool last = k + 1 == legs.size();
    const double begin = layer.time();
    if (!last) layer.parabola(positions.col(legs[k].goal), legs[k], passages[k + 1]);
    const double instant = 0.5 * (begin + layer.time());
    const Eigen::Index next = last ? positions.cols() : legs[k + 1].goal;
    result.times.resize(static_cast<std::size_t>(legs[k].goal), result.times.back());
    for (Eigen::Index i = legs[k].goal; i < next; ++i) {
      result.times.push_back(instant);
      if (!last) result.corners[static_cast<std::size_t>(i)] = described(legs[k], legs[k + 1], passages[k + 1], radius);
    }
  }
  result.motion = layer.finish(static_cast<int>(positions.rows()));
  return result;
}

}  // namespace screwline
