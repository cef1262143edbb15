#ifndef SCREWLINE_SRC_IK_SELF_MOTION_ANSWERS_H
#define SCREWLINE_SRC_IK_SELF_MOTION_ANSWERS_H

#include <functional>
#include <optional>
#include <vector>

#include "screwline/ik/redundant/self_motion_solver.h"
#include "solution_builder.h"

namespace screwline {

/// A piece of a self-motion as an answer; empty where forward kinematics does not confirm it to 1e-9.
/// @param held the joint whose value the request fixes, or -1.
std::optional<IkAnswer> confirmed(const SelfMotionAnswer& found, int held, const SolutionBuilder& builder);

SelfMotionQuestion questionOf(const IkRequest& request);

using Confirm = std::function<std::optional<IkAnswer>(const SelfMotionAnswer&)>;

/// Those that are confirmed. Sets what the result says of completeness and of curves outside the limits; where one is
/// not confirmed, the list is not complete.
std::vector<IkAnswer> confirmedOf(const SelfMotionAnswers& found, const Confirm& confirm, IkResult& result);

/// Every self-motion of a chain of seven joints as an answer, or, where the request fixes the parameter joint, every
/// solution at its value; as confirmedOf().
std::vector<IkAnswer> selfMotionAnswers(const SelfMotionSolver& solver, const IkRequest& request,
                                        const SolutionBuilder& builder, IkResult& result);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_SELF_MOTION_ANSWERS_H
