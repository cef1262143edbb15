#include "screwline/ik/inverse_outline_of.h"

#include "screwline/ik/closed_form/parallel_plan.h"
#include "screwline/ik/closed_form/plan.h"

namespace screwline {

std::optional<InverseOutline> inverseOutlineOf(const SerialChain& chain, const Task& task) {
  if (const std::optional<ClosedFormPlan> plan = ClosedFormPlan::compile(chain, task)) return plan->outline();
  if (task.size() != 6) return std::nullopt;
  if (const std::optional<ParallelPlan> plan = ParallelPlan::compile(chain)) return plan->outline();
  return std::nullopt;
}

}  // namespace screwline
