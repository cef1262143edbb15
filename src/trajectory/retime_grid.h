#ifndef SCREWLINE_TRAJECTORY_RETIME_GRID_H
#define SCREWLINE_TRAJECTORY_RETIME_GRID_H

#include <vector>

#include "screwline/trajectory/retime.h"

namespace screwline {

/// A path cut into intervals, and what the limits say on each about x = (du/dt)^2 at its start and w = d^2u/dt^2, which
/// is constant on it: x(u) = x + 2 w (u - start). Joint accelerations q' w + q'' x(u) are then polynomials of u whose
/// control points in Bernstein form are linear in (x, w): each gives a row, -reach <= w + slope x <= reach, and rows
/// that hold bound the whole interval. Velocities give the ceiling of x at each grid point: |q'|^2 x(u) <= v^2 follows
/// on the whole interval from a tangent of v^2 / p^2 at a p in the middle of |q'|.
struct RetimeGrid {
  int rows = 0;                 ///< Of each interval; a multiple of 4, the last ones unbounded.
  std::vector<double> u;        ///< intervals() + 1 of them, from 0 to the path's length.
  std::vector<double> ceiling;  ///< Of x at each u; 0 where the path turns.
  std::vector<double> slope;    ///< [interval][row]
  std::vector<double> reach;    ///< [interval][row]

  std::size_t intervals() const { return u.size() - 1; }
  double length(std::size_t interval) const { return u[interval + 1] - u[interval]; }
};

/// Linear in its intervals. Every breakpoint of the path is on the grid, and at least four intervals between two.
RetimeGrid makeGrid(const JointPath& path, const Limits& limits, const RetimeOptions& options);

/// What w may be at x on an interval, with the end of the interval in [next_lower, next_upper].
struct RateInterval {
  double lower = 0.0;
  double upper = 0.0;
};
RateInterval feasibleRates(const RetimeGrid& grid, std::size_t interval, const Range& next, double x);

/// The x at the start of an interval from which some w keeps its rows and ends in `next`: an interval, since the rows
/// are linear. upper < lower where there is none. Newton's method on the gap between the least and the greatest w,
/// which is concave and piecewise linear in x: finitely many steps, two to four as a rule.
Range controllableSpeeds(const RetimeGrid& grid, std::size_t interval, const Range& next);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_RETIME_GRID_H
