#include "screwline/ik/redundant/six_joint_solver.h"

#include <algorithm>

namespace screwline {
namespace {

constexpr std::size_t kCapacity = 16;

void solveBy(const ClosedFormPlan& plan, const Pose& target, const double* preferred, SixJointSolutions& solutions) {
  PlanSolutions found;
  plan.solve(target, preferred, found);
  std::copy(found.begin(), found.end(), solutions.solutions.begin());
  solutions.count = found.count;
}

void add(const PlanSolution& solution, SixJointSolutions& solutions) {
  if (static_cast<std::size_t>(solutions.count) == kCapacity) {
    solutions.complete = false;
  } else {
    solutions.solutions[static_cast<std::size_t>(solutions.count++)] = solution;
  }
}

/// A member of each continuum that leaves one of the pair free: the preferred value may lie beyond its ends.
void addMembers(const ParallelPlan& plan, const Pose& target, SixJointSolutions& solutions) {
  for (const ParallelSheet& sheet : plan.sheets(target)) {
    for (const SheetStretch& stretch : sheet.stretches()) {
      for (int elbow : {1, -1}) add(sheet.member(0.5 * (stretch.from + stretch.to), elbow), solutions);
    }
  }
}

void solveBy(const ParallelPlan& plan, const Pose& target, const double* preferred, SixJointSolutions& solutions) {
  ParallelSolutions found;
  plan.solve(target, preferred, found);
  std::copy(found.begin(), found.end(), solutions.solutions.begin());
  solutions.count = found.count;
  // What is clamped may be none, what is open has more.
  solutions.complete = found.clamped == 0 && found.open == 0;
  if (found.open != 0) addMembers(plan, target, solutions);
}

void solveBy(const AlgebraicSolver& solver, const Pose& target, const double*, SixJointSolutions& solutions) {
  AlgebraicSolutions found;
  solver.solve(target, found);
  solutions.complete = found.complete;
  for (const std::array<double, 6>& root : found) {
    PlanSolution solution;
    std::copy(root.begin(), root.end(), solution.q.begin());
    add(solution, solutions);
  }
}

}  // namespace

std::optional<SixJointSolver> SixJointSolver::compileClosedForm(const SerialChain& chain) {
  if (const std::optional<ClosedFormPlan> plan = ClosedFormPlan::compile(chain, Task())) return SixJointSolver(*plan);
  if (const std::optional<ParallelPlan> plan = ParallelPlan::compile(chain)) return SixJointSolver(*plan);
  return std::nullopt;
}

std::optional<SixJointSolver> SixJointSolver::compileAlgebraic(const SerialChain& chain) {
  const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
  if (!solver) return std::nullopt;
  return SixJointSolver(*solver);
}

void SixJointSolver::solve(const Pose& target, const double* preferred, SixJointSolutions& solutions) const {
  solutions.count = 0;
  solutions.complete = true;
  std::visit([&](const auto& method) { solveBy(method, target, preferred, solutions); }, method_);
}

const std::string& SixJointSolver::method() const {
  return std::visit([](const auto& method) -> const std::string& { return method.method(); }, method_);
}

std::vector<BranchPart> SixJointSolver::branchParts() const {
  if (plan() != nullptr) return plan()->branchParts();
  const auto* parallel = std::get_if<ParallelPlan>(&method_);
  return parallel != nullptr ? parallel->branchParts() : std::vector<BranchPart>();
}

std::string SixJointSolver::branchName(const PlanSolution& solution) const {
  if (plan() != nullptr) return plan()->branchName(solution);
  const auto* parallel = std::get_if<ParallelPlan>(&method_);
  return parallel != nullptr ? parallel->branchName(solution) : std::string();
}

bool SixJointSolver::isDouble(const PlanSolution& solution) const {
  if (plan() != nullptr) return plan()->isDouble(solution);
  const auto* parallel = std::get_if<ParallelPlan>(&method_);
  return parallel != nullptr && parallel->isDouble(solution);
}

}  // namespace screwline
