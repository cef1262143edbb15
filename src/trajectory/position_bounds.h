#ifndef SCREWLINE_TRAJECTORY_POSITION_BOUNDS_H
#define SCREWLINE_TRAJECTORY_POSITION_BOUNDS_H

#include "screwline/trajectory/state_to_state.h"

namespace screwline {

/// The least duration from T on that every joint can have.
double commonDuration(const StateToStateMotion& motion, double T);

/// Where a joint leaves its position limits on the way: another motion of the same duration, else a longer duration;
/// the status says where there is none.
void keepPositions(const StateToState& question, StateToStateMotion& motion);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_POSITION_BOUNDS_H
