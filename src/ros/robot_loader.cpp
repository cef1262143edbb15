#include "screwline/ros/robot_loader.h"

#include "screwline/exception.h"
#include "screwline/kinematics/task_selection.h"
#include "screwline/model/urdf_reader.h"
#include "screwline/ros/checks.h"
#include "screwline/ros/node_constants.h"

namespace screwline {
namespace ros_bridge {
namespace {

std::string listOf(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::vector<std::string> namesWhere(const SerialChain& chain, bool JointLimits::*flag) {
  std::vector<std::string> names;
  for (const Joint& joint : chain.joints())
    if (joint.limits.*flag) names.push_back(joint.name);
  return names;
}

/// Velocity limits are the description's; the planning limits stand in only where it gives none.
void keepDescribedVelocities(const SerialChain& chain, std::map<std::string, RateLimits>& rates,
                             std::vector<std::string>& notes) {
  for (const Joint& joint : chain.joints()) {
    const auto found = rates.find(joint.name);
    if (found == rates.end() || !found->second.velocity || joint.limits.velocity_assumed) continue;
    if (*found->second.velocity != joint.limits.velocity) {
      notes.push_back("velocity limit of " + joint.name + " is " + numberText(joint.limits.velocity) +
                      " from the robot description; max_velocity " + numberText(*found->second.velocity) +
                      " is not read");
    }
    found->second.velocity.reset();
  }
}

void noteAssumedLimits(const SerialChain& chain, std::vector<std::string>& notes) {
  const auto note = [&](bool JointLimits::*flag, const std::string& what) {
    const std::vector<std::string> names = namesWhere(chain, flag);
    if (!names.empty()) notes.push_back(what + ": " + listOf(names));
  };
  note(&JointLimits::velocity_assumed,
       "velocity limits are assumed (" + numberText(kAssumedVelocity) + " rad/s or m/s)");
  note(&JointLimits::acceleration_assumed,
       "acceleration limits are assumed (full speed in " + numberText(kAssumedAccelerationTime) + " s)");
  note(&JointLimits::jerk_assumed,
       "jerk limits are assumed (full acceleration in " + numberText(kAssumedJerkTime) + " s)");
}

Task taskOf(const SerialChain& chain, const RobotParams& params, std::vector<std::string>& notes) {
  if (!params.task.empty()) {
    try {
      return Task::parse(params.task);
    } catch (const InputError& error) {
      throw ModelError(std::string("~") + kTaskParam + ": " + error.what());
    }
  }
  const Task task = deriveTask(chain);
  notes.push_back("the task " + listOf(task.names()) + " is derived from the chain's geometry");
  return task;
}

}  // namespace

ServedRobot makeRobot(const RobotSource& source, const RobotParams& params) {
  ServedRobot robot;
  const SerialChain described = readUrdf(source.description, {params.base_link, params.tip_link});
  if (described.size() > params.max_joints) {
    throw ModelError("chain " + quoted(described.name()) + " has " + std::to_string(described.size()) + " joints, ~" +
                     kMaxJointsParam + " is " + std::to_string(params.max_joints));
  }
  PlanningLimits planning =
      readPlanningLimits(source.joint_limits, source.name + kPlanningSuffix + "/" + kJointLimitsKey);
  keepDescribedVelocities(described, planning.rates, robot.notes);
  robot.chain = std::make_shared<const SerialChain>(withRateLimits(described, planning.rates));
  noteAssumedLimits(*robot.chain, robot.notes);
  if (!planning.with_positions.empty()) {
    robot.notes.push_back("position limits are the robot description's; those of joint_limits are not read: " +
                          listOf(planning.with_positions));
  }
  robot.task = taskOf(*robot.chain, params, robot.notes);
  return robot;
}

RobotSource findRobot(const ros::NodeHandle& private_node) {
  RobotSource source;
  if (!private_node.searchParam(kRobotDescriptionParam, source.name)) {
    throw ModelError("parameter " + std::string(kRobotDescriptionParam) + " is neither in " +
                     private_node.getNamespace() + " nor above it");
  }
  if (!private_node.getParam(source.name, source.description)) {
    throw ModelError("parameter " + source.name + " is not a string");
  }
  private_node.getParam(source.name + kPlanningSuffix + "/" + kJointLimitsKey, source.joint_limits);
  return source;
}

}  // namespace ros_bridge
}  // namespace screwline
