#include "completed_self_motion.h"

#include <Eigen/QR>
#include <utility>

#include "neighbour_sheet.h"
#include "screwline/kinematics/jacobian.h"
#include "self_motion_answers.h"

namespace screwline {
namespace {

constexpr int kSteps = 3;  // Of Newton's method: the second corrects rounding, where slides stand before a turn.

}  // namespace

CompletedSelfMotion::CompletedSelfMotion(const SerialChain& chain, const Task& task, CompletedChain completed,
                                         SelfMotionSolver solver)
    : chain_(chain),
      task_(task),
      completed_(std::move(completed)),
      solver_(std::move(solver)),
      method_(solver_.method() + "; what the task leaves open is a joint more") {}

std::optional<CompletedSelfMotion> CompletedSelfMotion::compile(const SerialChain& chain, const Task& task) {
  std::optional<CompletedChain> completed = completionWithOneToSpare(chain, task);
  if (!completed) return std::nullopt;
  std::optional<SelfMotionSolver> solver = SelfMotionSolver::compile(completed->chain);
  if (!solver) return std::nullopt;
  return CompletedSelfMotion(chain, task, std::move(*completed), std::move(*solver));
}

VectorX CompletedSelfMotion::ownOf(const VectorX& whole) const {
  return whole.segment(completed_.first, completed_.own);
}

/// With the added joints where they bring the tip nearest to the target: a seed that solves the task lies on a curve.
/// The turn's angle and the slides' ways are what Newton's first step takes them for.
VectorX CompletedSelfMotion::wholeOf(const VectorX& own, const Pose& target) const {
  VectorX q = VectorX::Zero(completed_.chain.size());
  q.segment(completed_.first, completed_.own) = own;
  Matrix6X J;
  for (int k = 0; k < kSteps; ++k) {
    const TaskError error = taskError(Task(), target, geometricJacobian(completed_.chain, q, J));
    J.middleCols(completed_.first, completed_.own).setZero();
    q += J.completeOrthogonalDecomposition().solve(error.twist);
  }
  return q;
}

std::vector<IkAnswer> CompletedSelfMotion::answers(const IkRequest& request, const SolutionBuilder& builder,
                                                   IkResult& result) const {
  SelfMotionQuestion question = questionOf(request);
  question.seed = wholeOf(builder.seed(), request.target);
  question.counts.setZero();
  question.counts.segment(completed_.first, completed_.own).setOnes();
  const auto confirm = [&](const SelfMotionAnswer& whole) { return answerOf(whole, request.target, builder); };
  return confirmedOf(solver_.answer(question), confirm, result);
}

/// Sheets are described anew: in distances between their members all joints have counted.
std::optional<IkAnswer> CompletedSelfMotion::answerOf(const SelfMotionAnswer& whole, const Pose& target,
                                                      const SolutionBuilder& builder) const {
  if (!whole.traced) {
    Candidate candidate = unnamed(ownOf(whole.q));
    candidate.branch = whole.branch;
    const auto dimension = static_cast<std::size_t>(whole.self_motion.rows());
    if (dimension > 0) openByNeighbours(chain_, task_, target, dimension, candidate);
    return builder.build(std::move(candidate));
  }
  SelfMotionAnswer own = whole;
  own.q = ownOf(whole.q);
  own.self_motion = ownOf(whole.self_motion.row(0)).normalized().transpose();
  own.free_joints.clear();
  std::vector<double> lower;
  std::vector<double> upper;
  for (std::size_t i = 0; i < whole.free_joints.size(); ++i) {
    const int joint = whole.free_joints[i] - completed_.first;
    if (joint < 0 || joint >= completed_.own) continue;
    own.free_joints.push_back(joint);
    lower.push_back(whole.lower[static_cast<Eigen::Index>(i)]);
    upper.push_back(whole.upper[static_cast<Eigen::Index>(i)]);
  }
  own.lower = Eigen::Map<VectorX>(lower.data(), static_cast<Eigen::Index>(lower.size()));
  own.upper = Eigen::Map<VectorX>(upper.data(), static_cast<Eigen::Index>(upper.size()));
  return confirmed(own, -1, builder);
}

}  // namespace screwline
