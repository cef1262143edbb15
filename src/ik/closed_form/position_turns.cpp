#include <algorithm>
#include <cmath>

#include "eliminant.h"
#include "position_kernels.h"

namespace screwline {
namespace {

constexpr double kNearAxis = 1e-2;  ///< Distance to one axis over that to the other.

constexpr double kBesideAxis = 1e-5;

/// Where the second axis puts the point, across it, and how many signs of the root there are.
struct Placement {
  double x = 0.0;
  double y = 0.0;
  int signs = 0;  ///< 0: cannot be reached; 1; 2: both signs of the root.
  bool root_along_x = false;
};

/// Sides of the triangle (distance of the axes, length turned by axis 2, radius about axis 1) to the apex, by Heron's
/// formula.
Placement triangle(double offset, double turned, double radius, double length) {
  const double stretched = offset + turned - radius;
  const double folded_in = radius - offset + turned;
  const double folded_out = radius + offset - turned;
  Placement place;
  place.y = (radius * radius - offset * offset - turned * turned) / (2.0 * offset);
  place.root_along_x = true;
  const double slack = std::min({stretched, folded_in, folded_out});
  if (slack < -kReachTolerance * length) return place;
  place.signs = 1;
  if (slack <= kDoubleRootTolerance * length) return place;
  place.signs = 2;
  place.x = std::sqrt(stretched * (offset + turned + radius) * folded_in * folded_out) / (2.0 * offset);
  return place;
}

Placement placementOf(const PositionGeometry& g, const TurnGoal& goal, double along, double turned) {
  if (g.kind == PositionKind::kParallelAxes) return triangle(g.offset, turned, goal.radius, g.length);
  Placement place;
  place.x = (goal.height - g.cosine * along) / g.sine;
  if (g.kind == PositionKind::kSkewAxes) {
    place.y = (goal.height * goal.height + goal.radius * goal.radius - g.offset * g.offset - along * along -
               turned * turned) /
              (2.0 * g.offset);
    place.signs = 1;
    return place;
  }
  // Axes that meet: what is across both, from the distance to that axis which the point is nearer to: it keeps its
  // digits.
  if (turned < kNearAxis * goal.radius) {
    // Out of reach by so little that rounding may have done it is measured as far from the axis.
    const double square = (turned - std::abs(place.x)) * (turned + std::abs(place.x));
    place.y = square > kDoubleRootTolerance * turned * g.length     ? std::sqrt(square)
              : square >= -kReachTolerance * goal.radius * g.length ? 0.0
                                                                    : -1.0;
  } else {
    const double tilt = std::abs(goal.height * g.cosine - along) / g.sine;
    place.y = squareRootOrNone((goal.radius - tilt) * (goal.radius + tilt), (goal.radius + tilt) * g.length);
  }
  place.signs = place.y < 0.0 ? 0 : (place.y > 0.0 ? 2 : 1);
  return place;
}

void addTurns(const PositionGeometry& g, const Vector3& carried, const TurnGoal& goal, const Preferred& preferred,
              const PositionSolution& partial, PositionSolutions& out) {
  const Vector3 u = carried - g.axes[1].point;
  const double along = g.axes[1].direction.dot(u);
  const double ux = g.ex.dot(u);
  const double uy = g.ey.dot(u);
  const double turned = std::sqrt(ux * ux + uy * uy);
  const Placement place = placementOf(g, goal, along, turned);
  const bool free = turned <= kOnAxis * g.length;
  const int signs = free ? std::min(place.signs, 1) : place.signs;
  for (int i = 0; i < signs; ++i) {
    PositionSolution solution = partial;
    solution.sign[1] = signs == 2 ? (i == 0 ? 1 : -1) : 0;
    const double flip = i == 0 ? 1.0 : -1.0;
    const double x = place.root_along_x ? flip * place.x : place.x;
    const double y = place.root_along_x || g.kind == PositionKind::kSkewAxes ? place.y : flip * place.y;
    if (free) {
      setFree(1, preferred, solution);
    } else {
      solution.turn[1] = turnBetween(ux, uy, x, y);
    }
    finishFirstTurn(g, g.axes[1].point + along * g.axes[1].direction + x * g.ex + y * g.ey, goal, preferred, solution);
    out.add(solution);
  }
}

/// A double root of axes that meet, with the point next to axis 2: how far, the root tells no better than to the square
/// root of rounding, the height above it does. Both displacements that bring the point as far as that; false where it
/// is as it should be.
bool addBesideAxis(const PositionGeometry& g, const CarriedPoint& carried, const TurnGoal& goal,
                   const Preferred& preferred, const PositionSolution& partial, PositionSolutions& out) {
  if (g.kind != PositionKind::kMeetingAxes || partial.sign[0] != 0 || partial.free[2]) return false;
  const Vector3 u = carried.at(partial.q[2], partial.turn[2]) - g.axes[1].point;
  const double along = g.axes[1].direction.dot(u);
  const double turned = std::hypot(g.ex.dot(u), g.ey.dot(u));
  const double least = std::abs(goal.height - g.cosine * along) / g.sine;
  const double arm = carried.e.norm();  // 1 of a slide.
  if (turned >= least || least > kBesideAxis * std::min(goal.radius, carried.slide ? g.length : arm)) return false;
  const double way = std::sqrt((least - turned) * (least + turned)) / arm;
  for (double side : {way, -way}) {
    PositionSolution solution = partial;
    if (carried.slide) {
      solution.q[2] += side;
    } else {
      solution.turn[2] = solution.turn[2] * turnBy(side);
    }
    addTurns(g, carried.at(solution.q[2], solution.turn[2]), goal, preferred, solution, out);
  }
  return true;
}

/// A slide carried by two axes that meet: |center + q e - meeting point| = reach, as (q - foot)^2 = height^2 + radius^2
/// - nearest^2. The difference of the last two is taken as a product, and is zero where rounding cannot tell: a slide
/// drawn in to nothing is exact.
RealRoots slideRoots(const PositionGeometry& g, const CarriedPoint& carried, const TurnGoal& goal) {
  const Vector3 r = carried.center - g.axes[1].point;
  const double foot = -r.dot(carried.e);
  const double nearest = (r + foot * carried.e).norm();
  const double gap = goal.radius - nearest;
  const double radial = std::abs(gap) <= kDoubleRootTolerance * g.length ? 0.0 : gap * (goal.radius + nearest);
  const double square = goal.height * goal.height + radial;
  RealRoots roots;
  if (square < -kReachTolerance * goal.scale) return roots;
  const double root = std::sqrt(std::max(square, 0.0));
  if (root <= kOnAxis * g.length) {
    roots.add(foot, 0);
    return roots;
  }
  roots.add(foot - root, -1);
  roots.add(foot + root, 1);
  return roots;
}

}  // namespace

/// R R x.
void solveTurns(const PositionGeometry& g, const Vector3& start, const Vector3& target, const Preferred& preferred,
                PositionSolutions& out) {
  const TurnGoal goal(g, target);
  const CarriedPoint carried(g.axes[2], start);
  const Form along = carried.along(g.axes[1].direction, g.axes[1].point);
  const Form square = carried.squareFrom(g.axes[1].point);
  const double reach = goal.height * goal.height + goal.radius * goal.radius;
  RealRoots roots;
  if (g.kind == PositionKind::kMeetingAxes) {
    roots = carried.slide ? slideRoots(g, carried, goal) : solveForm(square + -reach, false, goal.scale);
  } else if (g.kind == PositionKind::kParallelAxes) {
    roots = solveForm(g.cosine * along + -goal.height, carried.slide, std::sqrt(goal.scale));
  } else {
    const Form x = (1.0 / g.sine) * ((-g.cosine * along) + goal.height);
    const Form y = (1.0 / (2.0 * g.offset)) * (-1.0 * square + (reach - g.offset * g.offset));
    SquareForm rest = squared(along, carried.slide);
    for (double& c : rest) c = -c;
    rest[0] += square.k;
    rest[1] += square.a;
    rest[2] += square.b;
    roots = solveSquares(squared(x, carried.slide), squared(y, carried.slide), rest, goal.scale, carried.slide);
  }
  forEachRoot(roots, g, 2, preferred, [&](const PositionSolution& solution) {
    if (addBesideAxis(g, carried, goal, preferred, solution, out)) return;
    addTurns(g, carried.at(solution.q[2], solution.turn[2]), goal, preferred, solution, out);
  });
}

}  // namespace screwline
