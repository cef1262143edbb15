#include "self_motion_answers.h"

namespace screwline {
namespace {

IkAnswer answerOf(const SelfMotionAnswer& found, int held, const SolutionBuilder& builder) {
  IkAnswer answer = builder.describe(found.q, held);
  answer.branch = found.branch;
  answer.distance = found.distance;
  answer.within_limits = found.within_limits;
  answer.singular = answer.singular || found.singular;
  if (found.self_motion.rows() == 0) return answer;
  answer.self_motion = found.self_motion;
  answer.free_joints = found.free_joints;
  answer.self_motion_lower = found.lower;
  answer.self_motion_upper = found.upper;
  return answer;
}

}  // namespace

std::vector<IkAnswer> selfMotionAnswers(const SelfMotionSolver& solver, const IkRequest& request,
                                        const SolutionBuilder& builder, IkResult& result) {
  const SelfMotionQuestion question{request.target, request.seed, request.ignore_limits, request.timeout};
  const bool given = !request.redundancy.empty();
  const int held = given ? solver.parameterJoint() : -1;
  const SelfMotionAnswers found =
      given ? solver.answerAt(question, request.redundancy.front()) : solver.answer(question);
  result.outside_limits = found.outside_limits;
  result.complete = found.complete;
  std::vector<IkAnswer> answers;
  for (const SelfMotionAnswer& one : found.answers) {
    answers.push_back(answerOf(one, held, builder));
    const IkAnswer& answer = answers.back();
    if (answer.position_error <= kSolutionTolerance && answer.orientation_error <= kSolutionTolerance) continue;
    answers.pop_back();
    result.complete = false;
  }
  return answers;
}

}  // namespace screwline
