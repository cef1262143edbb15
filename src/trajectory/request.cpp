#include <algorithm>
#include <cmath>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/profile.h"

namespace screwline {
namespace {

constexpr double kLargest = 1e6;
constexpr std::size_t kMostWaypoints = 100000;

[[noreturn]] void refuse(const std::string& message) {
  throw InputError(AnswerCode::kInvalidGoal, message);
}

void requireUsable(double value, const std::string& field) {
  if (std::isfinite(value) && std::abs(value) <= kLargest) return;
  refuse(field + " is " + number(value) + ", its magnitude must be finite and at most 1000000");
}

void requireTime(double value, const std::string& field) {
  requireUsable(value, field);
  if (value < 0.0) refuse(field + " is " + number(value) + " s, it must not be negative");
  if (value > 0.0 && value < kShortestTime) refuse(field + " is " + number(value) + " s, below the least of 1e-06 s");
}

void requireVector(const VectorX& values, int joints, const std::string& field) {
  if (values.size() != joints) {
    refuse(field + " has " + std::to_string(values.size()) + " values, the robot has " + std::to_string(joints) +
           " joints");
  }
  for (Eigen::Index i = 0; i < values.size(); ++i)
    requireUsable(values[i], indexed(field, static_cast<std::size_t>(i)));
}

void requireWithinBounds(const VectorX& position, const Limits& limits, const std::string& field) {
  if (limits.lower.size() == 0) return;
  for (Eigen::Index i = 0; i < position.size(); ++i) {
    if (position[i] >= limits.lower[i] - kLimitTolerance && position[i] <= limits.upper[i] + kLimitTolerance) continue;
    refuse(indexed(field, static_cast<std::size_t>(i)) + " is " + number(position[i]) + ", the joint's limits are " +
           number(limits.lower[i]) + " to " + number(limits.upper[i]));
  }
}

void requireWithinLimit(const VectorX& values, const VectorX& bounds, const std::string& field) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (std::abs(values[i]) <= bounds[i] * (1.0 + kLimitTolerance)) continue;
    throw InputError(AnswerCode::kLimitsInfeasible, indexed(field, static_cast<std::size_t>(i)) + " is " +
                                                        number(values[i]) + ", the limit is " + number(bounds[i]));
  }
}

void requireMeetable(const VectorX& values, const std::string& field, bool accepted, const std::string& profile) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (accepted || values[i] == 0.0) continue;
    refuse(indexed(field, static_cast<std::size_t>(i)) + " is " + number(values[i]) + ", profile '" + profile +
           "' cannot meet it (multipoint_quintic does)");
  }
}

/// A velocity or acceleration that is given must be one that the profile meets: a zero at the ends always is.
void validateDerivatives(const ProfileContext& context, const Profile& profile, std::size_t index,
                         const std::string& field) {
  const PathPoint& waypoint = context.waypoints()[index];
  const bool all = profile.derivatives == WaypointDerivatives::kAll;
  const bool end = index == 0 || index + 1 == context.waypoints().size();
  if (waypoint.velocity.size() > 0) {
    requireVector(waypoint.velocity, context.joints(), field + ".velocity");
    requireWithinLimit(waypoint.velocity, context.limits.velocity, field + ".velocity");
    const bool accepted = all || (end && profile.derivatives != WaypointDerivatives::kNone);
    requireMeetable(waypoint.velocity, field + ".velocity", accepted, profile.info.name);
    if (!end && !all) refuse(field + ".velocity is given, profile '" + profile.info.name + "' chooses it itself");
  }
  if (waypoint.acceleration.size() > 0) {
    requireVector(waypoint.acceleration, context.joints(), field + ".acceleration");
    requireWithinLimit(waypoint.acceleration, context.limits.acceleration, field + ".acceleration");
    const bool accepted = all || (end && profile.derivatives == WaypointDerivatives::kEnds);
    requireMeetable(waypoint.acceleration, field + ".acceleration", accepted, profile.info.name);
    if (!end && !all) refuse(field + ".acceleration is given, profile '" + profile.info.name + "' chooses it itself");
  }
}

void validateCount(const PlanRequest& request, const Profile& profile) {
  const std::size_t count = request.waypoints.size();
  if (count > kMostWaypoints) {
    throw InputError(AnswerCode::kTooLarge,
                     "waypoints has " + std::to_string(count) + " entries, at most 100000 are planned");
  }
  if (count >= profile.fewest_waypoints && count <= profile.most_waypoints) return;
  const bool exact = profile.fewest_waypoints == profile.most_waypoints;
  const bool open = profile.most_waypoints > kMostWaypoints;
  const std::string wanted = exact  ? "exactly " + std::to_string(profile.fewest_waypoints)
                             : open ? "at least " + std::to_string(profile.fewest_waypoints)
                                    : "at most " + std::to_string(profile.most_waypoints);
  refuse("waypoints has " + std::to_string(count) + " entries, profile '" + profile.info.name + "' takes " + wanted);
}

void validateTimes(const PlanRequest& request, const Profile& profile) {
  double previous = 0.0;
  for (std::size_t i = 0; i < request.waypoints.size(); ++i) {
    const std::string field = indexed("waypoints", i) + ".time";
    const double time = request.waypoints[i].time;
    requireTime(time, field);
    if (time == 0.0) continue;
    if (i == 0) refuse(field + " is " + number(time) + " s, the first waypoint is at 0 s");
    if (time < previous + 0.999 * kShortestTime)
      refuse(field + " is " + number(time) + " s, it must be after " + number(previous) + " s");
    if (!profile.via_times && i + 1 < request.waypoints.size()) {
      refuse(field + " is " + number(time) + " s, profile '" + profile.info.name +
             "' takes no time at intermediate waypoints");
    }
    previous = time;
  }
  if (request.duration == 0.0 || previous == 0.0) return;
  const bool last_given = request.waypoints.back().time > 0.0;
  if (last_given && std::abs(previous - request.duration) > 1e-9 * request.duration) {
    refuse("duration is " + number(request.duration) + " s, the last waypoint's time is " + number(previous) + " s");
  }
  if (!last_given && previous > request.duration - 0.999 * kShortestTime) {
    refuse("duration is " + number(request.duration) + " s, a waypoint before the last is at " + number(previous) +
           " s");
  }
}

/// "amplitude_12" for the parameter "amplitude_i" of a robot with more than 12 joints.
bool matches(const ParameterInfo& parameter, const std::string& name, int joints) {
  if (!parameter.per_joint) return parameter.name == name;
  const std::string stem = parameter.name.substr(0, parameter.name.size() - 1);
  if (name.compare(0, stem.size(), stem) != 0) return false;
  for (int i = 0; i < joints; ++i) {
    if (name == stem + std::to_string(i)) return true;
  }
  return false;
}

void validateParameters(const PlanRequest& request, const Profile& profile) {
  std::string known;
  for (const auto& parameter : profile.info.parameters) known += (known.empty() ? "" : ", ") + parameter.name;
  for (std::size_t k = 0; k < request.parameters.size(); ++k) {
    const auto& [name, value] = request.parameters[k];
    requireUsable(value, "parameter '" + name + "'");
    const bool found =
        std::any_of(profile.info.parameters.begin(), profile.info.parameters.end(),
                    [&, &wanted = name](const auto& p) { return matches(p, wanted, request.limits.joints()); });
    if (!found) {
      refuse("parameter '" + name + "' is unknown to profile '" + profile.info.name + "', which takes " +
             (known.empty() ? "none" : known));
    }
    for (std::size_t other = 0; other < k; ++other) {
      if (request.parameters[other].first == name) refuse("parameter '" + name + "' is given twice");
    }
  }
}

void requirePose(const Pose& pose, const std::string& field) {
  for (int i = 0; i < 3; ++i) requireUsable(pose.p[i], field + ".position");
  const double off = (pose.R.transpose() * pose.R - Matrix3::Identity()).norm();  // A maximum may overlook NaN.
  if (!(off <= 1e-6)) refuse(field + ".orientation is no rotation: R^T R is off the identity by " + number(off));
}

void validateKinematics(const PlanRequest& request, const Profile& profile) {
  if (!profile.cartesian) {
    if (!request.time_law.empty())
      refuse("time_law is '" + request.time_law + "', only Cartesian profiles take one, not '" + profile.info.name +
             "'");
    return;
  }
  if (request.kinematics == nullptr) refuse("profile '" + profile.info.name + "' needs the robot's kinematics");
  if (request.kinematics->chain().size() != request.limits.joints()) {
    refuse("limits have " + std::to_string(request.limits.joints()) + " joints, the robot has " +
           std::to_string(request.kinematics->chain().size()));
  }
  if (request.present.size() > 0) requireVector(request.present, request.limits.joints(), "present");
  requireTime(request.ik_timeout, "ik_timeout");
}

void validateContinuous(const PlanRequest& request) {
  for (const int joint : request.continuous) {
    if (joint >= 0 && joint < request.limits.joints()) continue;
    refuse("continuous names joint " + std::to_string(joint) + ", the robot has " +
           std::to_string(request.limits.joints()));
  }
}

}  // namespace

std::optional<double> ProfileContext::parameter(const std::string& name) const {
  for (const auto& [given, value] : request.parameters) {
    if (given == name) return value;
  }
  return std::nullopt;
}

bool ProfileContext::flag(const std::string& name, bool fallback) const {
  const auto value = parameter(name);
  if (!value) return fallback;
  if (*value != 0.0 && *value != 1.0) refuse("parameter '" + name + "' is " + number(*value) + ", it must be 0 or 1");
  return *value == 1.0;
}

double ProfileContext::blendRadius() const {
  const double radius = parameter("blend_radius", 0.0);
  if (radius < 0.0) refuse("parameter 'blend_radius' is " + number(radius) + ", it must not be negative");
  return radius;
}

PlanRequest onShortWays(PlanRequest request, std::vector<std::string>& notes) {
  constexpr double kHalfTurn = kPi * (1.0 + 1e-9);  // Of two ways that are equally long the given one.
  std::size_t turned = 0;
  for (std::size_t k = 1; k < request.waypoints.size(); ++k) {
    const VectorX& before = request.waypoints[k - 1].position;
    VectorX& position = request.waypoints[k].position;
    for (const int joint : request.continuous) {
      const double given = position[joint];
      if (std::abs(given - before[joint]) <= kHalfTurn) continue;
      position[joint] = given + kTwoPi * std::round((before[joint] - given) / kTwoPi);
      if (++turned > 1) continue;
      notes.push_back(indexed("waypoints", k) + ".position: joint " + std::to_string(joint) +
                      " is continuous and takes the short way, to " + number(position[joint]) + " instead of " +
                      number(given) + " (parameter 'keep_turns' 1: as given)");
    }
  }
  if (turned > 1) notes.push_back("so do " + std::to_string(turned - 1) + " more values");
  return request;
}

ProfileContext validateRequest(const PlanRequest& request, const Profile& profile) {
  const int joints = request.limits.joints();
  if (joints == 0) refuse("limits have no joints");
  validateLimits(request.limits, joints);
  validateCount(request, profile);
  requireTime(request.duration, "duration");
  requireTime(request.sample_period, "sample_period");
  validateTimes(request, profile);
  validateParameters(request, profile);
  validateKinematics(request, profile);
  validateContinuous(request);

  const auto factor = [](double given) { return given == 0.0 ? 1.0 : given; };
  ProfileContext context{request,
                         scaledLimits(request.limits, factor(request.velocity_scaling),
                                      factor(request.acceleration_scaling), factor(request.jerk_scaling)),
                         request.duration};
  for (std::size_t i = 0; i < request.waypoints.size(); ++i) {
    const std::string field = indexed("waypoints", i);
    if (profile.cartesian && request.waypoints[i].position.size() == 0) {
      requirePose(request.waypoints[i].pose, field + ".pose");
      validateDerivatives(context, profile, i, field);
      continue;
    }
    requireVector(request.waypoints[i].position, joints, field + ".position");
    requireWithinBounds(request.waypoints[i].position, request.limits, field + ".position");
    validateDerivatives(context, profile, i, field);
  }
  if (context.duration == 0.0 && !request.waypoints.empty()) context.duration = request.waypoints.back().time;
  return context;
}

}  // namespace screwline
