#ifndef SCREWLINE_SRC_IK_CLOSED_FORM_POSITION_KERNELS_H
#define SCREWLINE_SRC_IK_CLOSED_FORM_POSITION_KERNELS_H

#include <cmath>

#include "screwline/ik/closed_form/position_problem.h"

namespace screwline {

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
    radius = std::sqrt(x * x + y * y);
    scale = g.length * g.length + height * height + radius * radius;
  }
  double height = 0.0;
  double radius = 0.0;
  double x = 0.0;
  double y = 0.0;
  double scale = 0.0;  ///< [m^2] of the terms of the eliminant.
};

/// An axis that any value does for takes the preferred one.
inline void setFree(std::size_t axis, const Preferred& preferred, PositionSolution& solution) {
  solution.free[axis] = true;
  solution.q[axis] = preferred[axis];
  solution.turn[axis] = turnBy(preferred[axis]);
}

/// Turns axis 1 so that it carries the point at (x, y) across it to the goal; anything does where the goal is on the
/// axis.
inline void finishFirstTurn(const PositionGeometry& g, double x, double y, const TurnGoal& goal,
                            const Preferred& preferred, PositionSolution& solution) {
  if (goal.radius <= kOnAxis * g.length) {
    setFree(0, preferred, solution);
  } else {
    solution.turn[0] = turnBetween(x, y, goal.x, goal.y);
  }
}

inline void finishFirstTurn(const PositionGeometry& g, const Vector3& second, const TurnGoal& goal,
                            const Preferred& preferred, PositionSolution& solution) {
  const Vector3 r = second - g.axes[0].point;
  finishFirstTurn(g, g.x1.dot(r), g.y1.dot(r), goal, preferred, solution);
}

/// A solution for each root of an eliminant in the displacement of `axis`; where every value is one, for the preferred
/// value alone, marked free.
template <typename Use>
void forEachRoot(const RealRoots& roots, const PositionGeometry& g, std::size_t axis, const Preferred& preferred,
                 Use&& use) {
  if (roots.always) {
    PositionSolution solution;
    setFree(axis, preferred, solution);
    if (g.axes[axis].prismatic) solution.turn[axis] = Turn();
    use(solution);
    return;
  }
  std::array<int, 3> rank{};  // Of each slope.
  for (const RealRoot& root : roots) {
    PositionSolution solution;
    solution.q[axis] = root.value;
    solution.turn[axis] = root.turn;
    solution.sign[0] = root.slope;
    solution.rank = rank[static_cast<std::size_t>(root.slope + 1)]++;
    use(solution);
  }
}

// One for each kind of problem, axes in the order of elimination. They set turns of revolute axes, and displacements of
// prismatic and free ones.

/// kArmPlane.
void solveArmPlane(const PositionGeometry& g, const Vector3& start, const Vector3& goal, const Preferred& preferred,
                   PositionSolutions& out);
/// kMeetingAxes, kParallelAxes, kSkewAxes.
void solveTurns(const PositionGeometry& g, const Vector3& start, const Vector3& goal, const Preferred& preferred,
                PositionSolutions& out);
void solveTurnAndSlide(const PositionGeometry& g, const Vector3& start, const Vector3& goal, const Preferred& preferred,
                       PositionSolutions& out);
void solveSlideAcross(const PositionGeometry& g, const Vector3& start, const Vector3& goal, const Preferred& preferred,
                      PositionSolutions& out);
void solveSlideTurnSlide(const PositionGeometry& g, const Vector3& start, const Vector3& goal,
                         const Preferred& preferred, PositionSolutions& out);
void solveSlides(const PositionGeometry& g, const Vector3& start, const Vector3& goal, PositionSolutions& out);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_CLOSED_FORM_POSITION_KERNELS_H
