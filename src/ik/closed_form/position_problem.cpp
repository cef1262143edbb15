#include "screwline/ik/closed_form/position_problem.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "position_kernels.h"
#include "screwline/model/structure.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr double kMostRefined = 1e-8;  // [rad, m] A longer step is no refinement.
constexpr double kRounding = 1e-15;    // Of the chain's length.

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

/// Whether axis 3 is parallel to axis 2; then fills what the arm's plane needs. @pre axis 1 is across axis 2
bool alignArmPlane(PositionGeometry& g) {
  const AxisRelation relation = relate(g.axes[1], g.axes[2], g.length);
  if (g.axes[2].prismatic || !relation.parallel || relation.coincident) return false;
  g.kind = PositionKind::kArmPlane;
  const Vector3 link = g.axes[2].point - g.axes[1].point;
  g.link_x = g.ex.dot(link);
  g.link_y = g.ey.dot(link);
  g.link = std::hypot(g.link_x, g.link_y);
  g.third_sense = std::copysign(1.0, g.axes[1].direction.dot(g.axes[2].direction));
  g.x1 = g.ey;
  g.y1 = g.axes[0].direction.cross(g.x1);
  return true;
}

/// False where two turns about one line, or slides in one plane, leave positions that nothing reaches.
bool classify(PositionGeometry& g) {
  const AxisRelation relation = relate(g.axes[0], g.axes[1], g.length);
  if (!g.axes[0].prismatic && !g.axes[1].prismatic) {
    if (relation.coincident) return false;
    alignTurns(g, relation);
    if (relation.orthogonal && alignArmPlane(g)) return true;
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

/// Displacements as the axes stand in the chain, base to tip.
void reverse(PositionSolutions& solutions) {
  for (int i = 0; i < solutions.count; ++i) {
    PositionSolution& solution = solutions.solutions[static_cast<std::size_t>(i)];
    solution.q = {-solution.q[2], -solution.q[1], -solution.q[0]};
    solution.turn = {solution.turn[2].inverse(), solution.turn[1].inverse(), solution.turn[0].inverse()};
    std::swap(solution.free[0], solution.free[2]);
  }
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

void PositionProblem::addTurns(const PositionSolutions& solutions, TurnBatch& batch) const {
  for (const PositionSolution& solution : solutions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (isAngle(solution, axis)) batch.add(solution.turn[axis]);
    }
  }
}

void PositionProblem::takeFrom(const TurnBatch& batch, PositionSolutions& solutions) const {
  std::size_t place = 0;
  for (int i = 0; i < solutions.count; ++i) {
    PositionSolution& solution = solutions.solutions[static_cast<std::size_t>(i)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (isAngle(solution, axis)) solution.q[axis] = batch[place++];
    }
  }
}

double PositionProblem::refine(const Vector3& start, const Vector3& goal, PositionSolution& solution) const {
  if (solution.free[0] || solution.free[1] || solution.free[2]) return 0.0;
  Matrix3 J;
  Vector3 p = start;
  for (std::size_t i = 3; i-- > 0;) {
    const Axis& axis = axisOf(i);
    const Turn& turn = solution.turn[i];
    const auto column = static_cast<Eigen::Index>(i);
    if (axis.prismatic) {
      p += solution.q[i] * axis.direction;
      J.col(column) = axis.direction;
    } else {
      p = axis.point + turned(axis.direction, turn, p - axis.point);
      J.col(column) = axis.direction.cross(p - axis.point);
      for (Eigen::Index k = column + 1; k < 3; ++k) J.col(k) = turned(axis.direction, turn, J.col(k));
    }
  }
  const Matrix3 inverse = J.inverse();
  const Vector3 step = inverse * (goal - p);
  if (!(step.norm() <= kMostRefined)) return 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double moved = step[static_cast<Eigen::Index>(i)];
    if (axisOf(i).prismatic) {
      solution.q[i] += moved;
    } else {
      solution.turn[i] = normalized(solution.turn[i] * Turn{1.0, moved});
    }
  }
  return kRounding * geometry_.length * inverse.norm();
}

void PositionProblem::solve(const Vector3& start, const Vector3& goal, const std::array<double, 3>& preferred,
                            PositionSolutions& solutions) const {
  solveInTurns(start, goal, preferred, solutions);
  TurnBatch batch;
  addTurns(solutions, batch);
  batch.takeAngles();
  takeFrom(batch, solutions);
}

void PositionProblem::solveInTurns(const Vector3& start, const Vector3& goal, const std::array<double, 3>& preferred,
                                   PositionSolutions& solutions) const {
  const PositionGeometry& g = geometry_;
  solutions.count = 0;
  const Vector3& from = g.reversed ? goal : start;
  const Vector3& to = g.reversed ? start : goal;
  const Preferred wished = g.reversed ? Preferred{-preferred[2], -preferred[1], -preferred[0]} : preferred;
  switch (g.kind) {
    case PositionKind::kArmPlane:
      solveArmPlane(g, from, to, wished, solutions);
      break;
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
  if (g.reversed) reverse(solutions);
}

}  // namespace screwline
