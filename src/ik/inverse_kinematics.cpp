#include "screwline/ik/inverse_kinematics.h"

#include <algorithm>
#include <cmath>

#include "account.h"
#include "almost_singular.h"
#include "completed_method.h"
#include "completed_self_motion.h"
#include "ik_request_check.h"
#include "nearly_ideal.h"
#include "parallel_candidates.h"
#include "plan_candidates.h"
#include "screwline/exception.h"
#include "screwline/ik/algebraic/algebraic_solver.h"
#include "screwline/ik/branch_name.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/kinematics/singularity.h"
#include "searched_continua.h"
#include "self_motion_answers.h"
#include "solution_builder.h"
#include "turns.h"

namespace screwline {
namespace {

constexpr int kClosestRestarts = 256;  // Starts for the best reachable configuration: fewer were seen to miss it.
constexpr int kDoubtRestarts = 16;
constexpr double kAlmostSingular = 1e-3;  // Manipulability, lengths in the chain's, below which solutions may meet.

/// Not special in any way.
VectorX someConfiguration(const SerialChain& chain) {
  VectorX q(chain.size());
  for (Eigen::Index i = 0; i < q.size(); ++i)
    q[i] = 0.3 + 0.37 * static_cast<double>(i) + 0.11 * std::sin(7.0 * static_cast<double>(i));
  return q;
}

bool isNearer(const IkAnswer& a, const IkAnswer& b) {
  if (a.distance != b.distance) return a.distance < b.distance;
  return std::lexicographical_compare(a.position.data(), a.position.data() + a.position.size(), b.position.data(),
                                      b.position.data() + b.position.size());
}

}  // namespace

struct InverseKinematics::Implementation {
  Implementation(const SerialChain& chain_in, const Task& task_in)
      : chain(chain_in),
        task(task_in),
        plan(planFor(chain, task.rotationCount() == 3 ? wholeRowsOf(task) : task)),
        meet_below(kAlmostSingular * std::pow(chain.characteristicLength(), task.translationCount())) {
    if (plan) {
      method = "closed form: " + plan->plan.method();
      if (plan->task.size() < task.size()) method += "; the other rows of the task are checked";
      return;
    }
    parallel = parallelMethodFor(chain, task);
    if (parallel) {
      meet_below.reset();
      method = "closed form: " + parallel->plan.method();
      return;
    }
    completed = CompletedMethod::compile(chain, task);
    if (completed) {
      method = completed->method();
      return;
    }
    // Both are empty where the chain has another number of joints.
    if (task.size() == 6) {
      algebraic = AlgebraicSolver::compile(chain);
      redundant = SelfMotionSolver::compile(chain);
    }
    if (algebraic) nearly_ideal = NearlyIdeal::compile(chain, task);
    open_self_motion = CompletedSelfMotion::compile(chain, task);
    method = algebraic          ? algebraic->method()
             : redundant        ? redundant->method()
             : open_self_motion ? open_self_motion->method()
                                : "numerical search (Levenberg-Marquardt from many starts)";
    moves_everywhere = taskRank(taskJacobian(chain, someConfiguration(chain), task)).rank < chain.size();
  }

  /// Of the chain, or of the completed one; null where there is none.
  const SelfMotionSolver* selfMotions() const {
    return redundant ? &*redundant : (open_self_motion ? &open_self_motion->solver() : nullptr);
  }
  bool isExact() const {
    return plan || parallel || completed || algebraic || (selfMotions() != nullptr && selfMotions()->oneGiven());
  }

  std::vector<Candidate> candidates(const IkRequest& request, const SolutionBuilder& builder, bool doubted,
                                    IkResult& result) const;
  std::vector<Candidate> withSearched(const IkRequest& request, const SolutionBuilder& builder,
                                      std::vector<Candidate> found, IkResult& result) const;
  bool keep(const IkRequest& request, std::vector<Candidate> candidates, const SolutionBuilder& builder,
            IkResult& result) const;
  bool gather(const IkRequest& request, const SolutionBuilder& builder, IkResult& result) const;
  void admit(const IkRequest& request, IkAnswer solution, const SolutionBuilder& builder, IkResult& result) const;
  void dropRepeated(const IkRequest& request, IkResult& result) const;
  void doubtUnreachable(const IkRequest& request, const SolutionBuilder& builder, IkResult& result) const;
  void admitSeed(const IkRequest& request, const SolutionBuilder& builder, IkResult& result) const;
  void conclude(const IkRequest& request, const SolutionBuilder& builder, IkResult& result) const;
  std::string doubt(bool indistinct) const;

  SerialChain chain;
  Task task;
  // At most one of these; none: searched.
  std::optional<TaskPlan> plan;
  std::optional<ParallelMethod> parallel;
  std::optional<CompletedMethod> completed;
  std::optional<AlgebraicSolver> algebraic;
  std::optional<NearlyIdeal> nearly_ideal;  ///< Beside `algebraic`.
  std::optional<SelfMotionSolver> redundant;
  std::optional<CompletedSelfMotion> open_self_motion;
  std::string method;
  bool moves_everywhere = false;     ///< Every solution of a searched chain is a member of a continuum.
  std::optional<double> meet_below;  ///< Manipulability below which solutions may meet that are not both found.
};

std::vector<Candidate> InverseKinematics::Implementation::candidates(const IkRequest& request,
                                                                     const SolutionBuilder& builder, bool doubted,
                                                                     IkResult& result) const {
  if (plan) {
    std::vector<Candidate> found = candidatesOf(*plan, chain, request.target, builder.seed());
    result.complete =
        plan->task.size() == task.size() ||
        std::all_of(found.begin(), found.end(), [](const Candidate& candidate) { return candidate.free.empty(); });
    if (result.complete) return found;
    // Rows beyond the plan's are met by some members of a continuum at most: these are searched.
    for (Candidate& candidate : found) candidate.free.clear();
    return found.empty() ? found : withSearched(request, builder, std::move(found), result);
  }
  if (parallel) {
    ParallelCandidates found = candidatesOf(*parallel, chain, request.target, builder.seed(), doubted);
    result.complete = found.complete;
    result.indistinct = found.indistinct;
    return found.found;
  }
  std::vector<Candidate> found;
  if (completed) {
    found = completed->candidates(request.target, builder.seed(), doubted, result.complete);
    return result.complete ? found : withSearched(request, builder, std::move(found), result);
  }
  if (algebraic) {
    found = rootsOf(*algebraic, request.target, result.complete);
    if (nearly_ideal && !nearly_ideal->addMissing(request.target, builder.seed(), request.timeout, found)) {
      result.complete = false;
    }
    if (result.complete) return found;  // Else the search may add to them.
  }
  return withSearched(request, builder, std::move(found), result);
}

std::vector<Candidate> InverseKinematics::Implementation::withSearched(const IkRequest& request,
                                                                       const SolutionBuilder& builder,
                                                                       std::vector<Candidate> found,
                                                                       IkResult& result) const {
  SearchOptions options;
  options.descent.honour_limits = !request.ignore_limits;
  options.descent.rotation_weight = request.rotation_weight;
  options.timeout = request.timeout;
  options.max_solutions = request.max_solutions;
  if (moves_everywhere && (request.max_solutions == 0 || request.max_solutions > kMostMembers)) {
    options.max_solutions = kMostMembers;  // All that is met are members of continua.
  }
  const SearchResult search_result = search(chain, task, request.target, {builder.seed()}, options);
  result.timed_out = search_result.timed_out;
  for (const VectorX& q : search_result.solutions) {
    found.push_back(completed ? completed->candidateAt(q) : unnamed(q));
  }
  return found;
}

/// False where a candidate is none that should be one.
bool InverseKinematics::Implementation::keep(const IkRequest& request, std::vector<Candidate> candidates,
                                             const SolutionBuilder& builder, IkResult& result) const {
  bool all = true;
  std::vector<IkAnswer> answers;
  answers.reserve(candidates.size());
  for (Candidate& candidate : candidates) {
    std::optional<IkAnswer> answer = builder.build(std::move(candidate));
    if (!answer) {
      // Rows that the plan does not know reject solutions rightly; its own rows never should.
      if (algebraic || parallel || completed || (plan && plan->task.size() == task.size())) all = false;
      continue;
    }
    answers.push_back(std::move(*answer));
  }
  if (!isExact() || !result.complete) {
    answers = joinSearchedContinua(chain, task, request, builder, std::move(answers));
  }
  for (IkAnswer& answer : answers) {
    if (chain.size() > task.size() && answer.self_motion.rows() == 0) describeRedundancy(chain, task, answer);
  }
  if (isExact() && chain.size() == task.size()) {
    if (!completeAlmostSingular(chain, task, request.target, meet_below, builder, answers)) result.indistinct = true;
    all = all && !result.indistinct;
  }
  for (IkAnswer& answer : answers) admit(request, std::move(answer), builder, result);
  return all;
}

/// Refinement has brought candidates together that were apart, and pieces of one curve may have the same nearest
/// member. Turns are told apart only where they were asked for.
void InverseKinematics::Implementation::dropRepeated(const IkRequest& request, IkResult& result) const {
  std::vector<IkAnswer> distinct;
  for (IkAnswer& answer : result.solutions) {
    const auto known = std::find_if(distinct.begin(), distinct.end(), [&](const IkAnswer& other) {
      return request.all_turns ? (other.position - answer.position).cwiseAbs().maxCoeff() <= kSameSolution
                               : isSameConfiguration(chain, other.position, answer.position);
    });
    if (known == distinct.end()) {
      distinct.push_back(std::move(answer));
    } else if (known->self_motion.rows() < answer.self_motion.rows()) {
      *known = toldBy(std::move(answer), *known);
    }
  }
  result.solutions = std::move(distinct);
}

/// Into the list, in every turn asked for, unless limits or the branch forbid it.
void InverseKinematics::Implementation::admit(const IkRequest& request, IkAnswer solution,
                                              const SolutionBuilder& builder, IkResult& result) const {
  if (!solution.within_limits && !request.ignore_limits) {
    ++result.outside_limits;
    return;
  }
  if (!request.branch.empty() && !matchesBranch(solution.branch, request.branch)) return;
  if (!request.all_turns) {
    result.solutions.push_back(std::move(solution));
    return;
  }
  for (const VectorX& q : allTurns(chain, solution.position, request.ignore_limits, kSolutionTolerance)) {
    IkAnswer turned = solution;
    turned.position = q;
    turned.distance = (q - builder.seed()).norm();
    result.solutions.push_back(turned);
  }
}

/// A method whose geometry breaks down at this very pose has no candidates, or none that solve it: a few descents tell
/// it from a pose out of reach.
void InverseKinematics::Implementation::doubtUnreachable(const IkRequest& request, const SolutionBuilder& builder,
                                                         IkResult& result) const {
  SearchOptions options;
  options.restarts = kDoubtRestarts;
  options.max_solutions = 1;
  options.timeout = request.timeout;
  options.descent.honour_limits = false;
  for (const VectorX& q : search(chain, task, request.target, {builder.seed()}, options).solutions) {
    result.complete = false;
    if (std::optional<IkAnswer> solution = builder.build(unnamed(q))) {
      admit(request, std::move(*solution), builder, result);
    }
  }
}

/// A seed that solves the pose is the answer nearest to itself: where rounding at a double root moved it, also out of
/// the limits, it is put back.
void InverseKinematics::Implementation::admitSeed(const IkRequest& request, const SolutionBuilder& builder,
                                                  IkResult& result) const {
  if (!builder.seedSolves()) return;
  if (result.solutions.empty()) {
    if (std::optional<IkAnswer> seed = builder.build(unnamed(builder.seed()))) {
      if (chain.size() > task.size()) describeRedundancy(chain, task, *seed);
      admit(request, std::move(*seed), builder, result);
    }
    return;
  }
  IkAnswer& nearest = *std::min_element(result.solutions.begin(), result.solutions.end(), isNearer);
  if (nearest.distance <= 1e-12) return;
  const IkAnswer seed = toldBy(nearest, builder.describe(builder.seed()));
  const bool same =
      (nearest.position - seed.position).cwiseAbs().maxCoeff() <= kSameSolution || nearest.self_motion.rows() > 0;
  if (same) {
    nearest = seed;
  } else {
    result.solutions.push_back(seed);
  }
}

/// Why a list that is not complete is not.
std::string InverseKinematics::Implementation::doubt(bool indistinct) const {
  if (indistinct) return "rounding hides how a solution differs from others along a curve";
  if (plan) return "a continuum was met whose members had to be searched";
  if (algebraic || parallel || completed) return "the pose is at or near a continuum or a multiple solution";
  return selfMotions() != nullptr ? "self-motions were found by numerical search or meet" : "found by numerical search";
}

void InverseKinematics::Implementation::conclude(const IkRequest& request, const SolutionBuilder& builder,
                                                 IkResult& result) const {
  std::sort(result.solutions.begin(), result.solutions.end(), isNearer);
  dropRepeated(request, result);
  const auto limit = static_cast<std::size_t>(request.max_solutions);
  if (limit > 0 && result.solutions.size() > limit) {
    result.left_out = static_cast<int>(result.solutions.size() - limit);
    result.solutions.resize(limit);
    result.complete = false;
  }
  if (!result.solutions.empty()) {
    result.status = IkStatus::kSolved;
    return;
  }
  if (!request.find_closest) return;
  SearchOptions options;
  options.descent.honour_limits = !request.ignore_limits;
  options.descent.rotation_weight = request.rotation_weight;
  options.timeout = request.timeout;
  options.restarts = kClosestRestarts;
  const DescentResult closest = closestReachable(chain, task, request.target, {builder.seed()}, options);
  result.closest = builder.describe(closest.q);
  result.distance_to_reachable =
      std::hypot(result.closest.position_error, request.rotation_weight * result.closest.orientation_error);
}

InverseKinematics::InverseKinematics(const SerialChain& chain, const Task& task)
    : implementation_(std::make_unique<const Implementation>(chain, task)) {}
InverseKinematics::~InverseKinematics() = default;
InverseKinematics::InverseKinematics(InverseKinematics&&) noexcept = default;

const SerialChain& InverseKinematics::chain() const {
  return implementation_->chain;
}
const Task& InverseKinematics::task() const {
  return implementation_->task;
}
const std::string& InverseKinematics::method() const {
  return implementation_->method;
}
bool InverseKinematics::complete() const {
  return implementation_->isExact();
}

std::vector<std::string> InverseKinematics::branches() const {
  const Implementation& self = *implementation_;
  if (self.plan) return branchNamesOf(self.plan->plan.branchParts());
  if (self.parallel) return branchNamesOf(self.parallel->plan.branchParts());
  if (self.completed && self.completed->branchParts() != nullptr) return branchNamesOf(*self.completed->branchParts());
  const SelfMotionSolver* motions = self.selfMotions();
  const bool named = motions != nullptr && motions->oneGiven();
  return named ? branchNamesOf(motions->oneGiven()->others().branchParts()) : std::vector<std::string>();
}

std::optional<InverseOutline> InverseKinematics::outline() const {
  const Implementation& self = *implementation_;
  if (self.plan && self.plan->task.size() == self.task.size()) return self.plan->plan.outline();
  if (self.parallel) return self.parallel->plan.outline();
  if (self.completed) return self.completed->outline();
  return self.redundant && self.redundant->oneGiven() ? self.redundant->oneGiven()->outline() : std::nullopt;
}

/// Candidates into the list; false where there was none.
bool InverseKinematics::Implementation::gather(const IkRequest& request, const SolutionBuilder& builder,
                                               IkResult& result) const {
  std::vector<Candidate> found = joinEqual(chain, candidates(request, builder, false, result));
  bool any = !found.empty();
  bool all = keep(request, std::move(found), builder, result);
  if (!all && (!result.indistinct || result.solutions.empty()) && (parallel || completed)) {
    result.solutions.clear();
    result.outside_limits = 0;
    found = joinEqual(chain, candidates(request, builder, true, result));
    any = !found.empty();
    all = keep(request, std::move(found), builder, result) || result.complete;
  }
  if (!all) result.complete = false;
  return any;
}

IkResult InverseKinematics::solve(const IkRequest& request) const {
  const Implementation& self = *implementation_;
  const int parameter = self.redundant ? self.redundant->parameterJoint() : -1;
  checkRequest(self.chain, self.task, request, request.branch.empty() ? std::vector<std::string>() : branches(),
               parameter);
  const SolutionBuilder builder(self.chain, self.task, request);
  IkResult result;
  result.method = self.method;
  bool any = false;
  if (self.selfMotions() != nullptr) {
    std::vector<IkAnswer> answers = self.redundant ? selfMotionAnswers(*self.redundant, request, builder, result)
                                                   : self.open_self_motion->answers(request, builder, result);
    for (IkAnswer& answer : answers) self.admit(request, std::move(answer), builder, result);
    any = !answers.empty();
  }
  // No curve can be followed from what is singular: a search may still meet its solutions.
  const bool curves_say_nothing = result.solutions.empty() && !result.complete && request.redundancy.empty();
  if (self.selfMotions() == nullptr || curves_say_nothing) any = self.gather(request, builder, result) || any;
  self.admitSeed(request, builder, result);
  const bool other_branch = !request.branch.empty() && any;
  const auto exists = [&result] { return result.outside_limits > 0 || !result.solutions.empty(); };
  if (result.complete && !other_branch && !exists()) self.doubtUnreachable(request, builder, result);
  self.conclude(request, builder, result);
  if (result.solutions.empty()) {
    result.status = exists() || other_branch ? IkStatus::kOutsideLimits
                                             : (result.complete ? IkStatus::kUnreachable : IkStatus::kNotFound);
  }
  result.message = accountOf(request, result, self.doubt(result.indistinct));
  return result;
}

}  // namespace screwline
