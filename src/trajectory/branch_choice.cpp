#include "branch_choice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "screwline/exception.h"
#include "screwline/ik/branch_name.h"
#include "screwline/trajectory/format.h"
#include "turn_in_place.h"

namespace screwline {
namespace {

constexpr double kFine = 1e-9;        ///< [rad, characteristic lengths] by which a branch may be off the path.
constexpr double kSameJoints = 1e-5;  ///< [rad, m] between the end of the path and joint values asked for.

const SerialChain& chainOf(const ProfileContext& context) {
  return context.request.kinematics->chain();
}

VectorX goalOf(const FollowedBranch& branch) {
  return FollowedPath(branch.curve).at(branch.curve.duration()).head(branch.start.size());
}

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

/// Within a coarser tolerance, or with the joints turned in place, where none does else.
BranchChoice lookForBranch(const ProfileContext& context, const ToolPath& path) {
  FollowRequest question;
  question.seed = seedOf(context);
  question.from_seed = context.waypoints().front().position.size() > 0;
  question.timeout = context.request.ik_timeout;
  const bool joints = question.from_seed || context.waypoints().back().position.size() > 0;
  BranchChoice choice;
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

}  // namespace

VectorX seedOf(const ProfileContext& context) {
  const PathPoint& first = context.waypoints().front();
  if (first.position.size() > 0) return first.position;
  if (context.request.present.size() > 0) return context.request.present;
  return chainOf(context).clamped(VectorX::Zero(context.joints()));
}

BranchChoice chooseBranch(const ProfileContext& context, const ToolPath& path) {
  BranchChoice choice = lookForBranch(context, path);
  if (choice.branch == nullptr) refuse(context, choice.result);
  return choice;
}

std::string describe(const BranchChoice& choice) {
  return "on branch " + nameOf(*choice.branch) + "; " + account(choice.result);
}

FollowedPath withTurns(const ProfileContext& context, const ToolPath& path, const BranchChoice& choice) {
  const FollowedBranch& branch = *choice.branch;
  if (choice.turns == Turns::kNone) return FollowedPath(branch.curve, 0.0, 0.0, branch.turns);
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
  std::vector<Range> turns = branch.turns;
  for (Range& turn : turns) turn = {turn.lower + lead, turn.upper + lead};
  return FollowedPath(std::move(curve), lead, tail, std::move(turns));
}

}  // namespace screwline
