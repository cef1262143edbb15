#ifndef SCREWLINE_TRAJECTORY_PLAN_H
#define SCREWLINE_TRAJECTORY_PLAN_H

#include <string>
#include <utility>
#include <vector>

#include "screwline/ik/inverse_kinematics.h"
#include "screwline/spatial/pose.h"
#include "screwline/trajectory/joint_trajectory.h"
#include "screwline/trajectory/limits.h"

namespace screwline {

struct PathPoint {
  VectorX position;         ///< [rad or m], n values. Empty where a Cartesian profile is given a pose.
  VectorX velocity;         ///< Empty: not given.
  VectorX acceleration;     ///< Empty: not given.
  double time = 0.0;        ///< [s] The first is 0; 0 on a later one: not given.
  Pose pose = {};           ///< X_BT, base frame: read by Cartesian profiles where position is empty.
  std::string branch = {};  ///< Of the inverse solution for the pose: a name, or some of its parts; empty: any.
};

struct PlanRequest {
  std::string profile;
  std::vector<PathPoint> waypoints;
  double duration = 0.0;                                   ///< [s] 0: the shortest that the limits allow.
  double sample_period = 0.0;                              ///< [s] 0: 0.01. Only bounds the number of samples here.
  Limits limits;                                           ///< Of n joints; decides n.
  double velocity_scaling = 0.0;                           ///< In (0, 1]; 0: 1.
  double acceleration_scaling = 0.0;                       ///< The same.
  double jerk_scaling = 0.0;                               ///< The same.
  std::vector<std::pair<std::string, double>> parameters;  ///< As listProfiles() names them.
  std::vector<int> continuous;  ///< Joints that turn without end: see plan(). In joint space, and at a path's goal.

  // Of Cartesian profiles only.
  const InverseKinematics* kinematics = nullptr;  ///< The chain and its task. Has to outlive plan().
  VectorX present;          ///< n: where the robot is; a first pose is solved near to it. Empty: zero, within limits.
  std::string time_law;     ///< A profile of one s(tau) for the way along the path; empty: time-optimal.
  double ik_timeout = 0.1;  ///< [s] of each inverse solution that is searched.
};

struct PlanResult {
  JointTrajectory trajectory;
  double sample_period = 0.01;         ///< [s] As requested, or its default.
  std::vector<double> waypoint_times;  ///< [s] One instant per waypoint.
  std::vector<VectorX> waypoints;      ///< Joint values of each waypoint: as requested, or solved.
  MatrixX via_joint_errors;            ///< (waypoints - 2) x n: position at the instant minus the waypoint's position.
  std::vector<std::string> notes;      ///< What the reader of the answer should know, one sentence each.
};

struct ParameterInfo {
  std::string name;  ///< "amplitude_i" stands for amplitude_0, amplitude_1, ...
  std::string meaning;
  bool per_joint = false;
};

struct ProfileSummary {
  std::string name;
  std::string meaning;
  std::vector<ParameterInfo> parameters;
};

/// Every profile that plan() knows, in the order of the documentation.
std::vector<ProfileSummary> listProfiles();

/// A motion through the waypoints that keeps the limits, proved by exact extrema (verify.h) before it is returned.
/// Orders that a profile makes infinite (acceleration of rectangular, jerk of cubic) are not held; notes say so.
/// A continuous joint takes the short way: of the values that differ by turns of 2 pi from a waypoint's, the one
/// nearest to the waypoint before (half a turn: as given). Notes say which; the parameter `keep_turns` 1 leaves them as
/// given.
/// @throws InputError kUnknownProfile (lists the known ones), kLimitsInfeasible (names joint, order, value, bound and
/// the shortest feasible duration; given times are lengthened only with the parameter `stretch`), kTooLarge,
/// kInvalidGoal (names the field, its value and the bound), and for Cartesian profiles kNoIkSolution (the first pose is
/// out of reach), kPathNotContinuous (no branch carries the whole path: where and why each of them ends).
/// @throws Exception where the check fails: an internal error, never a trajectory.
PlanResult plan(const PlanRequest& request);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_PLAN_H
