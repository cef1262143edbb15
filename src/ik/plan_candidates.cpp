#include "plan_candidates.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "solution_curve.h"

namespace screwline {
namespace {

/// The solution on the same branch of the same continuum, nearest to `preferred`.
bool memberOf(const ClosedFormPlan& plan, const SerialChain& chain, const Pose& target, const PlanSolution& kin,
              const VectorX& preferred, VectorX& q) {
  PlanSolutions solutions;
  plan.solve(target, preferred.data(), solutions);
  double least = std::numeric_limits<double>::infinity();
  for (const PlanSolution& solution : solutions) {
    if (solution.free != kin.free || solution.sign != kin.sign || solution.rank != kin.rank) continue;
    const Eigen::Map<const VectorX> member(solution.q.data(), chain.size());
    const double difference = largestDifference(chain, member, preferred);
    if (difference >= least) continue;
    least = difference;
    q = member;
  }
  return least < std::numeric_limits<double>::infinity();
}

/// The two wrists of one arm.
bool areWristsOfOneArm(const PlanSolution& a, const PlanSolution& b) {
  return a.free == b.free && a.rank == b.rank && a.sign[0] == b.sign[0] && a.sign[1] == b.sign[1] &&
         a.sign[2] == -b.sign[2];
}

/// Sets of `count` of the task's rows, positions first.
std::vector<Task> partsOf(const Task& task, int count) {
  std::vector<Task> parts;
  for (unsigned mask = 1; mask < 64U; ++mask) {
    std::vector<int> rows;
    for (int row = 0; row < 6; ++row) {
      if ((mask >> row & 1U) != 0U && task.contains(row)) rows.push_back(row);
    }
    const bool all_in_task = static_cast<int>(rows.size()) == count && [&] {
      unsigned chosen = 0;
      for (int row : rows) chosen |= 1U << row;
      return chosen == mask;
    }();
    if (all_in_task) parts.push_back(Task::fromRows(rows));
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Task& a, const Task& b) { return a.translationCount() > b.translationCount(); });
  return parts;
}

}  // namespace

std::optional<TaskPlan> planFor(const SerialChain& chain, const Task& task) {
  if (chain.size() > task.size()) return std::nullopt;
  for (const Task& part : partsOf(task, chain.size())) {
    if (std::optional<ClosedFormPlan> plan = ClosedFormPlan::compile(chain, part)) return TaskPlan{*plan, part};
  }
  return std::nullopt;
}

std::vector<Candidate> candidatesOf(const TaskPlan& plan, const SerialChain& chain, const Pose& target,
                                    const VectorX& seed) {
  PlanSolutions solutions;
  plan.plan.solve(target, seed.data(), solutions);
  std::vector<Candidate> candidates;
  candidates.reserve(static_cast<std::size_t>(solutions.count));
  for (const PlanSolution& solution : solutions) {
    Candidate candidate;
    candidate.q = jointsOf(solution, chain.size());
    candidate.branch = plan.plan.branchName(solution);
    candidate.free = freeJointsOf(solution);
    candidate.merged = plan.plan.isDouble(solution);
    if (const std::optional<PlanSheet> sheet = plan.plan.sheetOf(target, solution)) {
      candidate.member = [sheet = *sheet, n = chain.size(), joint = candidate.free.front()](const VectorX& preferred,
                                                                                            VectorX& q) {
        PlanSolution member;
        if (!sheet.member(preferred[joint], member)) return false;
        q = Eigen::Map<const VectorX>(member.q.data(), n);
        return true;
      };
      if (!candidates.empty() && areWristsOfOneArm(solutions.solutions[candidates.size() - 1], solution)) {
        candidate.image = candidates.back().image;
      } else if (const std::optional<int> mirrored = plan.plan.mirroredByWrist()) {
        candidate.image = std::make_shared<CurveImage>();
        candidate.image->mirrored = *mirrored;
      }
    } else if (!candidate.free.empty()) {
      const ClosedFormPlan* closed_form = &plan.plan;
      candidate.member = [closed_form, &chain, target, solution](const VectorX& preferred, VectorX& q) {
        return memberOf(*closed_form, chain, target, solution, preferred, q);
      };
    }
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

std::vector<std::string> branchNamesOf(const std::vector<BranchPart>& parts) {
  std::vector<std::string> names;
  for (const BranchPart& part : parts) names.insert(names.end(), {part.positive, part.negative, part.neutral});
  return names;
}

}  // namespace screwline
