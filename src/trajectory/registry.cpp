#include "screwline/exception.h"
#include "screwline/trajectory/profile.h"

namespace screwline {
namespace {

constexpr std::size_t kMostTimeOptimal = 1000;  ///< Waypoints: each takes its share of the search.
constexpr std::size_t kMostCartesian = 1000;    ///< Poses: each line is followed on every branch.
constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();

std::vector<Profile> singleMoves() {
  return {
      {{"rectangular", "constant velocity between two waypoints; velocity steps at the ends", {}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildRectangular},
      {{"cubic", "3 tau^2 - 2 tau^3 between two waypoints; acceleration steps at the ends", {}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildCubic},
      {{"trapezoidal",
        "trapezoidal velocity between two waypoints. Any two of the parameters and the duration define it; with one of "
        "them, or the "
        "duration alone, thirds of equal length (moved as little as the limits ask); with nothing, the shortest within "
        "the limits",
        {{"peak_velocity", "[rad/s or m/s] of the joint that moves farthest", false},
         {"acceleration", "[rad/s^2 or m/s^2] of the joint that moves farthest", false},
         {"acceleration_time", "[s] of each ramp", false}}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildTrapezoidal},
      {{"polynomial_345", "10 tau^3 - 15 tau^4 + 6 tau^5 between two waypoints; zero acceleration at the ends", {}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildPolynomial345},
      {{"polynomial_4567", "35 tau^4 - 84 tau^5 + 70 tau^6 - 20 tau^7; zero acceleration and jerk at the ends", {}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildPolynomial4567},
      {{"cycloidal", "tau - sin(2 pi tau) / (2 pi) between two waypoints; zero acceleration at the ends", {}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildCycloidal},
      {{"minimum_jerk", "least integral of squared jerk from rest to rest: polynomial_345", {}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildPolynomial345},
  };
}

std::vector<Profile> jerkLimitedMoves() {
  return {
      {{"double_s", "one s(tau) of seven phases of constant jerk for all joints: the shortest within the limits", {}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildDoubleS},
      {{"time_optimal",
        "the shortest jerk-limited motion of each joint, all of the duration of the slowest; velocities and "
        "accelerations from the waypoints, at the ends else zero, at intermediate waypoints else chosen by a search: "
        "never "
        "longer than with a stop at each",
        {}},
       2,
       kMostTimeOptimal,
       false,
       WaypointDerivatives::kAll,
       buildTimeOptimal},
      {{"path_time_optimal",
        "the natural cubic spline through the waypoints (uniform knots), or with a blend_radius the lines between them "
        "with rounded corners, passed in the shortest time under the "
        "velocity and acceleration limits, from rest to rest or with velocities along the path at its ends",
        {{"blend_radius",
          "[rad or m, norm of joint differences] within which lines between the waypoints are left and met again on a "
          "C2 "
          "blend; 0: lines with a stop at each waypoint; not given: the spline",
          false},
         {"grid_points", "intervals in which the path is planned; 0 (default): by the waypoints", false},
         {"hold_jerk", "1: the jerk limits hold too (the default where the request gives jerk_limits); 0", false},
         {"tool_speed", "[m/s] that the tip keeps below; not given: no bound", false}}},
       2,
       kAny,
       false,
       WaypointDerivatives::kEndVelocity,
       buildPathTimeOptimal},
  };
}

std::vector<Profile> viaMoves() {
  const ParameterInfo via_tau{
      "via_tau",
      "fraction of the duration at which the via is due, 0.01 to 0.99; 0.5 if neither it nor the "
      "via's time is given",
      false};
  return {
      {{"via_scalar",
        "degree 6 from rest to rest, one s(tau) for all joints, fitted to the via value of the first joint: the other "
        "joints miss the "
        "via by what the answer says",
        {via_tau}},
       3,
       3,
       true,
       WaypointDerivatives::kNone,
       buildViaScalar},
      {{"via_per_joint", "degree 6 from rest to rest, every joint through its own via value", {via_tau}},
       3,
       3,
       true,
       WaypointDerivatives::kNone,
       buildViaPerJoint},
  };
}

std::vector<Profile> multipointMoves() {
  const ParameterInfo degree{"degree", "of the pieces: 3 (default), 4, 5, 6 or 7", false};
  const ParameterInfo rest_ends{
      "rest_ends",
      "1 (default): the end points are repeated so that the motion starts and ends at rest; 0: the waypoints "
      "alone are the control points, the motion starts and ends with velocity",
      false};
  return {
      {{"multipoint_trapezoidal",
        "trapezoidal velocity along the lines from waypoint to waypoint, at rest in each, or with corners blended",
        {{"blend_radius",
          "[rad or m, norm of joint differences] within which a corner is left and met again on a parabola, without a "
          "stop (acceleration steps: path_time_optimal has blends that hold jerk limits); 0 (default): a stop at each "
          "waypoint",
          false}}},
       2,
       kAny,
       true,
       WaypointDerivatives::kNone,
       buildMultipointTrapezoidal},
      {{"multipoint_cubic",
        "C2 cubic spline through the waypoints; velocities at the ends from the waypoints, else zero",
        {}},
       2,
       kAny,
       true,
       WaypointDerivatives::kEndVelocity,
       buildMultipointCubic},
      {{"multipoint_quintic",
        "C2 quintic pieces through the waypoints; velocities and accelerations from the waypoints, else those of the "
        "C2 cubic spline, at "
        "the ends zero",
        {}},
       2,
       kAny,
       true,
       WaypointDerivatives::kAll,
       buildMultipointQuintic},
      {{"bspline",
        "clamped uniform B-spline with the waypoints as control points: it meets the ends and stays in their hull; "
        "velocities and accelerations at the ends from the waypoints, else zero",
        {degree, rest_ends}},
       2,
       kAny,
       false,
       WaypointDerivatives::kEnds,
       buildBspline},
      {{"bspline_interpolating",
        "B-spline through the waypoints; velocities and accelerations at the ends from the waypoints, else zero",
        {degree}},
       2,
       kAny,
       true,
       WaypointDerivatives::kEnds,
       buildBsplineInterpolating},
  };
}

std::vector<Profile> freeMotions() {
  return {
      {{"sinusoidal",
        "joint i: offset_i + amplitude_i sin(omega_i t + phase_i) for the given duration; parameters not given are 0, "
        "the offsets may "
        "come from one waypoint instead",
        {{"offset_i", "[rad or m] of joint i, i from 0", true},
         {"amplitude_i", "[rad or m] of joint i", true},
         {"omega_i", "[rad/s] of joint i", true},
         {"phase_i", "[rad] of joint i", true}}},
       0,
       1,
       false,
       WaypointDerivatives::kNone,
       buildSinusoidal},
  };
}

std::vector<Profile> cartesianMotions() {
  const ParameterInfo tool_speed{"tool_speed", "[m/s] that the tip keeps below; not given: no bound", false};
  const ParameterInfo hold_jerk{
      "hold_jerk", "1: the jerk limits hold too (the default where the request gives jerk_limits); 0", false};
  const std::string timed =
      "; the fastest that joint velocities and accelerations allow, slower near singularities, or by the time_law of "
      "the "
      "request";
  return {
      {{"cartesian_line",
        "the tip on straight lines from pose to pose, its orientation about one axis each (slerp)" + timed,
        {{"blend_radius", "[m] at which a corner is left and met again; 0 (default): a stop at each corner", false},
         {"screw", "1: constant screws instead of lines and slerp; 0 (default)", false},
         hold_jerk,
         tool_speed}},
       2,
       kMostCartesian,
       false,
       WaypointDerivatives::kNone,
       buildCartesianLine,
       true},
      {{"cartesian_arc",
        "the tip on a circle from the first pose through the second to the third, orientations met by slerp with a "
        "turn that grows and fades as a parabola" +
            timed,
        {{"centre", "1: the second waypoint is the circle's centre; 0 (default): a pose on the arc", false},
         {"long_way", "1: with a centre, the arc of more than half a turn; 0 (default): the other", false},
         {"via_orientation", "1 (default): the second pose's orientation is met; 0: slerp from end to end", false},
         hold_jerk,
         tool_speed}},
       3,
       3,
       false,
       WaypointDerivatives::kNone,
       buildCartesianArc,
       true},
  };
}

const std::vector<Profile>& registry() {
  static const std::vector<Profile> profiles = [] {
    std::vector<Profile> all = singleMoves();
    for (const auto& group : {jerkLimitedMoves(), viaMoves(), multipointMoves(), cartesianMotions(), freeMotions()})
      all.insert(all.end(), group.begin(), group.end());
    const ParameterInfo stretch{
        kStretchParameter,
        "1: given times that are too short for the limits are lengthened, all by one factor, to "
        "the shortest feasible; 0 (default): they are refused",
        false};
    const ParameterInfo keep_turns{kKeepTurnsParameter,
                                   "1: values of continuous joints are taken in the turns that they are given in; 0 "
                                   "(default): each takes the turn "
                                   "that is nearest to the waypoint before, the short way",
                                   false};
    for (Profile& profile : all) {
      if (profile.info.name == "sinusoidal") continue;
      profile.info.parameters.push_back(stretch);
      profile.info.parameters.push_back(keep_turns);
    }
    return all;
  }();
  return profiles;
}

}  // namespace

std::vector<ProfileSummary> listProfiles() {
  std::vector<ProfileSummary> infos;
  for (const auto& profile : registry()) infos.push_back(profile.info);
  return infos;
}

const Profile& findProfile(const std::string& name) {
  std::string known;
  for (const auto& profile : registry()) {
    if (profile.info.name == name) return profile;
    known += (known.empty() ? "" : ", ") + profile.info.name;
  }
  throw InputError(AnswerCode::kUnknownProfile, "profile '" + name + "' is unknown; known are " + known);
}

}  // namespace screwline
