#include <cmath>

#include <Eigen/LU>

#include "eliminant.h"
#include "position_kernels.h"

namespace screwline {

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
  forEachRoot(roots, g, 2, preferred, [&](PositionSolution& solution) {
    const Vector3 point = carried.at(solution.q[2], solution.turn[2]);
    solution.q[1] = (goal.height - g.axes[0].direction.dot(point - origin)) / g.cosine;
    finishFirstTurn(g, point + solution.q[1] * g.axes[1].direction, goal, preferred, solution);
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
  forEachRoot(roots, g, 2, preferred, [&](const PositionSolution& partial) {
    const Vector3 r = carried.at(partial.q[2], partial.turn[2]) - origin;
    const double aside = std::abs(r.dot(across));
    const double reach =
        squareRootOrNone((goal.radius - aside) * (goal.radius + aside), (goal.radius + aside) * g.length);
    if (reach < 0.0) return;
    for (int sign : {1, -1}) {
      if (reach == 0.0 && sign < 0) break;
      PositionSolution solution = partial;
      solution.sign[1] = reach == 0.0 ? 0 : sign;
      solution.q[1] = sign * reach - r.dot(slide);
      finishFirstTurn(g, origin + r + solution.q[1] * slide, goal, preferred, solution);
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
  const std::size_t unknown = solve_first ? 0 : 2;
  forEachRoot(roots, g, unknown, preferred, [&](PositionSolution& solution) {
    const double value = solution.q[unknown];
    solution.q[2 - unknown] = solve_first ? (rise - k1 * value) / k3 : (rise - k3 * value) / k1;
    const Vector3 a = from_base + value * from_rate;
    const Vector3 b = to_base + value * to_rate;
    const double radius = (a - axis * axis.dot(a)).norm();
    if (radius <= kOnAxis * g.length) {
      setFree(1, preferred, solution);
    } else {
      solution.turn[1] = turnBetween(g.ex.dot(a), g.ey.dot(a), g.ex.dot(b), g.ey.dot(b));
    }
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

}  // namespace screwline
