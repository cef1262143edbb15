#include <ros/init.h>

#include <array>
#include <cmath>

#include "screwline/ik/batch.h"
#include "screwline/kinematics/batch.h"
#include "screwline/ros/checks.h"
#include "screwline/ros/conversions.h"
#include "screwline/ros/kinematics_server.h"

namespace screwline {
namespace ros_bridge {
namespace {

/// Of an answer: its bytes stay below the 1e9 that a client of roscpp accepts.
constexpr std::size_t kMostNumbers = 100000000;

/// requireFinite() of a number of a batch; what it is called is put together only where it is refused.
void requireFiniteAt(const std::vector<double>& numbers, std::size_t index, std::size_t columns,
                     const std::string& field, AnswerCode code) {
  if (isServed(numbers[index])) return;
  const std::string row = std::to_string(index / columns);
  requireFinite(numbers[index], field + "[" + std::to_string(index) + "] (row " + row + ")", code);
}

/// The quaternion x y z w of a row, normalised.
Matrix3 rotationOf(const double* xyzw, std::size_t row) {
  const Quaternion q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  const double norm = q.norm();
  if (std::abs(norm - 1.0) > kQuaternionTolerance) {
    throw InputError(AnswerCode::kInvalidGoal, "the quaternion of row " + std::to_string(row) + " of poses has norm " +
                                                   numberText(norm) + ", it must be 1 within " +
                                                   numberText(kQuaternionTolerance));
  }
  return q.normalized().toRotationMatrix();
}

/// Which of a pose's seven numbers a task reads.
std::array<bool, kPoseNumbers> columnsRead(const Task& task) {
  const ReadMask position = readMask(task, 0, true);
  const bool rotation = task.rotationCount() > 0;
  return {position[0], position[1], position[2], rotation, rotation, rotation, rotation};
}

Outcome outcomeOf(const IkBatchResult& result, double time) {
  const std::size_t count = result.counts.size();
  if (result.not_begun > 0 && ros::isShuttingDown()) return {AnswerCode::kFailure, "the node is shutting down"};
  if (result.not_begun > 0) {
    return {AnswerCode::kTimedOut, std::to_string(result.not_begun) + " of " + std::to_string(count) +
                                       " poses were not looked at within ~batch_timeout, " + numberText(time) + " s"};
  }
  const std::string late = result.timed_out ? "; the search for some of them ended at ~ik_timeout" : "";
  return {AnswerCode::kSuccess, std::to_string(result.without_solution) + " of " + std::to_string(count) +
                                    (count == 1 ? " pose" : " poses") + " without a solution" + late};
}

}  // namespace

std::size_t KinematicsServer::batchRows(std::size_t numbers, int columns, const std::string& field,
                                        AnswerCode code) const {
  const auto width = static_cast<std::size_t>(columns);
  const std::string has = field + " has " + std::to_string(numbers) + (numbers == 1 ? " number" : " numbers");
  if (numbers == 0) throw InputError(code, has + ", it must have a row of " + std::to_string(width) + " at least");
  if (numbers % width != 0) throw InputError(code, has + ", it must be a multiple of " + std::to_string(width));
  const std::size_t rows = numbers / width;
  if (rows <= static_cast<std::size_t>(params_.max_batch)) return rows;
  throw InputError(AnswerCode::kTooLarge, field + " has " + std::to_string(rows) + " rows, ~max_batch is " +
                                              std::to_string(params_.max_batch));
}

std::vector<Pose> KinematicsServer::batchTargets(const std::vector<double>& poses) const {
  constexpr std::size_t kColumns = kPoseNumbers;
  std::vector<Pose> targets(batchRows(poses.size(), kPoseNumbers, "poses", AnswerCode::kInvalidGoal));
  const auto read = columnsRead(robot_.task);
  for (std::size_t row = 0; row < targets.size(); ++row) {
    const double* numbers = &poses[row * kColumns];
    for (std::size_t column = 0; column < kColumns; ++column) {
      if (!read[column]) continue;
      requireFiniteAt(poses, row * kColumns + column, kColumns, "poses", AnswerCode::kInvalidGoal);
      if (column < 3) targets[row].p[static_cast<Eigen::Index>(column)] = numbers[column];
    }
    if (robot_.task.rotationCount() > 0) targets[row].R = rotationOf(numbers + 3, row);
  }
  return targets;
}

Outcome KinematicsServer::computeFkBatch(const ComputeFKBatch::Request& request,
                                         ComputeFKBatch::Response& response) const {
  const SerialChain& chain = *robot_.chain;
  const std::vector<double>& q = request.positions;
  const std::size_t rows = batchRows(q.size(), chain.size(), "positions", AnswerCode::kInvalidRobotState);
  const auto columns = static_cast<std::size_t>(chain.size());
  for (std::size_t i = 0; i < q.size(); ++i) {
    requireFiniteAt(q, i, columns, "positions", AnswerCode::kInvalidRobotState);
  }
  response.poses.resize(rows * kPoseNumbers);
  BatchOptions options;
  options.threads = params_.threads;
  options.cancelled = ros::isShuttingDown;
  if (forwardBatch(chain, {q.data(), rows, response.poses.data()}, options)) return {};
  throw Exception("the node is shutting down");
}

Outcome KinematicsServer::computeIkBatch(const ComputeIKBatch::Request& request,
                                         ComputeIKBatch::Response& response) const {
  requireMeaning(robot_.task);
  requireFinite(request.max_solutions, "max_solutions");
  const std::vector<Pose> targets = batchTargets(request.poses);
  IkBatchRequest batch;
  batch.targets = targets.data();
  batch.count = targets.size();
  batch.each.max_solutions = static_cast<int>(request.max_solutions);
  batch.each.ignore_limits = request.ignore_limits;
  batch.each.timeout = params_.ik_timeout;
  batch.each.rotation_weight = params_.rotation_weight;
  batch.threads = params_.threads;
  batch.time = params_.batch_timeout;
  batch.most_numbers = kMostNumbers;
  batch.cancelled = ros::isShuttingDown;
  IkBatchResult result = solveBatch(*solverFor(linkOrTip("", "tip_link"), robot_.task), batch);
  const Outcome outcome = outcomeOf(result, params_.batch_timeout);
  response.joint_names = robot_.chain->jointNames();
  response.counts = std::move(result.counts);
  response.positions = std::move(result.positions);
  response.complete = std::move(result.complete);
  return outcome;
}

}  // namespace ros_bridge
}  // namespace screwline
