#ifndef SCREWLINE_TRAJECTORY_CLOCK_RAMPS_H
#define SCREWLINE_TRAJECTORY_CLOCK_RAMPS_H

#include <vector>

#include "screwline/trajectory/path_clock.h"

namespace screwline {

/// Phases that take a path's time from a state (path time, rate, change) to a constant rate within the bounds, a
/// waiting at a constant rate among them where the path leaves no room yet. Fewer where the path ends before. None
/// where the state changes its rate and no ramp leaves it: then it has to be followed first.
std::vector<JerkPhase> rampsTo(double rate, const EndState& state, const Path& path, const Limits& bounds);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_CLOCK_RAMPS_H
