#ifndef SCREWLINE_TEST_UNIT_TRAJECTORY_SUPPORT_H
#define SCREWLINE_TEST_UNIT_TRAJECTORY_SUPPORT_H

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

#include "screwline/exception.h"
#include "screwline/trajectory/plan.h"

namespace screwline {
namespace trajectory_test {

inline VectorX vector(std::initializer_list<double> values) {
  VectorX result(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (double value : values) result[i++] = value;
  return result;
}

/// The same limits for every joint.
inline Limits limitsOf(int joints, double velocity, double acceleration, double jerk) {
  return {VectorX::Constant(joints, velocity),
          VectorX::Constant(joints, acceleration),
          VectorX::Constant(joints, jerk),
          {},
          {}};
}

inline PlanRequest request(const std::string& profile, const std::vector<VectorX>& positions, const Limits& limits) {
  PlanRequest result;
  result.profile = profile;
  result.limits = limits;
  for (const auto& position : positions) {
    PathPoint waypoint;
    waypoint.position = position;
    result.waypoints.push_back(waypoint);
  }
  return result;
}

/// A motion under the limits 1, 4, 40 of every joint.
inline JointTrajectory planned(const std::string& profile, const std::vector<VectorX>& way, double duration = 0.0) {
  PlanRequest r = request(profile, way, limitsOf(static_cast<int>(way.front().size()), 1.0, 4.0, 40.0));
  r.duration = duration;
  return plan(r).trajectory;
}

/// What plan() throws; kSuccess where it does not.
inline AnswerCode errorOf(const PlanRequest& request) {
  try {
    plan(request);
  } catch (const InputError& error) {
    return error.code();
  }
  return AnswerCode::kSuccess;
}

inline std::string messageOf(const PlanRequest& request) {
  try {
    plan(request);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// The profiles that need no more of the robot than its limits.
inline std::vector<ProfileSummary> jointProfiles() {
  std::vector<ProfileSummary> profiles = listProfiles();
  const auto needs_kinematics = [](const ProfileSummary& profile) { return profile.name.rfind("cartesian", 0) == 0; };
  profiles.erase(std::remove_if(profiles.begin(), profiles.end(), needs_kinematics), profiles.end());
  return profiles;
}

}  // namespace trajectory_test
}  // namespace screwline

#endif  // SCREWLINE_TEST_UNIT_TRAJECTORY_SUPPORT_H
