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

std::function<std::vector<VectorX>(const Pose&)> everySolution(const InverseKinematics& ik) {
  return [&ik](const Pose& target) {
    IkRequest request;
    request.target = target;
    request.ignore_limits = true;
    request.find_closest = false;
    std::vector<VectorX> all;
    for (const IkAnswer& answer : ik.solve(request).solutions) all.push_back(answer.position);
    return all;
  };
}

}  // namespace screwline
