#ifndef SCREWLINE_TRAJECTORY_ROUNDED_PATH_H
#define SCREWLINE_TRAJECTORY_ROUNDED_PATH_H

#include <vector>

#include "screwline/trajectory/corner.h"
#include "screwline/trajectory/path.h"

namespace screwline {

/// Lines in joint space with rounded corners, without time.
struct RoundedLines {
  JointPath path;                 ///< u is the way along the lines (norm of joint differences [rad or m]).
  std::vector<double> waypoints;  ///< u of each waypoint: the middle of its blend.
  std::vector<Corner> corners;    ///< Of each waypoint; zero at the ends and where the way goes straight on.
};

/// The lines from waypoint to waypoint (the columns of positions, n x N, N >= 2). At most `radius` before a waypoint
/// the line is left on a quartic blend (cornerRise), so the path is C2 and can be timed without a stop, under jerk
/// limits too; outside of the blends it is exactly that of the lines. Where lines are too short for the radius, corners
/// share them fairly (fairReaches). The path turns, so that a motion has to stop, where the way goes straight back,
/// where a blend would be shorter than 1e-6 of the way, and at every corner if the radius is 0. Repeated waypoints
/// count once. O(N log N); allocates.
/// @pre some waypoint differs from the first, radius >= 0.
RoundedLines roundedLines(const MatrixX& positions, double radius);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_ROUNDED_PATH_H
