#ifndef SCREWLINE_TRAJECTORY_BLEND_H
#define SCREWLINE_TRAJECTORY_BLEND_H

#include <vector>

#include "screwline/trajectory/corner.h"
#include "screwline/trajectory/limits.h"
#include "screwline/trajectory/piecewise_polynomial.h"

namespace screwline {

/// Lines in joint space with rounded corners.
struct BlendedLines {
  PiecewisePolynomial motion;   ///< Of degree 2, C1, from rest to rest.
  std::vector<double> times;    ///< [s] of each waypoint: the middle of its blend.
  std::vector<Corner> corners;  ///< Of each waypoint; zero at the ends and where the way goes straight on.
};

/// Trapezoidal speed along the lines from waypoint to waypoint (the columns of positions, n x N, N >= 2), without a
/// stop at the corners: at most `radius` before a waypoint the line is left on a parabola of constant acceleration,
/// which meets the next line as far behind the waypoint at the same speed, and at full acceleration. Outside the radius
/// the way is exactly that of the lines. Corners share a line fairly (fairReaches), and are as fast as that leaves room
/// for braking; where the way turns straight back the motion stops: a pass backwards and one forwards over the squares
/// of the speeds, in which everything is linear. Repeated waypoints count once. Linear in N; allocates. Source:
/// Biagiotti & Melchiorri, section 3.2 (parabolic blends).
/// @pre some waypoint differs from the first, radius > 0.
/// @throws InputError(kInvalidGoal) where the acceleration limit of a joint that moves is infinite.
BlendedLines blendLines(const MatrixX& positions, const Limits& limits, double radius);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_BLEND_H
