#include "plan_candidates.h"

#include <algorithm>
#include <limits>
#include <memory>

namespace screwline {
namespace {

const char* const kNeutralWords[] = {"straight", "centred", "aligned", "between"};

std::string what(const std::string& part) {
  return part.substr(0, part.find(' '));
}
std::string which(const std::string& part) {
  return part.substr(part.find(' ') + 1);
}

bool isNeutral(const std::string& part) {
  return std::find(std::begin(kNeutralWords), std::end(kNeutralWords), which(part)) != std::end(kNeutralWords);
}

VectorX toVector(const SerialChain& chain, const PlanSolution& solution) {
  VectorX q(chain.size());
  for (int i = 0; i < chain.size(); ++i) q[i] = solution.q[static_cast<std::size_t>(i)];
  return q;
}

/// The solution on the same branch of the same continuum, nearest to `preferred`.
bool memberOf(const ClosedFormPlan& plan, const SerialChain& chain, const Pose& target, const PlanSolution& kin,
              const VectorX& preferred, VectorX& q) {
  PlanSolutions solutions;
  plan.solve(target, preferred.data(), solutions);
  double least = std::numeric_limits<double>::infinity();
  for (const PlanSolution& solution : solutions) {
    if (solution.free != kin.free || solution.sign != kin.sign || solution.rank != kin.rank) continue;
    const VectorX member = toVector(chain, solution);
    const double difference = largestDifference(chain, member, preferred);
    if (difference >= least) continue;
    least = difference;
    q = member;
  }
  return least < std::numeric_limits<double>::infinity();
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
  for (const PlanSolution& solution : solutions) {
    Candidate candidate;
    candidate.q = toVector(chain, solution);
    candidate.branch = plan.plan.branchName(solution);
    for (int i = 0; i < chain.size(); ++i) {
      if ((solution.free >> i & 1U) != 0U) candidate.free.push_back(i);
    }
    candidate.merged = plan.plan.isDouble(solution);
    if (!candidate.free.empty()) {
      const ClosedFormPlan* closed_form = &plan.plan;
      candidate.member = [closed_form, &chain, target, solution](const VectorX& preferred, VectorX& q) {
        return memberOf(*closed_form, chain, target, solution, preferred, q);
      };
    }
    candidates.push_back(candidate);
  }
  return candidates;
}

std::vector<std::string> branchNamesOf(const std::vector<BranchPart>& parts) {
  std::vector<std::string> names;
  for (const BranchPart& part : parts) names.insert(names.end(), {part.positive, part.negative, part.neutral});
  return names;
}

std::vector<std::string> branchPartsOf(const std::string& branch) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin < branch.size()) {
    std::size_t end = branch.find(',', begin);
    if (end == std::string::npos) end = branch.size();
    const std::size_t first = branch.find_first_not_of(' ', begin);
    const std::size_t last = branch.find_last_not_of(' ', end - 1);
    if (first != std::string::npos && first < end) parts.push_back(branch.substr(first, last - first + 1));
    begin = end + 1;
  }
  return parts;
}

bool matchesBranch(const std::string& branch, const std::string& wish) {
  const std::vector<std::string> has = branchPartsOf(branch);
  for (const std::string& wished : branchPartsOf(wish)) {
    const bool met = std::any_of(has.begin(), has.end(), [&](const std::string& part) {
      return part == wished || (what(part) == what(wished) && isNeutral(part));
    });
    if (!met) return false;
  }
  return true;
}

}  // namespace screwline
