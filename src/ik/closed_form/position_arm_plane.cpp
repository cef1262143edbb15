#include <algorithm>
#include <cmath>

#include "position_kernels.h"

namespace screwline {
namespace {

/// Two links in the arm's plane; the first ends on axis 3, the second at the point.
struct TwoLinks {
  TwoLinks(const PositionGeometry& g, const Vector3& start) {
    const Vector3 u = start - g.axes[2].point;
    x = g.ex.dot(u);
    y = g.ey.dot(u);
    fore = std::sqrt(x * x + y * y);
    amplitude = 2.0 * g.link * fore;
    at_zero = normalized({g.link_x * x + g.link_y * y, g.link_x * y - g.link_y * x});
  }
  double x = 0.0;
  double y = 0.0;
  double fore = 0.0;  ///< [m] length of the second link.
  double amplitude = 0.0;
  Turn at_zero;  ///< From the first link to the second.
};

/// Both elbows for the point at (x, y) from axis 2 in the plane; `partial` has the first turn.
void addElbows(const PositionGeometry& g, const TwoLinks& links, double x, double y, double scale,
               const Preferred& preferred, const PositionSolution& partial, PositionSolutions& out) {
  const double reach = std::sqrt(x * x + y * y);
  const double longest = g.link + links.fore;
  const double shortest = g.link - links.fore;
  // amplitude +- (reach^2 - link^2 - fore^2), as products that keep their digits where the elbow is straight or folded.
  const double above = (reach - shortest) * (reach + shortest);
  const double below = (longest - reach) * (longest + reach);
  const double root = squareRootOrNone(above * below, links.amplitude * std::max(links.amplitude, scale));
  if (root < 0.0) return;
  const double scale_bend = 1.0 / (above + below);
  const bool free = reach <= kOnAxis * g.length;
  for (int sign : {1, -1}) {
    if (root == 0.0 && sign < 0) break;
    PositionSolution& solution = out.solutions[static_cast<std::size_t>(out.count++)];
    solution = partial;
    solution.sign[0] = root == 0.0 ? 0 : sign;
    // Its length is 1, as (above - below)^2 + 4 above below = (above + below)^2.
    const Turn bend = Turn{scale_bend * (above - below), 2.0 * scale_bend * sign * root} * links.at_zero.inverse();
    solution.turn[2] = {bend.c, g.third_sense * bend.s};
    if (free) {
      setFree(1, preferred, solution);
    } else {
      const double before_x = g.link_x + bend.c * links.x - bend.s * links.y;
      const double before_y = g.link_y + bend.s * links.x + bend.c * links.y;
      solution.turn[1] = turnBetween(before_x, before_y, x, y);
    }
  }
}

}  // namespace

/// Axis 1 turns the arm's plane, in which axes 2 and 3 move the point: its distance from the plane through axis 1 stays
/// as it is, so both places of the plane (shoulders) follow from the distance to axis 1, and two links are left in each
/// (elbows; Brandstoetter, Angerer & Hofbaur 2014).
void solveArmPlane(const PositionGeometry& g, const Vector3& start, const Vector3& target, const Preferred& preferred,
                   PositionSolutions& out) {
  const TurnGoal goal(g, target);
  const TwoLinks links(g, start);
  if (links.fore <= kOnAxis * g.length) return;  // Axis 3 does not move the point: no plan for positions.
  const double lateral = g.y1.dot(start - g.axes[0].point);
  const double aside = std::abs(lateral);
  const double forward =
      squareRootOrNone((goal.radius - aside) * (goal.radius + aside), (goal.radius + aside) * g.length);
  if (forward < 0.0) return;
  for (int sign : {1, -1}) {
    if (forward == 0.0 && sign < 0) break;
    PositionSolution shoulder;
    shoulder.sign[1] = forward == 0.0 ? 0 : sign;
    finishFirstTurn(g, sign * forward, lateral, goal, preferred, shoulder);
    addElbows(g, links, goal.height, sign * forward - g.offset, goal.scale, preferred, shoulder, out);
  }
}

}  // namespace screwline
