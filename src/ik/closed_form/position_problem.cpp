#include "screwline/ik/closed_form/position_problem.h"

#include <algorithm>
#include <cmath>

#include "eliminant.h"
#include "screwline/model/structure.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

/// Distances within this share of the chain's length are zero: a point this near an axis is on it, and the axis is
/// free.
constexpr double kOnAxis = 1e-14;

using Preferred = std::array<double, 3>;

/// The goal as the first axis (a turn) sees it.
struct TurnGoal {
  TurnGoal(const PositionGeometry& g, const Vector3& goal) {
    const Vector3 r = goal - g.axes[0].point;
    height = g.axes[0].direction.dot(r);
    x = g.x1.dot(r);
    y = g.y1.dot(r);
    radius = std::hypot(x, y);
    scale = g.length * g.length + height * height + radius * radius;
  }
  double height = 0.0;
  double radius = 0.0;
  double x = 0.0;
  double y = 0.0;
  double scale = 0.0;  ///< [m^2] of the terms of the eliminant.
};

/// RealRoots of an eliminant; where every value is one, the preferred value alone, marked free.
template <typename Use>
void forEachRoot(const RealRoots& roots, double preferred, Use&& use) {
  if (roots.always) {
    use(RealRoot{preferred, 0}, 0, true);
    return;
  }
  std::array<int, 3> rank{};
  for (const RealRoot& root : roots) use(root, rank[static_cast<std::size_t>(root.slope + 1)]++, false);
}

/// Turns axis 1 so that it carries `second` to the goal; anything does where the goal is on the axis.
void finishFirstTurn(const PositionGeometry& g, const Vector3& second, const TurnGoal& goal, double preferred,
                     PositionSolution& solution) {
  if (goal.radius <= kOnAxis * g.length) {
    solution.free[0] = true;
    solution.q[0] = preferred;
    return;
  }
  const Vector3 r = second - g.axes[0].point;
  solution.q[0] = std::atan2(goal.y, goal.x) - std::atan2(g.y1.dot(r), g.x1.dot(r));
}

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
  if (slack < -kDoubleRootTolerance * length) return place;
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
  // Axes that meet: what is across both, from the radius about axis 1, which keeps its digits near the axis.
  const double tilt = std::abs(goal.height * g.cosine - along) / g.sine;
  place.y = squareRootOrNone((goal.radius - tilt) * (goal.radius + tilt), (goal.radius + tilt) * g.length);
  place.signs = place.y < 0.0 ? 0 : (place.y > 0.0 ? 2 : 1);
  return place;
}

void addTurns(const PositionGeometry& g, const Vector3& carried, const TurnGoal& goal, const Preferred& preferred,
              const PositionSolution& partial, PositionSolutions& out) {
  const Vector3 u = carried - g.axes[1].point;
  const double along = g.axes[1].direction.dot(u);
  const double ux = g.ex.dot(u);
  const double uy = g.ey.dot(u);
  const double turned = std::hypot(ux, uy);
  const Placement place = placementOf(g, goal, along, turned);
  const bool free = turned <= kOnAxis * g.length;
  const int signs = free ? std::min(place.signs, 1) : place.signs;
  for (int i = 0; i < signs; ++i) {
    PositionSolution solution = partial;
    solution.sign[1] = signs == 2 ? (i == 0 ? 1 : -1) : 0;
    const double flip = i == 0 ? 1.0 : -1.0;
    const double x = place.root_along_x ? flip * place.x : place.x;
    const double y = place.root_along_x || g.kind == PositionKind::kSkewAxes ? place.y : flip * place.y;
    solution.free[1] = free;
    solution.q[1] = free ? preferred[1] : std::atan2(y, x) - std::atan2(uy, ux);
    finishFirstTurn(g, g.axes[1].point + along * g.axes[1].direction + x * g.ex + y * g.ey, goal, preferred[0],
                    solution);
    out.add(solution);
  }
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
  if (square < -kDoubleRootTolerance * goal.scale) return roots;
  const double root = std::sqrt(std::max(square, 0.0));
  if (root <= kOnAxis * g.length) {
    roots.add(foot, 0);
    return roots;
  }
  roots.add(foot - root, -1);
  roots.add(foot + root, 1);
  return roots;
}

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
  forEachRoot(roots, preferred[2], [&](const RealRoot& root, int rank, bool free) {
    PositionSolution solution;
    solution.q[2] = root.value;
    solution.free[2] = free;
    solution.sign[0] = root.slope;
    solution.rank = rank;
    addTurns(g, carried.at(root.value), goal, preferred, solution, out);
  });
}

/// R P x, the slide not across axis 1: it makes up the height, and what it moves across axis 1 goes with the height.
void solveTurnAndSlide(const PositionGeometry& g, const Vector3& start, const Vector3& target,
                       const Preferred& preferred, PositionSolutions& out) {
  const TurnGoal goal(g, target);
  const CarriedPoint carried(g.axes[2], start);
  const Vector3& origin = g.axes[0].point;
  const Vector3 slant = g.axes[1].direction / g.cosine;
  const Vector3 x = g.x1 - g.x1.dot(slant) * g.axes[0].direction;
  const Vector3 y = g.y1 - g.y1.dot(slant) * g.axes[0].direction;
  const Form fx = carried.along(x, origin) + goal.height * g.x1.dot(slant);
  const Form fy = carried.along(y, origin) + goal.height * g.y1.dot(slant);
  const SquareForm radius = {goal.radius * goal.radius, 0.0, 0.0, 0.0, 0.0};
  const RealRoots roots =
      solveSquares(squared(fx, carried.slide), squared(fy, carried.slide), radius, goal.scale, carried.slide);
  forEachRoot(roots, preferred[2], [&](const RealRoot& root, int rank, bool free) {
    PositionSolution solution;
    const Vector3 point = carried.at(root.value);
    solution.q[2] = root.value;
    solution.free[2] = free;
    solution.sign[0] = root.slope;
    solution.rank = rank;
    solution.q[1] = (goal.height - g.axes[0].direction.dot(point - origin)) / g.cosine;
    finishFirstTurn(g, point + solution.q[1] * g.axes[1].direction, goal, preferred[0], solution);
    out.add(solution);
  });
}

/// R P x, the slide across axis 1: the third axis makes the height, the slide then the radius.
void solveSlideAcross(const PositionGeometry& g, const Vector3& start, const Vector3& target,
                      const Preferred& preferred, PositionSolutions& out) {
  const TurnGoal goal(g, target);
  const CarriedPoint carried(g.axes[2], start);
  const Vector3& origin = g.axes[0].point;
  const Vector3& slide = g.axes[1].direction;
  const Vector3 across = g.axes[0].direction.cross(slide);
  const RealRoots roots =
      solveForm(carried.along(g.axes[0].direction, origin) + -goal.height, carried.slide, std::sqrt(goal.scale));
  forEachRoot(roots, preferred[2], [&](const RealRoot& root, int rank, bool free) {
    const Vector3 r = carried.at(root.value) - origin;
    const double aside = std::abs(r.dot(across));
    const double reach =
        squareRootOrNone((goal.radius - aside) * (goal.radius + aside), (goal.radius + aside) * g.length);
    if (reach < 0.0) return;
    for (int sign : {1, -1}) {
      if (reach == 0.0 && sign < 0) break;
      PositionSolution solution;
      solution.q[2] = root.value;
      solution.free[2] = free;
      solution.sign = {root.slope, reach == 0.0 ? 0 : sign};
      solution.rank = rank;
      solution.q[1] = sign * reach - r.dot(slide);
      finishFirstTurn(g, origin + r + solution.q[1] * slide, goal, preferred[0], solution);
      out.add(solution);
    }
  });
}

/// P R P: height along the turning axis ties the slides together; the distance from it is a quadratic in one of them.
void solveSlideTurnSlide(const PositionGeometry& g, const Vector3& start, const Vector3& goal,
                         const Preferred& preferred, PositionSolutions& out) {
  const Vector3& axis = g.axes[1].direction;
  const Vector3 from = start - g.axes[1].point;
  const Vector3 to = goal - g.axes[1].point;
  const double k1 = axis.dot(g.axes[0].direction);
  const double k3 = axis.dot(g.axes[2].direction);
  const bool solve_first =
      std::abs(k3) >= std::abs(k1);  // The unknown of the quadratic; the other follows from the height.
  const double rise = axis.dot(to - from);
  // from + q3 h3 and to - q1 h1 as base + q * rate, both in the unknown.
  const Vector3 from_base = solve_first ? Vector3(from + rise / k3 * g.axes[2].direction) : from;
  const Vector3 from_rate = solve_first ? Vector3(-k1 / k3 * g.axes[2].direction) : g.axes[2].direction;
  const Vector3 to_base = solve_first ? to : Vector3(to - rise / k1 * g.axes[0].direction);
  const Vector3 to_rate = solve_first ? Vector3(-g.axes[0].direction) : Vector3(k3 / k1 * g.axes[0].direction);
  const double c[3] = {from_base.squaredNorm() - to_base.squaredNorm(),
                       2.0 * (from_base.dot(from_rate) - to_base.dot(to_rate)),
                       from_rate.squaredNorm() - to_rate.squaredNorm()};
  const RealRoots roots = solvePolynomial(c, 2, g.length * g.length + to.squaredNorm());
  forEachRoot(roots, preferred[solve_first ? 0 : 2], [&](const RealRoot& root, int rank, bool free) {
    PositionSolution solution;
    const double other = solve_first ? (rise - k1 * root.value) / k3 : (rise - k3 * root.value) / k1;
    solution.q[0] = solve_first ? root.value : other;
    solution.q[2] = solve_first ? other : root.value;
    solution.free[solve_first ? 0 : 2] = free;
    solution.sign[0] = root.slope;
    solution.rank = rank;
    const Vector3 a = from_base + root.value * from_rate;
    const Vector3 b = to_base + root.value * to_rate;
    const double radius = (a - axis * axis.dot(a)).norm();
    solution.free[1] = radius <= kOnAxis * g.length;
    solution.q[1] =
        solution.free[1] ? preferred[1] : std::atan2(g.ey.dot(b), g.ex.dot(b)) - std::atan2(g.ey.dot(a), g.ex.dot(a));
    out.add(solution);
  });
}

void solveSlides(const PositionGeometry& g, const Vector3& start, const Vector3& goal, PositionSolutions& out) {
  Matrix3 directions;
  for (int i = 0; i < 3; ++i) directions.col(i) = g.axes[static_cast<std::size_t>(i)].direction;
  const Vector3 q = directions.inverse() * (goal - start);
  PositionSolution solution;
  solution.q = {q[0], q[1], q[2]};
  out.add(solution);
}

/// Moves the points of axes 1 and 2 to their common normal, and fills the frame across axis 2.
void alignTurns(PositionGeometry& g, const AxisRelation& relation) {
  Axis& first = g.axes[0];
  Axis& second = g.axes[1];
  g.sine = first.direction.cross(second.direction).norm();
  g.cosine = first.direction.dot(second.direction);
  if (relation.parallel) {
    second.point += second.direction * second.direction.dot(first.point - second.point);
    g.cosine = std::copysign(1.0, g.cosine);
    g.sine = 0.0;
    g.ey = (second.point - first.point).normalized();
    g.ex = g.ey.cross(second.direction);
    g.offset = (second.point - first.point).norm();
    return;
  }
  const Vector3 r = second.point - first.point;
  const double along_first = first.direction.dot(r);
  const double along_second = second.direction.dot(r);
  const double denominator = g.sine * g.sine;
  first.point += (along_first - g.cosine * along_second) / denominator * first.direction;
  second.point += (g.cosine * along_first - along_second) / denominator * second.direction;
  g.ex = (first.direction - g.cosine * second.direction) / g.sine;
  g.ey = second.direction.cross(g.ex);
  g.offset = g.ey.dot(second.point - first.point);
  if (relation.intersecting) g.offset = 0.0;
}

/// False where two turns about one line, or slides in one plane, leave positions that nothing reaches.
bool classify(PositionGeometry& g) {
  const AxisRelation relation = relate(g.axes[0], g.axes[1], g.length);
  if (!g.axes[0].prismatic && !g.axes[1].prismatic) {
    if (relation.coincident) return false;
    alignTurns(g, relation);
    g.kind = relation.parallel ? PositionKind::kParallelAxes
                               : (relation.intersecting ? PositionKind::kMeetingAxes : PositionKind::kSkewAxes);
  } else if (!g.axes[0].prismatic) {
    g.cosine = g.axes[0].direction.dot(g.axes[1].direction);
    g.kind = relation.orthogonal ? PositionKind::kSlideAcross : PositionKind::kTurnAndSlide;
  } else if (!g.axes[1].prismatic) {
    g.kind = PositionKind::kSlideTurnSlide;
    g.ex = anyPerpendicular(g.axes[1].direction);
    g.ey = g.axes[1].direction.cross(g.ex);
    return !relation.orthogonal || !relate(g.axes[1], g.axes[2], g.length).orthogonal;
  } else {
    const Vector3 normal = g.axes[0].direction.cross(g.axes[1].direction);
    return std::abs(normal.dot(g.axes[2].direction)) > kStructureAngleTolerance;
  }
  g.x1 = anyPerpendicular(g.axes[0].direction);
  g.y1 = g.axes[0].direction.cross(g.x1);
  return true;
}

}  // namespace

std::optional<PositionProblem> PositionProblem::compile(const std::array<Axis, 3>& axes, double length) {
  PositionProblem problem;
  PositionGeometry& g = problem.geometry_;
  g.length = length;
  g.axes = axes;
  g.reversed = axes[0].prismatic && !axes[2].prismatic;
  if (g.reversed) std::swap(g.axes[0], g.axes[2]);
  if (!classify(g)) return std::nullopt;
  return problem;
}

void PositionProblem::solve(const Vector3& start, const Vector3& goal, const Preferred& preferred,
                            PositionSolutions& solutions) const {
  const PositionGeometry& g = geometry_;
  solutions.count = 0;
  const Vector3& from = g.reversed ? goal : start;
  const Vector3& to = g.reversed ? start : goal;
  const Preferred wished = g.reversed ? Preferred{-preferred[2], -preferred[1], -preferred[0]} : preferred;
  switch (g.kind) {
    case PositionKind::kMeetingAxes:
    case PositionKind::kParallelAxes:
    case PositionKind::kSkewAxes:
      solveTurns(g, from, to, wished, solutions);
      break;
    case PositionKind::kTurnAndSlide:
      solveTurnAndSlide(g, from, to, wished, solutions);
      break;
    case PositionKind::kSlideAcross:
      solveSlideAcross(g, from, to, wished, solutions);
      break;
    case PositionKind::kSlideTurnSlide:
      solveSlideTurnSlide(g, from, to, wished, solutions);
      break;
    case PositionKind::kThreeSlides:
      solveSlides(g, from, to, solutions);
      break;
  }
  if (!g.reversed) return;
  for (int i = 0; i < solutions.count; ++i) {
    PositionSolution& solution = solutions.solutions[static_cast<std::size_t>(i)];
    solution.q = {-solution.q[2], -solution.q[1], -solution.q[0]};
    std::swap(solution.free[0], solution.free[2]);
  }
}

}  // namespace screwline
