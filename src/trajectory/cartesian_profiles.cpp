#include <algorithm>
#include <cmath>
#include <cstdio>

#include "branch_choice.h"
#include "cartesian_motion.h"
#include "screwline/exception.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/kinematics/forward.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/profile.h"

namespace screwline {
namespace {

const SerialChain& chainOf(const ProfileContext& context) {
  return context.request.kinematics->chain();
}

std::vector<Pose> posesOf(const ProfileContext& context) {
  std::vector<Pose> poses;
  for (const PathPoint& waypoint : context.waypoints()) {
    poses.push_back(waypoint.position.size() > 0 ? forwardKinematics(chainOf(context), waypoint.position)
                                                 : waypoint.pose);
  }
  return poses;
}

ToolPathOptions optionsOf(const ProfileContext& context) {
  ToolPathOptions options;
  options.length_scale = chainOf(context).characteristicLength();
  options.rotates = context.request.kinematics->task().rotationCount() > 0;
  const auto speed = context.parameter("tool_speed");
  if (speed && !(*speed > 0.0)) {
    throw InputError(AnswerCode::kInvalidGoal,
                     "parameter 'tool_speed' is " + number(*speed) + " m/s, it must be above 0");
  }
  return options;
}

/// Largest errors of the motion to its path, measured by forward kinematics.
std::string measured(const ProfileContext& context, const ToolPath& path, const FollowedPath& followed) {
  constexpr int kEach = 8;
  TaskError worst;
  std::size_t part = 0;
  std::size_t count = 0;
  ToolPathPoint target;
  for (std::size_t k = 0; k < followed.curve().segments(); ++k) {
    for (int i = 0; i < kEach; ++i, ++count) {
      const VectorX y = followed.at(followed.curve().breaks[k] + followed.curve().length(k) * (i + 0.5) / kEach);
      const double u = y[context.joints()];
      while (part + 1 < path.parts() && u >= path.partEnd(part)) ++part;
      path.at(part, u, target);
      const TaskError error = taskError(context.request.kinematics->task(), target.pose,
                                        forwardKinematics(chainOf(context), y.head(context.joints())));
      worst.position = std::max(worst.position, error.position);
      worst.orientation = std::max(worst.orientation, error.orientation);
    }
  }
  const double allowed = 2.0 * kCoarse * std::max(1.0, chainOf(context).characteristicLength());
  if (!(worst.position <= allowed && worst.orientation <= allowed)) {
    throw Exception("internal error: the joints leave the path by " + number(worst.position) + " m, " +
                    number(worst.orientation) + " rad");
  }
  char text[128];
  std::snprintf(text, sizeof text, "the tip keeps to its path within %.1e m and %.1e rad (%zu places measured)",
                worst.position, worst.orientation, count);
  return text;
}

/// Joint values of every waypoint on the branch: where the path passes, or, beside a blended corner, solved from there.
std::vector<VectorX> solutionsOf(const ProfileContext& context, const ToolPath& path, const std::vector<Pose>& poses,
                                 const FollowedPath& followed, bool all_met) {
  std::vector<VectorX> solutions;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    VectorX q = followed.at(k + 1 == poses.size() ? followed.length() : followed.arcAt(path.waypoints()[k]))
                    .head(context.joints());
    if (!all_met && k > 0 && k + 1 < poses.size()) {
      const DescentResult near = descend(chainOf(context), context.request.kinematics->task(), poses[k], q, {});
      if (near.converged) q = near.q;
    }
    solutions.push_back(q);
  }
  return solutions;
}

/// Inverse kinematics knows which branch names there are, and whether its task takes a pose.
void requireAskable(const ProfileContext& context, const std::vector<Pose>& poses) {
  for (std::size_t k = 0; k < poses.size(); ++k) {
    IkRequest question;
    question.target = poses[k];
    question.branch = context.waypoints()[k].branch;
    question.max_solutions = 1;
    question.find_closest = false;
    question.timeout = 1e-6;
    try {
      context.request.kinematics->solve(question);
    } catch (const InputError& error) {
      throw InputError(error.code(), indexed("waypoints", k) + ".pose: " + error.what());
    }
  }
}

/// Nothing moves: the joints hold the solution of the first pose.
ProfileDraft hold(const ProfileContext& context, const std::vector<Pose>& poses) {
  VectorX q = context.waypoints().front().position;
  if (q.size() == 0) {
    IkRequest question;
    question.target = poses.front();
    question.seed = seedOf(context);
    question.branch = context.waypoints().front().branch;
    question.timeout = context.request.ik_timeout;
    const IkResult result = context.request.kinematics->solve(question);
    if (result.solutions.empty()) throw InputError(AnswerCode::kNoIkSolution, "waypoints[0].pose: " + result.message);
    q = result.solutions.front().position;
  }
  PiecewisePolynomial rest(context.joints(), 0, {0.0, context.duration}, 3);
  for (int j = 0; j < context.joints(); ++j) rest.at(0, 0, j) = q[j];
  ProfileDraft draft{JointTrajectory::piecewise(rest), {}, {"no pose differs from the first: nothing moves"}, {}};
  for (std::size_t k = 0; k < poses.size(); ++k) {
    draft.waypoint_times.push_back(context.duration * static_cast<double>(k) / static_cast<double>(poses.size() - 1));
    draft.waypoints.push_back(q);
  }
  return draft;
}

ProfileDraft follow(const ProfileContext& context, const ToolPath& path, const std::vector<Pose>& poses, bool all_met) {
  requireAskable(context, poses);
  if (path.length() == 0.0) return hold(context, poses);
  const BranchChoice choice = chooseBranch(context, path);
  const FollowedPath followed = withTurns(context, path, choice);
  auto singularities = singularitiesAlong(chainOf(context), context.request.kinematics->task(), choice.branch->curve);
  for (PassedSingularity& place : singularities) place.arc += followed.lead();
  TimedPath timed = context.request.time_law.empty() ? timeOptimally(context, path, followed, singularities)
                                                     : timeByLaw(context, path, followed);
  ProfileDraft draft{std::move(timed.trajectory), std::move(timed.waypoint_times), std::move(timed.notes), {}};
  draft.notes.insert(draft.notes.begin(), describe(choice));
  draft.notes.push_back(measured(context, path, followed));
  draft.waypoints = solutionsOf(context, path, poses, followed, all_met);
  const VectorX& goal = context.waypoints().back().position;
  if (goal.size() > 0 && (draft.waypoints.back() - goal).cwiseAbs().maxCoeff() > kPi) {
    draft.notes.push_back("a continuous joint arrives in another turn than the last waypoint's");
  }
  return draft;
}

}  // namespace

ProfileDraft buildCartesianLine(const ProfileContext& context) {
  ToolPathOptions options = optionsOf(context);
  options.screw = context.flag("screw", false);
  options.blend_radius = context.blendRadius();
  const std::vector<Pose> poses = posesOf(context);
  const ToolLines lines = linesThrough(poses, options);
  ProfileDraft draft = follow(context, lines.path, poses, options.blend_radius == 0.0);
  if (options.blend_radius > 0.0 && lines.path.length() > 0.0)
    noteCorners(lines.corners, options.blend_radius, " m", draft.notes);
  return draft;
}

ProfileDraft buildCartesianArc(const ProfileContext& context) {
  const ToolPathOptions options = optionsOf(context);
  ArcOptions arc;
  arc.centre = context.flag("centre", false);
  arc.long_way = context.flag("long_way", false);
  arc.via_orientation = context.flag("via_orientation", true);
  std::vector<Pose> poses = posesOf(context);
  const ToolPath path = arcThrough(poses, arc, options);
  // A centre is no pose of the path: what is met is the middle of the arc.
  if (arc.centre) poses[1] = path.pose(path.waypoints()[1]);
  if (!arc.via_orientation) poses[1].R = path.pose(path.waypoints()[1]).R;
  return follow(context, path, poses, true);
}

}  // namespace screwline
