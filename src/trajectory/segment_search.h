#ifndef SCREWLINE_SRC_TRAJECTORY_SEGMENT_SEARCH_H
#define SCREWLINE_SRC_TRAJECTORY_SEGMENT_SEARCH_H

#include <vector>

#include "screwline/trajectory/segment_times.h"

namespace screwline {

/// How long each segment should take beside the others for the shortest motion within the limits, where the motion's
/// shape depends on positions and ratios of times alone. Starts from `weights` and is never worse than these: first
/// every segment that has room is shortened and every one that is tight lengthened until all meet a limit (of the
/// optimum most do), then single ones are left room again, or are lengthened, where the whole gains by it. Steps and
/// their number are fixed, so the same request gets the same answer, and the same backwards the reversed one. Limits
/// are looked at in a few places of each piece: the caller scales the result by exact extrema.
/// @pre weights positive, one per segment. Cost bounded: about 0.2 s, and linear in segments and joints beyond that.
std::vector<double> shortestRatios(const ShapeBuilder& build, const MatrixX& positions, const Limits& limits,
                                   const std::vector<double>& weights);

/// One step of balancing: the lengths, those of segments with room shorter. For shapes that change with their duration.
std::vector<double> balancedOnce(const ShapeBuilder& build, const MatrixX& positions, const Limits& limits,
                                 const std::vector<double>& lengths);

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_SEGMENT_SEARCH_H
