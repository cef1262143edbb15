#ifndef SCREWLINE_SRC_IK_IK_REQUEST_CHECK_H
#define SCREWLINE_SRC_IK_IK_REQUEST_CHECK_H

#include "screwline/ik/inverse_kinematics.h"

namespace screwline {

/// A target turned off the axis of a single rotation row by more than this is refused.
constexpr double kOffAxisTolerance = 1e-6;

/// Refuses what solve() cannot answer. `parameter_joint`: whose value a request may fix as its redundancy; -1: none.
/// @throws InputError naming field, value and bound
void checkRequest(const SerialChain& chain, const Task& task, const IkRequest& request,
                  const std::vector<std::string>& branches, int parameter_joint = -1);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_IK_REQUEST_CHECK_H
