#ifndef SCREWLINE_SRC_IK_SELF_MOTION_ANSWERS_H
#define SCREWLINE_SRC_IK_SELF_MOTION_ANSWERS_H

#include <vector>

#include "screwline/ik/redundant/self_motion_solver.h"
#include "solution_builder.h"

namespace screwline {

/// Every self-motion of a chain of seven joints as an answer, or, where the request fixes the parameter joint, every
/// solution at its value. Sets what the result says of completeness and of curves outside the limits. Those that
/// forward kinematics does not confirm to 1e-9 are left out, and the list is then not complete.
std::vector<IkAnswer> selfMotionAnswers(const SelfMotionSolver& solver, const IkRequest& request,
                                        const SolutionBuilder& builder, IkResult& result);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_SELF_MOTION_ANSWERS_H
