#include "screwline/ros/params.h"

#include "screwline/exception.h"
#include "screwline/ros/node_constants.h"

namespace screwline {
namespace ros_bridge {
namespace {

constexpr double kLongestTimeout = 3600.0;  // s
constexpr int kMostThreads = 1024;
constexpr int kLargestBatch = 100000000;

std::optional<double> rateLimit(ParamReader& reader, const std::string& order) {
  const std::string flag = "has_" + order + "_limits";
  const std::string key = "max_" + order;
  const bool wanted = reader.flag(flag, reader.has(key));
  if (!wanted) return std::nullopt;
  if (!reader.has(key)) throw ModelError(reader.nameOf(flag) + " is true, " + key + " is missing");
  return reader.number(key, 0.0, 0.0, kMaxMagnitude);
}

}  // namespace

RobotParams readRobotParams(ParamReader& reader) {
  RobotParams params;
  params.base_link = reader.text(kBaseLinkParam, params.base_link);
  params.tip_link = reader.text(kTipLinkParam, params.tip_link);
  params.task = reader.texts(kTaskParam);
  if (reader.has(kTaskParam) && params.task.empty()) {
    throw ModelError(reader.nameOf(kTaskParam) +
                     " has no rows, it must name some of x y z rx ry rz, or x y z tx ty tz");
  }
  params.max_joints = reader.integer(kMaxJointsParam, params.max_joints, 1, kMaxJoints);
  // The search for robot_description starts in the private namespace.
  reader.pass(kRobotDescriptionParam);
  reader.pass(std::string(kRobotDescriptionParam) + kPlanningSuffix);
  return params;
}

KinematicsParams readKinematicsParams(const XmlRpc::XmlRpcValue& private_params) {
  ParamReader reader(private_params);
  KinematicsParams params;
  params.robot = readRobotParams(reader);
  params.ik_timeout = reader.number(kIkTimeoutParam, params.ik_timeout, 0.0, kLongestTimeout);
  params.threads = reader.integer(kThreadsParam, params.threads, 0, kMostThreads);
  params.max_batch = reader.integer(kMaxBatchParam, params.max_batch, 1, kLargestBatch);
  params.batch_timeout = reader.number(kBatchTimeoutParam, params.batch_timeout, 0.0, kMaxMagnitude);
  params.derive_timeout = reader.number(kDeriveTimeoutParam, params.derive_timeout, 0.0, kMaxMagnitude);
  params.conditions_timeout = reader.numberFromZero(kConditionsTimeoutParam, params.conditions_timeout, kMaxMagnitude);
  params.rotation_weight = reader.number(kRotationWeightParam, params.rotation_weight, 0.0, kMaxMagnitude);
  reader.refuseUnknown();
  return params;
}

PlanningLimits readPlanningLimits(const XmlRpc::XmlRpcValue& values, const std::string& where) {
  PlanningLimits result;
  if (!values.valid()) return result;
  if (values.getType() != XmlRpc::XmlRpcValue::TypeStruct) throw ModelError(where + " must be a struct of joint names");
  XmlRpc::XmlRpcValue joints(values);
  for (const auto& [name, limits] : joints) {
    ParamReader reader(limits, where + "/" + name + "/");
    RateLimits& rates = result.rates[name];
    rates.velocity = rateLimit(reader, "velocity");
    rates.acceleration = rateLimit(reader, "acceleration");
    rates.jerk = rateLimit(reader, "jerk");
    if (reader.flag("has_position_limits", false)) result.with_positions.push_back(name);
  }
  return result;
}

}  // namespace ros_bridge
}  // namespace screwline
