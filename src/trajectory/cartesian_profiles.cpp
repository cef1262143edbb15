#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cartesian_motion.h"
#include "screwline/exception.h"
#include "screwline/ik/branch_name.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/kinematics/forward.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/profile.h"

namespace screwline {
namespace {

constexpr double kFine = 1e-9;        ///< [rad, characteristic lengths] by which a branch may be off the path.
constexpr double kCoarse = 1e-6;      ///< The same where none carries the path else: straight through a singularity.
constexpr double kSameJoints = 1e-5;  ///< [rad, m] between the end of the path and joint values asked for.

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

bool flag(const ProfileContext& context, const std::string& name, bool fallback) {
  const auto value = context.parameter(name);
  if (!value) return fallback;
  if (*value != 0.0 && *value != 1.0) {
    throw InputError(AnswerCode::kInvalidGoal, "parameter '" + name + "' is " + number(*value) + ", it must be 0 or 1");
  }
  return *value == 1.0;
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

VectorX seedOf(const ProfileContext& context) {
  const PathPoint& first = context.waypoints().front();
  if (first.position.size() > 0) return first.position;
  if (context.request.present.size() > 0) return context.request.present;
  return chainOf(context).clamped(VectorX::Zero(context.joints()));
}

VectorX goalOf(const FollowedBranch& branch) {
  return FollowedPath(branch.curve).at(branch.curve.duration()).head(branch.start.size());
}

/// Whether the branch is one that the waypoints allow.
bool isWanted(const ProfileContext& context, const FollowedBranch& branch, const FollowRequest& question) {
  const auto& waypoints = context.waypoints();
  if (question.from_seed && (branch.start - question.seed).cwiseAbs().maxCoeff() > kSameJoints) return false;
  return matchesBranch(branch.branch, waypoints.front().branch);
}

bool arrives(const ProfileContext& context, const FollowedBranch& branch) {
  const PathPoint& last = context.waypoints().back();
  if (last.position.size() == 0) return matchesBranch(branch.goal_branch, last.branch);
  return (goalOf(branch) - last.position).cwiseAbs().maxCoeff() <= kSameJoints;
}

std::string nameOf(const FollowedBranch& branch) {
  if (!branch.branch.empty()) {
    const bool changes = !branch.goal_branch.empty() && branch.goal_branch != branch.branch;
    return "'" + branch.branch + "'" + (changes ? " (then '" + branch.goal_branch + "')" : "");
  }
  std::string values;
  for (Eigen::Index i = 0; i < branch.start.size(); ++i) {
    char text[32];
    std::snprintf(text, sizeof text, "%s%.4g", i > 0 ? " " : "", branch.start[i]);
    values += text;
  }
  return "from [" + values + "]";
}

/// Which branches carry the whole path, and where and why the others end.
std::string account(const FollowResult& result) {
  constexpr std::size_t kMostTold = 16;
  std::string whole;
  std::string ends;
  std::size_t carry = 0;
  for (std::size_t k = 0; k < result.branches.size(); ++k) {
    const FollowedBranch& branch = result.branches[k];
    const bool carries = branch.end == BranchEnd::kGoal;
    carry += carries ? 1 : 0;
    if (k >= kMostTold) continue;
    if (carries) {
      whole += (whole.empty() ? ": " : ", ") + nameOf(branch);
    } else {
      ends += "; " + nameOf(branch) + ": " + branch.reason;
    }
  }
  return std::to_string(carry) + " of " + std::to_string(result.branches.size()) + " branches carry the whole path" +
         whole + ends + (result.complete ? "" : " (there may be more branches)");
}

/// The first branch, nearest to the start, that does what the waypoints ask for; null: none.
const FollowedBranch* choose(const ProfileContext& context, const FollowResult& result, const FollowRequest& question) {
  for (const FollowedBranch& branch : result.branches) {
    if (branch.end == BranchEnd::kGoal && isWanted(context, branch, question) && arrives(context, branch))
      return &branch;
  }
  return nullptr;
}

[[noreturn]] void refuse(const ProfileContext& context, const FollowResult& result, const FollowRequest& question) {
  if (result.branches.empty()) {
    throw InputError(AnswerCode::kNoIkSolution, "waypoints[0].pose: " + result.note);
  }
  std::string why = "no branch carries the whole path";
  bool begins = false;
  for (const FollowedBranch& branch : result.branches) {
    if (!isWanted(context, branch, question)) continue;
    if (!begins) why = "from the start, on branch " + nameOf(branch) + ", " + branch.reason;
    if (branch.end == BranchEnd::kGoal) {
      why = "the path arrives on branch '" + branch.goal_branch + "' at other joint values than waypoints[" +
            std::to_string(context.waypoints().size() - 1) + "] asks for: give it as a pose";
    }
    begins = true;
  }
  if (!begins) {
    const std::string& wish = context.waypoints().front().branch;
    why = question.from_seed ? "no branch begins at the joint values of waypoints[0], which are singular: the joints "
                               "would have to turn there before the tip can move"
                             : "no branch begins as waypoints[0].branch '" + wish + "' asks";
  }
  throw InputError(AnswerCode::kPathNotContinuous,
                   "profile '" + context.request.profile + "': " + why + "; " + account(result));
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
  FollowRequest question;
  question.seed = seedOf(context);
  question.from_seed = context.waypoints().front().position.size() > 0;
  question.timeout = context.request.ik_timeout;
  question.tolerance = kFine;
  FollowResult result = followPath(*context.request.kinematics, path, question);
  const FollowedBranch* branch = choose(context, result, question);
  if (branch == nullptr && !result.branches.empty()) {
    question.tolerance = kCoarse;
    FollowResult coarse = followPath(*context.request.kinematics, path, question);
    if (choose(context, coarse, question) != nullptr) result = std::move(coarse);
    branch = choose(context, result, question);
  }
  if (branch == nullptr) refuse(context, result, question);

  const FollowedPath followed(branch->curve);
  const auto singularities = singularitiesAlong(chainOf(context), context.request.kinematics->task(), branch->curve);
  TimedPath timed = context.request.time_law.empty() ? timeOptimally(context, path, followed, singularities)
                                                     : timeByLaw(context, path, followed);
  ProfileDraft draft{std::move(timed.trajectory), std::move(timed.waypoint_times), std::move(timed.notes), {}};
  draft.notes.insert(draft.notes.begin(), "on branch " + nameOf(*branch) + "; " + account(result));
  draft.notes.push_back(measured(context, path, followed));
  draft.waypoints = solutionsOf(context, path, poses, followed, all_met);
  return draft;
}

}  // namespace

ProfileDraft buildCartesianLine(const ProfileContext& context) {
  ToolPathOptions options = optionsOf(context);
  options.screw = flag(context, "screw", false);
  options.blend_radius = context.parameter("blend_radius", 0.0);
  const std::vector<Pose> poses = posesOf(context);
  return follow(context, linesThrough(poses, options), poses, options.blend_radius == 0.0);
}

ProfileDraft buildCartesianArc(const ProfileContext& context) {
  const ToolPathOptions options = optionsOf(context);
  ArcOptions arc;
  arc.centre = flag(context, "centre", false);
  arc.long_way = flag(context, "long_way", false);
  arc.via_orientation = flag(context, "via_orientation", true);
  std::vector<Pose> poses = posesOf(context);
  const ToolPath path = arcThrough(poses, arc, options);
  // A centre is no pose of the path: what is met is the middle of the arc.
  if (arc.centre) poses[1] = path.pose(path.waypoints()[1]);
  if (!arc.via_orientation) poses[1].R = path.pose(path.waypoints()[1]).R;
  return follow(context, path, poses, true);
}

}  // namespace screwline
