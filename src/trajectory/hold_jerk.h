#ifndef SCREWLINE_SRC_TRAJECTORY_HOLD_JERK_H
#define SCREWLINE_SRC_TRAJECTORY_HOLD_JERK_H

#include "screwline/trajectory/profile.h"

namespace screwline {

/// Whether a path is to keep the jerk limits: its parameter `hold_jerk` is 1 and there are some.
/// @throws InputError for another value than 0 or 1.
bool holdsJerk(const ProfileContext& context);

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_HOLD_JERK_H
