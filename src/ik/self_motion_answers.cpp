#include "self_motion_answers.h"

#include <utility>

namespace screwline {
std::optional<IkAnswer> confirmed(const SelfMotionAnswer& found, int held, const SolutionBuilder& builder) {
  IkAnswer answer = builder.describe(found.q, held);
  if (answer.position_error > kSolutionTolerance || answer.orientation_error > kSolutionTolerance) return std::nullopt;
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

SelfMotionQuestion questionOf(const IkRequest& request) {
  SelfMotionQuestion question;
  question.target = request.target;
  question.seed = request.seed;
  question.ignore_limits = request.ignore_limits;
  question.timeout = request.timeout;
  return question;
}

std::vector<IkAnswer> confirmedOf(const SelfMotionAnswers& found, const Confirm& confirm, IkResult& result) {
  result.outside_limits = found.outside_limits;
  result.complete = found.complete;
  std::vector<IkAnswer> answers;
  for (const SelfMotionAnswer& one : found.answers) {
    std::optional<IkAnswer> answer = confirm(one);
    if (answer) {
      answers.push_back(std::move(*answer));
    } else {
      result.complete = false;
    }
  }
  return answers;
}

std::vector<IkAnswer> selfMotionAnswers(const SelfMotionSolver& solver, const IkRequest& request,
                                        const SolutionBuilder& builder, IkResult& result) {
  const bool given = !request.redundancy.empty();
  const int held = given ? solver.parameterJoint() : -1;
  const SelfMotionQuestion question = questionOf(request);
  const SelfMotionAnswers found =
      given ? solver.answerAt(question, request.redundancy.front()) : solver.answer(question);
  return confirmedOf(
      found, [&](const SelfMotionAnswer& one) { return confirmed(one, held, builder); }, result);
}

}  // namespace screwline
