#ifndef SCREWLINE_SRC_IK_COMPLETED_METHOD_H
#define SCREWLINE_SRC_IK_COMPLETED_METHOD_H

#include <optional>
#include <string>
#include <vector>

#include "completed_chain.h"
#include "parallel_candidates.h"
#include "plan_candidates.h"

namespace screwline {

/// Inverse kinematics of a task that asks for less than a whole pose (the direction of one axis of the tool), or of a
/// chain that has fewer joints than the pose has rows: by an exact method for the completed chain. Any turn about the
/// pointing axis solves the task, so the target's own orientation is as good as any other; of the completed chain's
/// solutions those count whose locked joints are at zero.
class CompletedMethod {
 public:
  /// Empty where no completion has an exact method. Keeps copies.
  static std::optional<CompletedMethod> compile(const SerialChain& chain, const Task& task);

  /// All solutions, as candidates for the chain and the task; verified where some of the completed chain's are none.
  /// The method must outlive them. @param doubted asks slower ways as well. `complete` is false where some may be
  /// missing.
  std::vector<Candidate> candidates(const Pose& target, const VectorX& seed, bool doubted, bool& complete) const;

  /// A solution found in another way: where a joint of the chain turns the tool without any effect, the circle of all
  /// its values.
  Candidate candidateAt(const VectorX& q) const;

  const std::string& method() const { return method_; }
  const std::vector<BranchPart>* branchParts() const;
  /// Of the closed form, where the tool's turn is all that is added, if anything; else empty.
  std::optional<InverseOutline> outline() const;

 private:
  CompletedMethod(const SerialChain& chain, const Task& task, CompletedChain completed);

  bool compileExact(bool closed_form);
  std::vector<Candidate> wholeCandidates(const Pose& target, const VectorX& seed, bool doubted, bool& complete) const;
  bool isLocked(const VectorX& q) const;
  void openSheet(const Candidate& whole, const Pose& target, Candidate& candidate) const;
  void openRound(const Candidate& whole, Candidate& candidate) const;
  Continuum circle(const VectorX& q, const VectorX& seed, bool ignore_limits) const;

  SerialChain chain_;
  Task task_;
  CompletedChain completed_;
  bool rejects_ = false;  ///< Solutions of the completed chain may be none of the chain's.
  // One of these.
  std::optional<TaskPlan> plan_;
  std::optional<ParallelMethod> parallel_;
  std::optional<AlgebraicSolver> algebraic_;
  std::string method_;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_COMPLETED_METHOD_H
