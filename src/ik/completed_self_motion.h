#ifndef SCREWLINE_SRC_IK_COMPLETED_SELF_MOTION_H
#define SCREWLINE_SRC_IK_COMPLETED_SELF_MOTION_H

#include <optional>
#include <string>
#include <vector>

#include "completed_chain.h"
#include "screwline/ik/redundant/self_motion_solver.h"
#include "solution_builder.h"

namespace screwline {

/// Self-motions of a chain with one joint more than its task has rows, where the task leaves open what joints can be
/// added for: six joints and the direction of a tool, or any height. With them it is a chain of seven joints and a
/// whole pose, singular where the chain is for its task.
class CompletedSelfMotion {
 public:
  /// Empty where the completed chain has not seven joints. Keeps copies.
  static std::optional<CompletedSelfMotion> compile(const SerialChain& chain, const Task& task);

  const SelfMotionSolver& solver() const { return solver_; }  ///< Of the completed chain.
  const std::string& method() const { return method_; }

  /// Every self-motion as an answer of the chain, as confirmedOf().
  std::vector<IkAnswer> answers(const IkRequest& request, const SolutionBuilder& builder, IkResult& result) const;

 private:
  CompletedSelfMotion(const SerialChain& chain, const Task& task, CompletedChain completed, SelfMotionSolver solver);

  std::optional<IkAnswer> answerOf(const SelfMotionAnswer& whole, const Pose& target,
                                   const SolutionBuilder& builder) const;
  VectorX ownOf(const VectorX& whole) const;
  VectorX wholeOf(const VectorX& own, const Pose& target) const;

  SerialChain chain_;
  Task task_;
  CompletedChain completed_;
  SelfMotionSolver solver_;
  std::string method_;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_COMPLETED_SELF_MOTION_H
