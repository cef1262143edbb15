#ifndef SCREWLINE_IK_INVERSE_OUTLINE_OF_H
#define SCREWLINE_IK_INVERSE_OUTLINE_OF_H

#include <functional>
#include <optional>
#include <vector>

#include "screwline/ik/inverse_kinematics.h"
#include "screwline/kinematics/inverse_outline.h"

namespace screwline {

/// The closed form that InverseKinematics uses for all rows of the task; empty where it has another method. Allocates.
std::optional<InverseOutline> inverseOutlineOf(const SerialChain& chain, const Task& task);

/// All solutions of a pose, limits not looked at. @pre `ik` outlives what is returned.
std::function<std::vector<VectorX>(const Pose&)> everySolution(const InverseKinematics& ik);

}  // namespace screwline

#endif  // SCREWLINE_IK_INVERSE_OUTLINE_OF_H
