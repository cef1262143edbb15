#include <algorithm>
#include <cmath>

#include "screwline/ros/checks.h"
#include "screwline/ros/conversions.h"
#include "screwline/ros/joint_values.h"
#include "screwline/ros/kinematics_server.h"

namespace screwline {
namespace ros_bridge {
namespace {

IkSolution toMessage(const SerialChain& chain, const IkAnswer& solution) {
  IkSolution message;
  message.position = arrayOf(solution.position);
  message.branch = solution.branch;
  message.position_error = solution.position_error;
  message.orientation_error = solution.orientation_error;
  message.joint_error = solution.joint_error;
  message.within_limits = solution.within_limits;
  message.distance = solution.distance;
  message.manipulability = solution.manipulability;
  message.singular = solution.singular;
  message.self_motion = rowMajor(solution.self_motion);
  for (const int joint : solution.free_joints) message.free_joints.push_back(chain.joint(joint).name);
  message.self_motion_lower = arrayOf(solution.self_motion_lower);
  message.self_motion_upper = arrayOf(solution.self_motion_upper);
  return message;
}

std::vector<int> sortedRows(const Task& task) {
  std::vector<int> rows;
  for (int i = 0; i < task.size(); ++i) rows.push_back(task.row(i));
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// The target in the frame that the request gives it in; what the task does not read is left at zero.
Pose targetInFrame(const geometry_msgs::Pose& pose, const Task& task, bool is_base) {
  Pose target;
  target.p = fromPoint(pose.position, "pose.position", readMask(task, 0, is_base));
  if (task.rotationCount() > 0) target.R = fromQuaternion(pose.orientation, "pose.orientation");
  return target;
}

double nonNegative(double value, const std::string& field) {
  requireFinite(value, field);
  if (value < 0.0)
    throw InputError(AnswerCode::kInvalidGoal, field + " is " + numberText(value) + ", it must not be below 0");
  return value;
}

AnswerCode codeOf(const IkResult& result) {
  if (result.status == IkStatus::kSolved) return AnswerCode::kSuccess;
  return result.timed_out && result.status == IkStatus::kNotFound ? AnswerCode::kTimedOut : AnswerCode::kNoIkSolution;
}

}  // namespace

std::shared_ptr<const InverseKinematics> KinematicsServer::solverFor(const Link& tip, const Task& task) const {
  const std::vector<int> rows = sortedRows(task);
  return solvers_.get({tip.name, rows}, [&] {
    const SerialChain& chain = *robot_.chain;
    const bool is_tip = tip.name == chain.tipLink();
    return InverseKinematics(is_tip ? chain : chain.withTip(tip), Task::fromRows(rows));
  });
}

IkRequest KinematicsServer::ikRequest(const ComputeIK::Request& request, const Task& task) const {
  IkRequest question;
  const std::string& frame = request.pose.header.frame_id;
  const Pose target = targetInFrame(request.pose.pose, task, frames_.isBase(frame));
  question.target = frames_.withoutConfiguration(frame, "pose.header.frame_id") * target;
  if (!request.seed.position.empty() || !request.seed.name.empty()) {
    question.seed = jointPositions(*robot_.chain, request.seed, "seed");
  }
  question.branch = request.branch;
  requireFinite(request.max_solutions, "max_solutions");
  question.max_solutions = static_cast<int>(request.max_solutions);
  question.all_turns = request.all_turns;
  question.ignore_limits = request.ignore_limits;
  requireCount(request.redundancy.size(), kMaxJoints, "redundancy");
  for (std::size_t i = 0; i < request.redundancy.size(); ++i) {
    requireFinite(request.redundancy[i], "redundancy[" + std::to_string(i) + "]");
  }
  question.redundancy = request.redundancy;
  question.timeout = nonNegative(request.timeout, "timeout");
  if (question.timeout == 0.0) question.timeout = params_.ik_timeout;
  question.rotation_weight = params_.rotation_weight;
  return question;
}

Outcome KinematicsServer::computeIk(const ComputeIK::Request& request, ComputeIK::Response& response) const {
  const SerialChain& chain = *robot_.chain;
  const Link& tip = linkOrTip(request.link_name, "link_name");
  if (tip.axis_count != static_cast<int>(chain.axes().size())) {
    throw InputError(AnswerCode::kInvalidLinkName, "link_name is " + quoted(tip.name) +
                                                       ", it must be the tip or a link rigidly beyond the last joint");
  }
  const Task task = toTask(request.task, robot_.task);
  requireMeaning(task);
  const IkRequest question = ikRequest(request, task);
  const IkResult result = solverFor(tip, task)->solve(question);
  response.joint_names = chain.jointNames();
  response.solutions.reserve(result.solutions.size());
  for (const IkAnswer& solution : result.solutions) response.solutions.push_back(toMessage(chain, solution));
  response.complete = result.complete;
  response.method = result.method;
  response.closest = toMessage(chain, result.solutions.empty() ? result.closest : result.solutions.front());
  response.distance_to_reachable =
      result.solutions.empty()
          ? result.distance_to_reachable
          : std::hypot(response.closest.position_error, params_.rotation_weight * response.closest.orientation_error);
  return {codeOf(result), result.message};
}

}  // namespace ros_bridge
}  // namespace screwline
