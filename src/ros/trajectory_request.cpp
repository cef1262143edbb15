#include <algorithm>
#include <cmath>

#include "screwline/ros/checks.h"
#include "screwline/ros/conversions.h"
#include "screwline/ros/joint_values.h"
#include "screwline/ros/trajectory_conversions.h"
#include "screwline/ros/trajectory_planner.h"
#include "screwline/trajectory/profile.h"

namespace screwline {
namespace ros_bridge {
namespace {

constexpr std::size_t kMostWaypoints = 100000;
constexpr std::size_t kMostParameters = 1000;

[[noreturn]] void refuse(const std::string& message) {
  throw InputError(AnswerCode::kInvalidGoal, message);
}

std::string waypointField(std::size_t i) {
  return "waypoints[" + std::to_string(i) + "]";
}

/// The target in the frame that the request gives it in; what the task does not read is left at zero.
Pose targetInFrame(const geometry_msgs::Pose& pose, const Task& task, bool is_base, const std::string& field) {
  Pose target;
  target.p = fromPoint(pose.position, field + ".position", readMask(task, 0, is_base));
  if (task.rotationCount() > 0) target.R = fromQuaternion(pose.orientation, field + ".orientation");
  return target;
}

std::vector<std::pair<std::string, double>> parametersOf(const PlanTrajectory::Request& request) {
  requireCount(request.parameter_names.size(), kMostParameters, "parameter_names");
  if (request.parameter_names.size() != request.parameter_values.size()) {
    refuse("parameter_values has " + std::to_string(request.parameter_values.size()) +
           " entries, parameter_names has " + std::to_string(request.parameter_names.size()));
  }
  std::vector<std::pair<std::string, double>> parameters;
  for (std::size_t i = 0; i < request.parameter_names.size(); ++i) {
    parameters.emplace_back(request.parameter_names[i], request.parameter_values[i]);
  }
  return parameters;
}

double factor(double value, const std::string& field) {
  requireFinite(value, field);
  if (value < 0.0 || value > 1.0) refuse(field + " is " + numberText(value) + ", it must be in (0, 1], or 0 for 1");
  return value;
}

/// Profiles along a path keep jerk limits where the request gives some, unless its parameter says otherwise.
void holdGivenJerk(const PlanTrajectory::Request& request, PlanRequest& question) {
  constexpr char kHoldJerk[] = "hold_jerk";
  const auto& known = findProfile(request.profile).info.parameters;
  const auto named = [&](const auto& parameter) { return parameter.name == kHoldJerk; };
  const auto given = [&](const auto& parameter) { return parameter.first == kHoldJerk; };
  if (request.jerk_limits.empty() || std::none_of(known.begin(), known.end(), named)) return;
  const auto& parameters = question.parameters;
  if (std::none_of(parameters.begin(), parameters.end(), given)) question.parameters.emplace_back(kHoldJerk, 1.0);
}

}  // namespace

/// What a pose's solution is to be near to.
struct TrajectoryPlanner::PoseSeed {
  VectorX position;    ///< The waypoint before; for the first, where the robot is.
  std::string branch;  ///< Of the last pose; empty: none yet.
};

VectorX TrajectoryPlanner::values(const PlanTrajectory::Request& request, const std::vector<double>& given,
                                  const std::string& field) const {
  return jointValues(*robot_.chain, request.joint_names, given, "joint_names", field);
}

Limits TrajectoryPlanner::limitsOfRequest(const PlanTrajectory::Request& request) const {
  Limits limits = limitsOf(*robot_.chain);
  const auto take = [&](const std::vector<double>& given, const std::string& field, VectorX& bounds) {
    if (given.empty()) return;
    for (std::size_t i = 0; i < given.size(); ++i) {
      const std::string entry = field + "[" + std::to_string(i) + "]";
      requireFinite(given[i], entry);
      if (given[i] <= 0.0) refuse(entry + " is " + numberText(given[i]) + ", it must be above 0");
    }
    bounds = values(request, given, field);
  };
  take(request.velocity_limits, "velocity_limits", limits.velocity);
  take(request.acceleration_limits, "acceleration_limits", limits.acceleration);
  take(request.jerk_limits, "jerk_limits", limits.jerk);
  return limits;
}

void TrajectoryPlanner::requireWithinLimits(const VectorX& position, const std::string& field) const {
  for (int j = 0; j < robot_.chain->size(); ++j) {
    const Joint& joint = robot_.chain->joint(j);
    if (position[j] >= joint.limits.lower - kLimitTolerance && position[j] <= joint.limits.upper + kLimitTolerance) {
      continue;
    }
    refuse(field + " has " + numberText(position[j]) + " for joint " + quoted(joint.name) + ", its limits are " +
           numberText(joint.limits.lower) + " to " + numberText(joint.limits.upper));
  }
}

IkResult TrajectoryPlanner::ask(const IkRequest& question, const std::string& field) const {
  try {
    return solver_.solve(question);
  } catch (const InputError& error) {
    throw InputError(error.code(), field + ": " + error.what());
  }
}

Pose TrajectoryPlanner::poseOf(const Waypoint& waypoint, const std::string& field) const {
  const std::string& frame = waypoint.pose.header.frame_id;
  const Pose in_frame = targetInFrame(waypoint.pose.pose, robot_.task, frames_.isBase(frame), field + ".pose.pose");
  return frames_.withoutConfiguration(frame, field + ".pose.header.frame_id") * in_frame;
}

VectorX TrajectoryPlanner::solve(const Waypoint& waypoint, const std::string& field, PoseSeed& seed,
                                 std::vector<std::string>& notes) const {
  IkRequest question;
  question.target = poseOf(waypoint, field);
  question.seed = seed.position;
  question.timeout = ik_timeout_;
  question.max_solutions = 1;
  question.branch = waypoint.branch.empty() ? seed.branch : waypoint.branch;
  IkResult result = ask(question, field);
  if (result.solutions.empty() && waypoint.branch.empty() && !seed.branch.empty()) {
    question.branch.clear();
    result = ask(question, field);
    if (!result.solutions.empty()) {
      notes.push_back(field + " is not reached in branch " + ros_bridge::quoted(seed.branch) +
                      " of the pose before; it is in " + ros_bridge::quoted(result.solutions.front().branch));
    }
  }
  if (result.solutions.empty()) {
    const bool late = result.timed_out && result.status == IkStatus::kNotFound;
    throw InputError(late ? AnswerCode::kTimedOut : AnswerCode::kNoIkSolution,
                     field + ".pose: " + result.message + " (distance to what is reachable " +
                         numberText(result.distance_to_reachable) + " m)");
  }
  seed.branch = result.solutions.front().branch;
  return result.solutions.front().position;
}

PlanRequest TrajectoryPlanner::toPlanRequest(const PlanTrajectory::Request& request, const VectorX& present,
                                             std::vector<std::string>& notes) const {
  requireCount(request.waypoints.size(), kMostWaypoints, "waypoints");
  PlanRequest result;
  result.profile = request.profile;
  result.limits = limitsOfRequest(request);
  for (int j = 0; j < robot_.chain->size(); ++j) {
    if (robot_.chain->joint(j).type == JointType::kContinuous) result.continuous.push_back(j);
  }
  result.duration = request.duration;
  result.sample_period = request.sample_period;
  result.velocity_scaling = factor(request.velocity_scaling, "velocity_scaling");
  result.acceleration_scaling = factor(request.acceleration_scaling, "acceleration_scaling");
  result.jerk_scaling = factor(request.jerk_scaling, "jerk_scaling");
  result.parameters = parametersOf(request);
  if (!request.joint_names.empty()) {
    values(request, std::vector<double>(request.joint_names.size(), 0.0), "joint_names");
  }
  const bool cartesian = findProfile(request.profile).cartesian;
  holdGivenJerk(request, result);
  result.time_law = request.time_law;
  result.kinematics = &solver_;
  if (cartesian) {
    result.present = present;
    result.ik_timeout = ik_timeout_;
  }
  PoseSeed seed{present, ""};
  for (std::size_t i = 0; i < request.waypoints.size(); ++i) {
    const Waypoint& given = request.waypoints[i];
    const std::string field = waypointField(i);
    PathPoint waypoint;
    if (cartesian && given.position.empty()) {
      waypoint.pose = poseOf(given, field);
      waypoint.branch = given.branch;
    } else {
      waypoint.position = given.position.empty() ? solve(given, field, seed, notes)
                                                 : values(request, given.position, field + ".position");
      requireWithinLimits(waypoint.position, field + ".position");
    }
    if (!given.velocity.empty()) waypoint.velocity = values(request, given.velocity, field + ".velocity");
    if (!given.acceleration.empty()) {
      waypoint.acceleration = values(request, given.acceleration, field + ".acceleration");
    }
    waypoint.time = given.time;
    if (!cartesian) seed.position = waypoint.position;
    result.waypoints.push_back(std::move(waypoint));
  }
  return result;
}

}  // namespace ros_bridge
}  // namespace screwline
