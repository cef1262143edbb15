#ifndef SCREWLINE_TRAJECTORY_DOUBLE_S_H
#define SCREWLINE_TRAJECTORY_DOUBLE_S_H

#include "screwline/trajectory/constant_jerk.h"
#include "screwline/trajectory/time_law.h"

namespace screwline {

/// The shortest motion from rest at 0 to rest at 1 under limits on the derivatives of s by time. Closed form where the
/// limits are symmetric; where they are not, the extreme motion of AxisMotion, whose duration is a root found to
/// rounding. @pre lower < 0 < upper in each order, jerk finite. Does not allocate. Source: Biagiotti & Melchiorri,
/// section 3.4.
JerkPhases shortestDoubleS(const AxisLimits& limits);

/// The limits on s that the limits of a joint with this displacement (not zero) leave, met with `limits` of s so far.
AxisLimits narrowed(const AxisLimits& limits, const AxisLimits& joint, double displacement);

/// The phases as a scaling over tau in [0, 1]. @pre they lead from rest at 0 to rest at 1.
TimeLaw timeLawOf(const JerkPhases& phases);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_DOUBLE_S_H
