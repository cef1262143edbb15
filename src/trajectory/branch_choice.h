#ifndef SCREWLINE_SRC_TRAJECTORY_BRANCH_CHOICE_H
#define SCREWLINE_SRC_TRAJECTORY_BRANCH_CHOICE_H

#include <string>

#include "cartesian_motion.h"
#include "screwline/trajectory/branch_following.h"
#include "screwline/trajectory/profile.h"

namespace screwline {

/// [rad, characteristic lengths] by which a branch may be off the path where none carries it else: straight through a
/// singularity.
constexpr double kCoarse = 1e-6;

/// What the joints may do besides following the path: in a singularity the tip can stay while they turn.
enum class Turns { kNone, kInPlace };

/// All branches of a path, and the one that is taken.
struct BranchChoice {
  FollowResult result;
  const FollowedBranch* branch = nullptr;  ///< Of the result.
  Turns turns = Turns::kNone;
};

/// Where the robot is, or the first waypoint's joint values.
VectorX seedOf(const ProfileContext& context);

/// The branch nearest to the start that carries the path as the waypoints ask: their branches and joint values.
/// @throws InputError(kPathNotContinuous) with where and why each branch ends, (kNoIkSolution).
BranchChoice chooseBranch(const ProfileContext& context, const ToolPath& path);

/// "on branch 'elbow up'; 2 of 4 branches carry the whole path: ..."
std::string describe(const BranchChoice& choice);

/// The branch's curve with the turns in place that lead to it and on from it.
/// @throws InputError(kPathNotContinuous) where these meet a time_law.
FollowedPath withTurns(const ProfileContext& context, const ToolPath& path, const BranchChoice& choice);

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_BRANCH_CHOICE_H
