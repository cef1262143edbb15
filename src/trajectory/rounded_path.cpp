#include "screwline/trajectory/rounded_path.h"

#include <numeric>
#include <utility>

#include "joint_legs.h"

namespace screwline {
namespace {

/// Of the whole way: what is shorter is passed so quickly that its instants would be rounded to more than the limits
/// tolerate.
constexpr double kShortest = 1e-6;
constexpr double kNothing = 1e-12;
constexpr int kDegree = 4;

/// Gathers the pieces of the path. Lengths are taken from the breakpoints, so that directions meet exactly.
class Layer {
 public:
  void line(const VectorX& from, const VectorX& direction, double end) {
    append({from, (end - last()) * direction}, end);
  }

  void blend(const VectorX& waypoint, const VectorX& before, const VectorX& after, double end) {
    const double reach = 0.5 * (end - last());
    const Polynomial rise = cornerRise(reach);
    std::vector<VectorX> powers{waypoint - reach * before, 2.0 * reach * before};
    for (std::size_t power = 2; power <= kDegree; ++power) powers.push_back(rise.c[power] * (after - before));
    append(std::move(powers), end);
  }

  JointPath finish(int joints) const {
    PiecewisePolynomial curve(joints, kDegree, breaks_, 2);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      for (std::size_t power = 0; power < rows_[k].size(); ++power) {
        for (int j = 0; j < joints; ++j) curve.at(k, static_cast<int>(power), j) = rows_[k][power][j];
      }
    }
    return JointPath(std::move(curve));
  }

 private:
  double last() const { return breaks_.back(); }
  void append(std::vector<VectorX> powers, double end) {
    rows_.push_back(std::move(powers));
    breaks_.push_back(end);
  }

  std::vector<double> breaks_{0.0};
  std::vector<std::vector<VectorX>> rows_;
};

double lengthOf(const std::vector<JointLeg>& legs) {
  return std::accumulate(legs.begin(), legs.end(), 0.0,
                         [](double sum, const JointLeg& leg) { return sum + leg.length; });
}

/// No blend, and no line between two of them, is so short that it could not be timed.
void keepTimeable(const std::vector<JointLeg>& legs, std::vector<double>& reaches) {
  const double whole = lengthOf(legs);
  const double least = kShortest * whole;
  for (double& reach : reaches) reach = reach < least ? 0.0 : reach;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    const double rest = legs[k].length - reaches[k] - reaches[k + 1];
    if (rest >= least || rest <= kNothing * whole) continue;
    double& wider = reaches[k] > reaches[k + 1] ? reaches[k] : reaches[k + 1];
    wider = wider < 2.0 * least ? 0.0 : wider - least;
  }
}

Corner cornerBetween(const JointLeg& before, const JointLeg& after, double reach, double radius) {
  const Bend bend = bendBetween(before.direction, after.direction);
  Corner corner = describeCorner(reach, kCornerMiddle * reach, before.direction, after.direction);
  corner.stops = reach == 0.0;
  corner.shortened = bend == Bend::kCorner && reach < radius;
  return corner;
}

}  // namespace

std::vector<JointLeg> jointLegs(const MatrixX& positions) {
  std::vector<JointLeg> legs;
  for (Eigen::Index k = 1; k < positions.cols(); ++k) {
    const VectorX delta = positions.col(k) - positions.col(k - 1);
    const double length = delta.norm();
    if (length > 0.0) legs.push_back({k - 1, k, delta / length, length});
  }
  return legs;
}

std::vector<double> reachesOf(const std::vector<JointLeg>& legs, double radius) {
  std::vector<double> lengths;
  std::vector<double> most(legs.size() + 1, 0.0);
  for (std::size_t k = 0; k < legs.size(); ++k) {
    lengths.push_back(legs[k].length);
    if (k > 0 && bendBetween(legs[k - 1].direction, legs[k].direction) == Bend::kCorner) most[k] = radius;
  }
  std::vector<double> reaches = fairReaches(lengths, std::move(most));
  keepTimeable(legs, reaches);
  return reaches;
}

RoundedLines roundedLines(const MatrixX& positions, double radius) {
  const std::vector<JointLeg> legs = jointLegs(positions);
  const std::vector<double> reaches = reachesOf(legs, radius);
  RoundedLines result;
  result.corners.resize(static_cast<std::size_t>(positions.cols()));
  Layer layer;
  double u = 0.0;           // Of the leg's goal.
  double line_start = 0.0;  // Of u: the line goes on through waypoints where it does not bend.
  VectorX from = positions.col(0);
  for (std::size_t k = 0; k < legs.size(); ++k) {
    const JointLeg& leg = legs[k];
    result.waypoints.resize(static_cast<std::size_t>(leg.goal), u);
    u += leg.length;
    const bool last = k + 1 == legs.size();
    if (!last && bendBetween(leg.direction, legs[k + 1].direction) == Bend::kNone) continue;
    const double reach = reaches[k + 1];
    if (u - reach > line_start + kNothing * u) layer.line(from, leg.direction, u - reach);
    if (last) break;
    const JointLeg& next = legs[k + 1];
    if (reach > 0.0) layer.blend(positions.col(leg.goal), leg.direction, next.direction, u + reach);
    line_start = u + reach;
    from = positions.col(next.start) + reach * next.direction;
    const Corner corner = cornerBetween(leg, next, reach, radius);
    for (Eigen::Index i = leg.goal; i <= next.start; ++i) result.corners[static_cast<std::size_t>(i)] = corner;
  }
  result.waypoints.resize(static_cast<std::size_t>(positions.cols()), u);
  result.path = layer.finish(static_cast<int>(positions.rows()));
  return result;
}

}  // namespace screwline
