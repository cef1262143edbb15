#include "parallel_candidates.h"

#include <algorithm>

#include "screwline/ik/numerical/numerical_solver.h"
#include "solution_loop.h"

namespace screwline {
namespace {

using Signs = std::array<int, 3>;

constexpr int kMostSteps = 30;
constexpr double kBeside = 1e-2;    // [rad]
constexpr double kSettled = 1e-12;  // [m, rad] Errors that need no more steps.

/// Gathers candidates, and which branches they stand for: a sign that is 0 stands for both.
class Gathering {
 public:
  Gathering(const ParallelMethod& method, const SerialChain& chain, const Pose& target, const VectorX& seed)
      : method_(method), chain_(chain), target_(target), seed_(seed) {}

  void addIsolated(const PlanSolution& solution, const VectorX& q) {
    Candidate candidate;
    candidate.q = q;
    candidate.branch = method_.plan.branchName(solution);
    candidate.merged = method_.plan.isDouble(solution);
    add(std::move(candidate), solution.sign);
  }

  void addLoop(const SolutionLoop& loop) {
    Candidate candidate;
    PlanSolution named;
    named.sign = loop.sign();
    candidate.q = loop.at(0.0, seed_);
    candidate.branch = method_.plan.branchName(named);
    candidate.merged = true;
    candidate.free = {loop.joint()};
    candidate.round = loop.round();
    add(std::move(candidate), named.sign);
  }

  /// Members with more than one free joint, where no loop describes them.
  void addSheet(const PlanSolution& solution) {
    Candidate candidate;
    candidate.q = jointsOf(solution, 6);
    candidate.branch = method_.plan.branchName(solution);
    candidate.merged = true;
    candidate.free = freeJointsOf(solution);
    const ParallelPlan* plan = &method_.plan;
    const Pose target = target_;
    candidate.member = [plan, target, solution](const VectorX& preferred, VectorX& q) {
      ParallelSolutions solutions;
      plan->solve(target, preferred.data(), solutions);
      for (const PlanSolution& one : solutions) {
        if (one.free != solution.free || one.sign != solution.sign) continue;
        q = jointsOf(one, 6);
        return true;
      }
      return false;
    };
    add(std::move(candidate), solution.sign);
  }

  bool covers(const Signs& signs) const {
    return std::any_of(signs_.begin(), signs_.end(), [&](const Signs& known) {
      bool same = true;
      for (std::size_t i = 0; i < 3; ++i) same = same && (known[i] == 0 || signs[i] == 0 || known[i] == signs[i]);
      return same;
    });
  }

  /// Whether elimination could not add to them.
  bool coverAll() const {
    for (unsigned k = 0; k < 8; ++k) {
      const auto sign = [k](unsigned i) { return (k >> i & 1U) != 0U ? 1 : -1; };
      if (!covers({sign(0), sign(1), sign(2)})) return false;
    }
    return true;
  }

  std::vector<Candidate> take() { return std::move(candidates_); }

 private:
  void add(Candidate candidate, const Signs& signs) {
    candidates_.push_back(std::move(candidate));
    signs_.push_back(signs);
  }

  const ParallelMethod& method_;
  const SerialChain& chain_;
  const Pose& target_;
  const VectorX& seed_;
  std::vector<Candidate> candidates_;
  std::vector<Signs> signs_;
};

/// False where there is none after all.
bool addContinua(const ParallelMethod& method, const SerialChain& chain, const Pose& target, const VectorX& seed,
                 const ParallelSolutions& solutions, Gathering& gathering) {
  bool any = false;
  bool sheets = false;
  const auto add = [&](const SolutionLoops& found) {
    for (const SolutionLoop& loop : found.loops) gathering.addLoop(loop);
    for (const PlanSolution& point : found.points) gathering.addIsolated(point, jointsOf(point, 6));
    any = any || !found.loops.empty() || !found.points.empty();
  };
  add(loopsOfPair(method.plan, chain, target));
  for (int joint = 0; joint < 6; ++joint) {
    const bool is_open = (solutions.open >> joint & 1U) != 0U;
    if (is_open && !method.plan.isOfPair(joint)) add(sampledLoops(method.plan, chain, target, seed, joint));
  }
  for (const PlanSolution& solution : solutions) {
    if ((solution.free & (solution.free - 1U)) != 0U && !any) {
      gathering.addSheet(solution);
      sheets = true;
    }
  }
  return any || sheets;
}

/// Brings a configuration beside a multiple solution onto it: where Newton's steps are too long, by damped ones.
bool settle(const SerialChain& chain, const Pose& target, VectorX& q) {
  const auto isSolved = [](const TaskError& error, double tolerance) {
    return error.position <= tolerance && error.orientation <= tolerance;
  };
  const TaskError polished = polish(chain, Task(), target, q);
  if (isSolved(polished, kSettled)) return true;
  DescentOptions options;
  options.honour_limits = false;
  options.max_iterations = kMostSteps;
  const DescentResult descent = descend(chain, Task(), target, q, options);
  if (!isSolved(descent.error, kSolutionTolerance) || largestDifference(chain, descent.q, q) > kBeside) {
    return isSolved(polished, kSolutionTolerance);
  }
  q = descent.q;
  return true;
}

}  // namespace

std::optional<ParallelMethod> parallelMethodFor(const SerialChain& chain, const Task& task) {
  if (chain.size() != 6 || task.size() != 6 || task.rotationCount() != 3) return std::nullopt;
  std::optional<ParallelPlan> plan = ParallelPlan::compile(chain);
  if (!plan) return std::nullopt;
  return ParallelMethod{*plan, AlgebraicSolver::compile(chain)};
}

ParallelCandidates candidatesOf(const ParallelMethod& method, const SerialChain& chain, const Pose& target,
                                const VectorX& seed, bool eliminate) {
  ParallelSolutions solutions;
  method.plan.solve(target, seed.data(), solutions);
  Gathering gathering(method, chain, target, seed);
  bool refuted = false;
  for (int k = 0; k < solutions.count; ++k) {
    const PlanSolution& solution = solutions.solutions[static_cast<std::size_t>(k)];
    if (solution.free != 0) continue;
    VectorX q = jointsOf(solution, 6);
    if ((solutions.clamped >> k & 1U) != 0U) {
      if (!settle(chain, target, q)) {
        refuted = refuted || (solutions.unlikely >> k & 1U) == 0U;
        continue;
      }
    }
    gathering.addIsolated(solution, q);
  }
  if (solutions.open != 0 && !addContinua(method, chain, target, seed, solutions, gathering)) eliminate = true;
  ParallelCandidates result;
  result.complete = !refuted && !eliminate;
  result.indistinct = solutions.indistinct;
  const bool in_doubt = refuted || (solutions.clamped != 0 && solutions.loose && !gathering.coverAll());
  if ((in_doubt || eliminate) && method.algebraic) {
    AlgebraicSolutions roots;
    method.algebraic->solve(target, roots, !result.complete);
    result.complete = result.complete || roots.complete;
    for (const std::array<double, 6>& root : roots) {
      PlanSolution solution;
      solution.q = root;
      solution.sign = method.plan.signsAt(target, root.data());
      if (!gathering.covers(solution.sign)) gathering.addIsolated(solution, jointsOf(solution, 6));
    }
  }
  result.found = gathering.take();
  return result;
}

}  // namespace screwline
