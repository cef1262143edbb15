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
#include "turn_in_place.h"

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

/// What the joints may do besides following the path: in a singularity the tip can stay while they turn.
enum class Turns { kNone, kInPlace };

bool sameJoints(const VectorX& difference) {
  return difference.cwiseAbs().maxCoeff() <= kSameJoints;
}

bool turnsBetween(const ProfileContext& context, const VectorX& from, const VectorX& to) {
  const double tolerance = kCoarse * std::max(1.0, chainOf(context).characteristicLength());
  return keepsPose(chainOf(context), context.request.kinematics->task(), from, to, tolerance);
}

/// Whether the branch is one that the waypoints allow.
bool isWanted(const ProfileContext& context, const FollowedBranch& branch, Turns turns) {
  const PathPoint& first = context.waypoints().front();
  if (!matchesBranch(branch.branch, first.branch)) return false;
  return first.position.size() == 0 || sameJoints(branch.start - first.position) ||
         (turns == Turns::kInPlace && turnsBetween(context, first.position, branch.start));
}

/// The goal's values as given, or in the turns of continuous joints in which the branch arrives.
VectorX wantedGoal(const ProfileContext& context, const FollowedBranch& branch) {
  VectorX goal = context.waypoints().back().position;
  if (context.flag(kKeepTurnsParameter, false)) return goal;
  const VectorX off = goalOf(branch) - goal;
  for (const int joint : context.request.continuous) goal[joint] += off[joint] - std::remainder(off[joint], kTwoPi);
  return goal;
}

bool arrives(const ProfileContext& context, const FollowedBranch& branch, Turns turns) {
  const PathPoint& last = context.waypoints().back();
  if (last.position.size() == 0) return matchesBranch(branch.goal_branch, last.branch);
  const VectorX goal = wantedGoal(context, branch);
  return sameJoints(goalOf(branch) - goal) || (turns == Turns::kInPlace && turnsBetween(context, goalOf(branch), goal));
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
const FollowedBranch* choose(const ProfileContext& context, const FollowResult& result, Turns turns) {
  for (const FollowedBranch& branch : result.branches) {
    if (branch.end == BranchEnd::kGoal && isWanted(context, branch, turns) && arrives(context, branch, turns))
      return &branch;
  }
  return nullptr;
}

[[noreturn]] void refuse(const ProfileContext& context, const FollowResult& result) {
  if (result.branches.empty()) {
    throw InputError(AnswerCode::kNoIkSolution, "waypoints[0].pose: " + result.note);
  }
  std::string why = "no branch carries the whole path";
  bool begins = false;
  for (const FollowedBranch& branch : result.branches) {
    if (!isWanted(context, branch, Turns::kNone)) continue;
    if (!begins) why = "from the start, on branch " + nameOf(branch) + ", " + branch.reason;
    if (branch.end == BranchEnd::kGoal) {
      why = "the path arrives on branch '" + branch.goal_branch + "' at other joint values than waypoints[" +
            std::to_string(context.waypoints().size() - 1) + "] asks for: give it as a pose";
    }
    begins = true;
  }
  if (!begins) {
    const bool joints = context.waypoints().front().position.size() > 0;
    why = joints ? "no branch begins at the joint values of waypoints[0], which are singular: the joints would have to "
                   "turn there before the tip can move, and none of the branches that carry the path is reached so; "
                   "give waypoints[0] as a pose"
                 : "no branch begins as waypoints[0].branch '" + context.waypoints().front().branch + "' asks";
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

struct Choice {
  FollowResult result;
  const FollowedBranch* branch = nullptr;
  Turns turns = Turns::kNone;
};

/// A branch that carries the path; within a coarser tolerance, or with the joints turned in place, where none does
/// else.
Choice chooseBranch(const ProfileContext& context, const ToolPath& path) {
  FollowRequest question;
  question.seed = seedOf(context);
  question.from_seed = context.waypoints().front().position.size() > 0;
  question.timeout = context.request.ik_timeout;
  const bool joints = question.from_seed || context.waypoints().back().position.size() > 0;
  Choice choice;
  for (const Turns turns : {Turns::kNone, Turns::kInPlace}) {
    if (turns == Turns::kInPlace && !joints) break;
    if (turns == Turns::kInPlace) question.from_seed = false;
    for (const double tolerance : {kFine, kCoarse}) {
      question.tolerance = tolerance;
      FollowResult result = followPath(*context.request.kinematics, path, question);
      const bool nothing = result.branches.empty();
      const bool found = choose(context, result, turns) != nullptr;
      if (found || choice.result.branches.empty()) choice.result = std::move(result);
      choice.turns = turns;
      if (found) choice.branch = choose(context, choice.result, turns);
      if (found || nothing) return choice;
    }
  }
  return choice;
}

/// The branch's curve with the turns in place that lead to it and on from it.
FollowedPath withTurns(const ProfileContext& context, const ToolPath& path, const Choice& choice) {
  const FollowedBranch& branch = *choice.branch;
  if (choice.turns == Turns::kNone) return FollowedPath(branch.curve);
  PiecewisePolynomial curve = branch.curve;
  double lead = 0.0;
  double tail = 0.0;
  const VectorX& first = context.waypoints().front().position;
  if (first.size() > 0 && !sameJoints(branch.start - first)) {
    const PiecewisePolynomial turn = turnInPlace(first, branch.start, 0.0);
    lead = turn.duration();
    curve = concatenate(turn, curve);
  }
  if (context.waypoints().back().position.size() > 0) {
    const VectorX goal = wantedGoal(context, branch);
    if (!sameJoints(goalOf(branch) - goal)) {
      const PiecewisePolynomial turn = turnInPlace(goalOf(branch), goal, path.length());
      tail = turn.duration();
      curve = concatenate(curve, turn);
    }
  }
  if (lead + tail > 0.0 && !context.request.time_law.empty()) {
    throw InputError(AnswerCode::kPathNotContinuous,
                     "time_law is '" + context.request.time_law +
                         "', the joints have to turn in place at a singular end, where the tip's way stands still: "
                         "leave time_law empty, or give that waypoint as a pose");
  }
  return FollowedPath(std::move(curve), lead, tail);
}

ProfileDraft follow(const ProfileContext& context, const ToolPath& path, const std::vector<Pose>& poses, bool all_met) {
  requireAskable(context, poses);
  if (path.length() == 0.0) return hold(context, poses);
  const Choice choice = chooseBranch(context, path);
  if (choice.branch == nullptr) refuse(context, choice.result);
  const FollowedPath followed = withTurns(context, path, choice);
  auto singularities = singularitiesAlong(chainOf(context), context.request.kinematics->task(), choice.branch->curve);
  for (PassedSingularity& place : singularities) place.arc += followed.lead();
  TimedPath timed = context.request.time_law.empty() ? timeOptimally(context, path, followed, singularities)
                                                     : timeByLaw(context, path, followed);
  ProfileDraft draft{std::move(timed.trajectory), std::move(timed.waypoint_times), std::move(timed.notes), {}};
  draft.notes.insert(draft.notes.begin(), "on branch " + nameOf(*choice.branch) + "; " + account(choice.result));
  draft.notes.push_back(measured(context, path, followed));
  draft.waypoints = solutionsOf(context, path, poses, followed, all_met);
  return draft;
}

/// How corners are passed, and which of them no blend of that size fits.
void noteBlends(const ToolPath& path, const std::vector<Pose>& poses, double radius, std::vector<std::string>& notes) {
  double most = 0.0;
  double shortest = 2.0 * radius;
  std::size_t narrow = 0;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const double line = (poses[k].p - poses[k - 1].p).norm();
    if (k + 1 < poses.size()) most = std::max(most, (path.pose(path.waypoints()[k]).p - poses[k].p).norm());
    if (poses.size() < 3 || line == 0.0 || line >= shortest) continue;
    shortest = line;
    narrow = k;
  }
  std::string text = "corners are blended within blend_radius " + number(radius) + " m, the tip passes them at up to " +
                     number(most) + " m";
  if (path.parts() > 1) {
    text += "; it stops at " + std::to_string(path.parts() - 1) + " where it only turns before or behind";
  }
  if (narrow > 0) {
    text += "; blend_radius is more than half of the line to " + indexed("waypoints", narrow) + " and is reduced to " +
            number(0.5 * shortest) + " m there";
  }
  notes.push_back(text);
}

}  // namespace

ProfileDraft buildCartesianLine(const ProfileContext& context) {
  ToolPathOptions options = optionsOf(context);
  options.screw = context.flag("screw", false);
  options.blend_radius = context.parameter("blend_radius", 0.0);
  const std::vector<Pose> poses = posesOf(context);
  const ToolPath path = linesThrough(poses, options);
  ProfileDraft draft = follow(context, path, poses, options.blend_radius == 0.0);
  if (options.blend_radius > 0.0 && path.length() > 0.0) noteBlends(path, poses, options.blend_radius, draft.notes);
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
