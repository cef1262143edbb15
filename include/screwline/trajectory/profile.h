#ifndef SCREWLINE_TRAJECTORY_PROFILE_H
#define SCREWLINE_TRAJECTORY_PROFILE_H

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "screwline/trajectory/plan.h"

namespace screwline {

/// What a profile makes of velocity and acceleration in waypoints; what it cannot meet is refused, never ignored.
enum class WaypointDerivatives {
  kNone,         ///< Starts and ends at rest: only zeros may be given, at the ends.
  kEndVelocity,  ///< Velocities of the first and the last waypoint.
  kEnds,         ///< Velocities and accelerations of these two.
  kAll,          ///< Velocities and accelerations of any waypoint.
};

/// Parameter of every profile that a duration is given to: 1 lengthens one that is too short.
constexpr char kStretchParameter[] = "stretch";
/// Parameter of every profile with two waypoints or more: 1 takes the values of continuous joints as they are given.
constexpr char kKeepTurnsParameter[] = "keep_turns";

/// A validated request as a builder sees it.
struct ProfileContext {
  const PlanRequest& request;
  Limits limits;          ///< Scaled.
  double duration = 0.0;  ///< From the request or the last waypoint's time; 0: free.

  int joints() const { return limits.joints(); }
  const std::vector<PathPoint>& waypoints() const { return request.waypoints; }
  std::optional<double> parameter(const std::string& name) const;
  double parameter(const std::string& name, double fallback) const { return parameter(name).value_or(fallback); }
  /// A parameter that is 0 or 1. @throws InputError(kInvalidGoal) for another value.
  bool flag(const std::string& name, bool fallback) const;
  /// The parameter; 0 where it is not given. @throws InputError(kInvalidGoal) for a negative one.
  double blendRadius() const;
};

/// What a builder returns: a motion within the limits, and the instant of every waypoint.
struct ProfileDraft {
  JointTrajectory trajectory;
  std::vector<double> waypoint_times;
  std::vector<std::string> notes;
  bool meets_vias = false;              ///< Intermediate waypoints are met at their instants: verified with the rest.
  std::vector<VectorX> waypoints = {};  ///< Joint values of each where they were solved; empty: the request's.
};

/// The draft of a builder that meets its vias, and the velocities and accelerations that waypoints give.
inline ProfileDraft meetingVias(ProfileDraft draft) {
  draft.meets_vias = true;
  return draft;
}

using ProfileBuilder = ProfileDraft (*)(const ProfileContext& context);

/// One row of the registry. To add a profile: write a builder, add a row in registry.cpp.
struct Profile {
  ProfileSummary info;
  std::size_t fewest_waypoints = 2;
  std::size_t most_waypoints = std::numeric_limits<std::size_t>::max();
  bool via_times = false;  ///< Whether the instant of an intermediate waypoint may be given.
  WaypointDerivatives derivatives = WaypointDerivatives::kNone;
  ProfileBuilder build = nullptr;
  bool cartesian = false;  ///< Takes poses; needs the request's kinematics.
};

/// @throws InputError(kUnknownProfile) listing the known ones.
const Profile& findProfile(const std::string& name);

/// Checks everything in the request that needs no planning. @throws InputError (see plan()).
ProfileContext validateRequest(const PlanRequest& request, const Profile& profile);

/// The request with its continuous joints on their short ways; a note for each waypoint that is changed (many: the
/// first). @pre a valid request in joint space.
PlanRequest onShortWays(PlanRequest request, std::vector<std::string>& notes);

/// Throws InputError(kLimitsInfeasible): what breaks which limit in the given duration, and the shortest feasible one.
[[noreturn]] void refuseDuration(const ProfileContext& context, const LimitUse& use, double shortest);

/// The shortest duration of a motion, kept above the resolution of time; 0 (nothing moves) stays 0.
inline double noLessThanShortest(double duration) {
  return duration > 0.0 && duration < kShortestTime ? kShortestTime : duration;
}

/// One scaling for all joints, from the first waypoint to the last, in the given duration or the shortest that the
/// finite orders allow.
ProfileDraft scaleBetweenEnds(const ProfileContext& context, const TimeLaw& scaling);

/// The trapezoid for a displacement within limits: blend fraction and duration.
struct BlendedMove {
  double blend_fraction = 1.0 / 3.0;
  double duration = 0.0;
};
/// The shortest trapezoid of common s(tau) over `delta`; where acceleration is unlimited, one of equal thirds.
BlendedMove shortestTrapezoid(const VectorX& delta, const Limits& limits);
/// The blend fraction nearest to 1/3 that keeps the limits in `duration`. @pre duration is at least the shortest.
double blendWithin(const VectorX& delta, const Limits& limits, double duration);

// The builders, by the file that holds them.
ProfileDraft buildRectangular(const ProfileContext& context);  // scalar_profiles.cpp
ProfileDraft buildCubic(const ProfileContext& context);
ProfileDraft buildTrapezoidal(const ProfileContext& context);
ProfileDraft buildPolynomial345(const ProfileContext& context);
ProfileDraft buildPolynomial4567(const ProfileContext& context);
ProfileDraft buildCycloidal(const ProfileContext& context);
ProfileDraft buildSinusoidal(const ProfileContext& context);
ProfileDraft buildViaScalar(const ProfileContext& context);  // via_profiles.cpp
ProfileDraft buildViaPerJoint(const ProfileContext& context);
ProfileDraft buildMultipointTrapezoidal(const ProfileContext& context);  // multipoint_profiles.cpp
ProfileDraft buildMultipointCubic(const ProfileContext& context);
ProfileDraft buildMultipointQuintic(const ProfileContext& context);
ProfileDraft buildBspline(const ProfileContext& context);  // bspline_profiles.cpp
ProfileDraft buildBsplineInterpolating(const ProfileContext& context);
ProfileDraft buildDoubleS(const ProfileContext& context);  // time_optimal_profiles.cpp
ProfileDraft buildTimeOptimal(const ProfileContext& context);
ProfileDraft buildPathTimeOptimal(const ProfileContext& context);  // path_profiles.cpp
ProfileDraft buildCartesianLine(const ProfileContext& context);    // cartesian_profiles.cpp
ProfileDraft buildCartesianArc(const ProfileContext& context);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_PROFILE_H
