#ifndef SCREWLINE_IK_INVERSE_OUTLINE_OF_H
#define SCREWLINE_IK_INVERSE_OUTLINE_OF_H

#include <optional>

#include "screwline/kinematics/inverse_outline.h"
#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"

namespace screwline {

/// The closed form that InverseKinematics uses for all rows of the task; empty where it has another method. Allocates.
std::optional<InverseOutline> inverseOutlineOf(const SerialChain& chain, const Task& task);

}  // namespace screwline

#endif  // SCREWLINE_IK_INVERSE_OUTLINE_OF_H
