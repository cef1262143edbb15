#ifndef SCREWLINE_TRAJECTORY_RETIME_H
#define SCREWLINE_TRAJECTORY_RETIME_H

#include <functional>
#include <vector>

#include "screwline/trajectory/limits.h"
#include "screwline/trajectory/path.h"
#include "screwline/trajectory/time_law.h"

namespace screwline {

/// The greatest du/dt that something besides the joints allows anywhere on [from, to] of the path (a tool's speed over
/// its speed per u); infinity where nothing does. Called once per grid interval, from 0 to the end.
using RateBound = std::function<double(double from, double to)>;

struct RetimeOptions {
  int grid_points = 0;      ///< Intervals of the grid; 0: chosen by the path.
  double start_rate = 0.0;  ///< du/dt at the start, >= 0.
  double end_rate = 0.0;    ///< du/dt at the end, >= 0.
  RateBound rate_bound;     ///< Empty: none.
  bool hold_jerk = false;   ///< Hold the jerk limits too.
  double duration = 0.0;    ///< [s] Of a motion with moving ends, if it is longer than the shortest; 0: the shortest.
};

enum class RetimeStatus {
  kDone,
  kEndTooFast,    ///< end_rate cannot be reached within the limits; end_rate of the result could.
  kStartTooFast,  ///< No motion with this start_rate keeps the limits; start_rate of the result could.
};

/// One point of the grid: where the motion is, how fast, and which limit holds it there.
struct RetimedPoint {
  double u = 0.0;
  double rate = 0.0;   ///< du/dt.
  double bound = 0.0;  ///< The greatest du/dt at which the velocity limits (and rate_bound) hold around here.
};

struct RetimeResult {
  RetimeStatus status = RetimeStatus::kDone;
  double duration = 0.0;                 ///< [s]
  TimeLaw law = TimeLaw::rectangular();  ///< u = length s(t / duration); it has a break wherever the path has one.
  std::vector<RetimedPoint> points;
  double start_rate = 0.0;  ///< As asked, or the greatest feasible one where that was too fast.
  double end_rate = 0.0;
};

/// The shortest motion along a path under the velocity and acceleration limits. The limits hold everywhere, between
/// grid points too: over each interval acceleration by u is constant, so joint accelerations are polynomials of u,
/// whose control points in Bernstein form are held within the limits. Reachability analysis (Pham & Pham, arXiv
/// 1707.07239): backwards the interval of speeds from which the end can be reached, one linear program of two variables
/// per grid interval, forwards the fastest within them. Linear in grid points. A path that turns is stopped at.
/// Position limits are not read. Acceleration steps where the limit that binds changes; jerk limits are not read,
/// unless hold_jerk: then d^2u/dt^2 is continuous, zero at both ends and where the path turns or its curvature steps,
/// and the jerk limits hold everywhere too. The motion without them, its acceleration averaged over the time that jerk
/// needs, is dilated in time by a local optimum (dilation.h); where exact extrema pass a limit between grid points the
/// motion is found anew with limits narrowed there, and what is then left is made up for by time. On a straight line
/// that is the double S to 0.2 % with the usual grid. Linear in grid points too, but some hundred times as much for
/// each. JointTrajectory::alongPath(path, law, duration) is the motion.
/// @pre path has a length and moves; limits of its joints, positive. @throws InputError(kInvalidGoal) otherwise or
/// where no limit bounds the motion.
RetimeResult retime(const JointPath& path, const Limits& limits, const RetimeOptions& options = {});

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_RETIME_H
