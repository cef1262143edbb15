#ifndef SCREWLINE_SRC_TRAJECTORY_RETIME_JERK_H
#define SCREWLINE_SRC_TRAJECTORY_RETIME_JERK_H

#include "screwline/trajectory/retime.h"

namespace screwline {

/// retime() with the jerk limits held. @pre what retime() checks.
RetimeResult retimeWithJerk(const JointPath& path, const Limits& limits, const RetimeOptions& options);

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_RETIME_JERK_H
