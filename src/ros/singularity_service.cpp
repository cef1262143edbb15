#include <algorithm>
#include <limits>

#include "screwline/ros/conversions.h"
#include "screwline/ros/joint_values.h"
#include "screwline/ros/kinematics_server.h"

namespace screwline {
namespace ros_bridge {
namespace {

SingularityCondition toMessage(const SingularCondition& condition) {
  SingularityCondition message;
  message.name = condition.name;
  message.expression = condition.expression;
  message.latex = condition.latex;
  message.value = condition.value;
  message.active = condition.active;
  message.meaning = condition.meaning;
  return message;
}

std::vector<int> rowsOf(const Task& task) {
  std::vector<int> rows;
  for (int i = 0; i < task.size(); ++i) rows.push_back(task.row(i));
  return rows;
}

void fillRank(const TaskRank& rank, AnalyzeSingularity::Response& response) {
  response.rank = static_cast<unsigned>(rank.rank);
  response.singular_values = arrayOf(rank.singular_values);
  response.lost_directions = rowMajor(rank.lost_directions);
  response.self_motions = rowMajor(rank.self_motions);
}

}  // namespace

std::shared_ptr<const std::vector<SingularityFactor>> KinematicsServer::factorsFor(const Task& task) const {
  const std::vector<SingularityFactor>* derived = conditions_ && task == robot_.task ? conditions_->find() : nullptr;
  // They live as long as the server: nobody owns this pointer.
  if (derived != nullptr) return {std::shared_ptr<void>(), derived};
  return factors_.get(rowsOf(task), [&] { return factorsOf(*robot_.chain, task); });
}

Outcome KinematicsServer::analyze(const AnalyzeSingularity::Request& request,
                                  AnalyzeSingularity::Response& response) const {
  const SerialChain& chain = *robot_.chain;
  const VectorX q = jointPositions(chain, request.joint_state);
  const Task task = toTask(request.task, robot_.task);
  const SingularityAnalysis analysis = analyzeSingularity(chain, q, task, *factorsFor(task));
  response.joint_names = chain.jointNames();
  response.task = task.names();
  response.singular = analysis.singular;
  fillRank(analysis.rank, response);
  response.manipulability = analysis.manipulability;
  // The core's number for "no bound" stands for what the answer documents as infinite.
  const bool unbounded = analysis.condition_number >= kMaxCondition;
  response.condition_number = unbounded ? std::numeric_limits<double>::infinity() : analysis.condition_number;
  response.determinant = analysis.determinant;
  std::transform(analysis.conditions.begin(), analysis.conditions.end(), std::back_inserter(response.conditions),
                 toMessage);
  response.nearest_singularity = arrayOf(analysis.nearest);
  response.distance_to_singularity = analysis.distance;
  return {AnswerCode::kSuccess, analysis.nearest_note};
}

}  // namespace ros_bridge
}  // namespace screwline
