#ifndef SCREWLINE_KINEMATICS_TASK_SELECTION_H
#define SCREWLINE_KINEMATICS_TASK_SELECTION_H

#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"

namespace screwline {

/// The rows that a chain can control, where nobody says: all six for six or more joints; for five the position and the
/// direction of the tool's z axis (else x, else y), where these are regular at most of a fixed set of configurations;
/// else the first set of n rows that is, in an order that prefers positions, then whole orientations, then headings (a
/// planar arm of three joints: x y rz; an articulated one: x y z; a wrist: rx ry rz). Fewer than n rows where no n rows
/// are independent.
Task deriveTask(const SerialChain& chain);

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_TASK_SELECTION_H
