#ifndef SCREWLINE_SRC_IK_PLAN_CANDIDATES_H
#define SCREWLINE_SRC_IK_PLAN_CANDIDATES_H

#include <optional>
#include <string>
#include <vector>

#include "candidate.h"
#include "screwline/ik/closed_form/plan.h"

namespace screwline {

/// A plan with the rows that it solves: the task's, or, where the chain has fewer joints than the task has rows, as
/// many of them.
struct TaskPlan {
  ClosedFormPlan plan;
  Task task;
};

/// Empty where no closed form is known.
std::optional<TaskPlan> planFor(const SerialChain& chain, const Task& task);

/// All solutions of the plan, its continua with their members.
std::vector<Candidate> candidatesOf(const TaskPlan& plan, const SerialChain& chain, const Pose& target,
                                    const VectorX& seed);

/// Every part of a branch name that a plan uses, the neutral ones included.
std::vector<std::string> branchNamesOf(const std::vector<BranchPart>& parts);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_PLAN_CANDIDATES_H
