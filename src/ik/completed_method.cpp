#include "completed_method.h"

#include <algorithm>
#include <cmath>

#include "neighbour_sheet.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr double kAlmostLocked = 1e-3;  ///< [rad] What a double root may leave of a locked joint's zero.

/// Empty where a slide is free: its values do not come round.
std::optional<WayRound> wayRound(const SerialChain& chain, const Candidate& whole) {
  if (whole.round) return whole.round;
  const int free = whole.free.front();
  if (!chain.joint(free).isRevolute()) return std::nullopt;
  const auto at = [member_of = whole.member, free](double value, const MemberVector& near, MemberVector& member) {
    VectorX preferred = near;
    preferred[free] = value;
    VectorX found;
    if (!member_of(preferred, found)) return false;
    member = found;
    return true;
  };
  return WayRound{at, whole.q[free], kTwoPi};
}

}  // namespace

CompletedMethod::CompletedMethod(const SerialChain& chain, const Task& task, CompletedChain completed)
    : chain_(chain), task_(task), completed_(std::move(completed)), rejects_(completed_.locked > 0) {}

bool CompletedMethod::compileExact(bool closed_form) {
  const Task whole = completed_.rows;
  if (!closed_form) {
    if (whole.size() == 6) algebraic_ = AlgebraicSolver::compile(completed_.chain);
    if (algebraic_) method_ = algebraic_->method();
    return algebraic_.has_value();
  }
  plan_ = planFor(completed_.chain, whole);
  if (plan_) {
    rejects_ = rejects_ || plan_->task.size() < whole.size();
    method_ = "closed form: " + plan_->plan.method();
    return true;
  }
  parallel_ = parallelMethodFor(completed_.chain, whole);
  if (parallel_) method_ = "closed form: " + parallel_->plan.method();
  return parallel_.has_value();
}

std::optional<CompletedMethod> CompletedMethod::compile(const SerialChain& chain, const Task& task) {
  const std::vector<CompletedChain> ways = completions(chain, task);
  for (bool closed_form : {true, false}) {
    for (const CompletedChain& way : ways) {
      CompletedMethod method(chain, task, way);
      if (!method.compileExact(closed_form)) continue;
      if (way.turnsByItself()) {
        method.method_ += "; " + chain.joint(way.turn).name + " turns the tool about its direction";
      } else if (way.turn >= 0) {
        method.method_ += "; the tool's turn about its direction is one joint more";
      }
      if (way.first > 0) method.method_ += "; what the task leaves open of the base's rows are joints in front";
      if (method.rejects_) method.method_ += "; the rows beyond the joints are checked";
      return method;
    }
  }
  return std::nullopt;
}

const std::vector<BranchPart>* CompletedMethod::branchParts() const {
  if (plan_) return &plan_->plan.branchParts();
  return parallel_ ? &parallel_->plan.branchParts() : nullptr;
}

std::vector<Candidate> CompletedMethod::wholeCandidates(const Pose& target, const VectorX& seed, bool doubted,
                                                        bool& complete) const {
  if (plan_) {
    complete = true;
    return candidatesOf(*plan_, completed_.chain, target, seed);
  }
  if (parallel_) {
    ParallelCandidates found = candidatesOf(*parallel_, completed_.chain, target, seed, doubted);
    complete = found.complete;
    return std::move(found.found);
  }
  return rootsOf(*algebraic_, target, complete);
}

std::optional<InverseOutline> CompletedMethod::outline() const {
  if (rejects_ || completed_.turn < 0 || (!plan_ && !parallel_)) return std::nullopt;
  InverseOutline outline = plan_ ? plan_->plan.outline() : parallel_->plan.outline();
  (completed_.turnsByItself() ? outline.open_joint : outline.tool_turn) =
      completed_.turnsByItself() ? completed_.turn : task_.pointingAxis();
  return outline;
}

bool CompletedMethod::isLocked(const VectorX& q) const {
  for (int i = 0; i < completed_.locked; ++i) {
    if (std::abs(wrapAngle(q[completed_.first + completed_.own + i])) > kAlmostLocked) return false;
  }
  return true;
}

std::vector<Candidate> CompletedMethod::candidates(const Pose& target, const VectorX& seed, bool doubted,
                                                   bool& complete) const {
  VectorX whole_seed = VectorX::Zero(completed_.chain.size());
  whole_seed.segment(completed_.first, completed_.own) = seed;
  std::vector<Candidate> result;
  for (const Candidate& whole : wholeCandidates(target, whole_seed, doubted, complete)) {
    // Of a continuum that needs joints to be unlocked, some members may be solutions: one start for these.
    if (rejects_ && !whole.free.empty()) complete = false;
    if (whole.free.empty() && !isLocked(whole.q)) continue;
    VectorX q = whole.q.segment(completed_.first, completed_.own);
    if (rejects_) {
      const TaskError error = polish(chain_, task_, target, q);
      if (error.position > kSolutionTolerance || error.orientation > kSolutionTolerance) continue;
    }
    Candidate candidate = candidateAt(q);
    candidate.branch = whole.branch;
    candidate.merged = whole.merged;
    if (!rejects_ && !whole.free.empty()) openSheet(whole, target, candidate);
    result.push_back(std::move(candidate));
  }
  return result;
}

/// Makes of a member of a continuum the continuum, by solutions next to solutions.
void CompletedMethod::openSheet(const Candidate& whole, const Pose& target, Candidate& candidate) const {
  const std::size_t dimension = whole.free.size() + (completed_.turnsByItself() ? 1 : 0);
  candidate.describe = nullptr;
  openByNeighbours(chain_, task_, target, dimension, candidate);
  if (dimension == 1) openRound(whole, candidate);
}

/// On a continuum of one dimension each joint of the chain may turn back: round it leads what leads the completed
/// chain.
void CompletedMethod::openRound(const Candidate& whole, Candidate& candidate) const {
  std::optional<WayRound> round = wayRound(completed_.chain, whole);
  if (!round) return;
  candidate.round = round;
  candidate.round->at = [this, at = round->at](double value, const MemberVector& near, MemberVector& q) {
    MemberVector member = MemberVector::Zero(completed_.chain.size());
    member.segment(completed_.first, completed_.own) = near;
    if (!at(value, member, member)) return false;
    q = member.segment(completed_.first, completed_.own);
    bringNear(chain_, near, q);
    return true;
  };
}

Candidate CompletedMethod::candidateAt(const VectorX& q) const {
  Candidate candidate = unnamed(q);
  if (!completed_.turnsByItself()) return candidate;
  candidate.free = {completed_.turn};
  candidate.describe = [this, q](const VectorX& seed, bool ignore_limits) { return circle(q, seed, ignore_limits); };
  return candidate;
}

Continuum CompletedMethod::circle(const VectorX& q, const VectorX& seed, bool ignore_limits) const {
  const int turn = completed_.turn;
  const JointLimits& limits = chain_.joint(turn).limits;
  Continuum continuum;
  continuum.nearest = nearestTurns(chain_, q, seed);
  continuum.nearest[turn] = ignore_limits ? seed[turn] : std::clamp(seed[turn], limits.lower, limits.upper);
  continuum.directions = MatrixX::Zero(1, chain_.size());
  continuum.directions(0, turn) = 1.0;
  continuum.free_joints = {turn};
  const double value = continuum.nearest[turn];
  // A full turn to both sides, as for any continuum.
  continuum.lower = VectorX::Constant(1, std::min(value, std::max(limits.lower, value - kTwoPi)));
  continuum.upper = VectorX::Constant(1, std::max(value, std::min(limits.upper, value + kTwoPi)));
  return continuum;
}

}  // namespace screwline
