#ifndef SCREWLINE_TRAJECTORY_BRANCH_FOLLOWING_H
#define SCREWLINE_TRAJECTORY_BRANCH_FOLLOWING_H

#include <string>
#include <vector>

#include "screwline/ik/inverse_kinematics.h"
#include "screwline/trajectory/piecewise_polynomial.h"
#include "screwline/trajectory/tool_path.h"

namespace screwline {

enum class BranchEnd {
  kGoal,        ///< It carries the whole path.
  kJointLimit,  ///< A joint would leave its limits.
  kSingular,    ///< In a singularity it meets another solution and turns back; the path goes on for others.
  kOutOfReach,  ///< There it meets another solution, and behind that no joint values reach the path.
  kLost,        ///< It could not be followed: none is known to come here, so tell us.
};

/// One solution of the first pose, followed along the path.
struct FollowedBranch {
  std::string branch;       ///< Its name where the path begins; empty where the solver names none.
  std::string goal_branch;  ///< Its name at the end: another where the path leads through a singularity.
  BranchEnd end = BranchEnd::kGoal;
  double end_u = 0.0;  ///< How far it carries the path.
  std::string reason;  ///< Why it ends, in words, with where; empty for kGoal.
  int joint = -1;      ///< kJointLimit: which, and the limit.
  double limit = 0.0;
  VectorX start;              ///< Joint values where the path begins.
  PiecewisePolynomial curve;  ///< (q, u): n + 1 rows over the arc length, as far as it goes.
  double distance = 0.0;      ///< Of start to the seed.
  std::vector<Range> turns;   ///< [arc] Where the joints turn in place, at a stop in a singular configuration.
};

struct FollowRequest {
  VectorX seed;             ///< Where the robot is: among turns and self-motions the nearest are taken.
  bool from_seed = false;   ///< The path begins at these joint values: no other turn or self-motion will do.
  double tolerance = 1e-9;  ///< [rad, or characteristic lengths] The curve may be off the path by this.
  double timeout = 0.1;     ///< [s] of each inverse solution that is searched.
};

struct FollowResult {
  std::vector<FollowedBranch> branches;  ///< Nearest to the seed first.
  bool complete = false;                 ///< No solution of the first pose is missing.
  std::string note;                      ///< Where there is no branch: why.
};

/// The whole path on every branch of its first pose. Solutions come from `solver`; each is then followed through
/// singularities that the path meets exactly, and slowly round those beside it. Where the path stops in one and does
/// not go on from the joint values in which a branch arrives, the joints turn in place to the nearest ones from which
/// it does. Limits: for chains that are not redundant a branch is followed without them and then put into the turns
/// that keep them; a redundant chain moves its joints as little as it can and keeps off their limits. Deterministic;
/// allocates; some 10 us per piece.
/// @throws InputError as InverseKinematics::solve().
FollowResult followPath(const InverseKinematics& solver, const ToolPath& path, const FollowRequest& request);

/// A singularity on or beside a followed curve.
struct PassedSingularity {
  double u = 0.0;
  double until_u = 0.0;    ///< Greater than u where the curve stays in it for a while.
  double arc = 0.0;        ///< Of the curve.
  std::string name;        ///< "wrist", with its condition: "wrist (sin(theta5) = 0)".
  bool met = false;        ///< Exactly, to rounding; else passed by.
  double closeness = 0.0;  ///< Least singular value of the task Jacobian over its greatest, in units.
};

/// The places along a curve where the task Jacobian is near to losing rank: where the closeness is below 0.05, its
/// minimum between one rise above that and the next.
std::vector<PassedSingularity> singularitiesAlong(const SerialChain& chain, const Task& task,
                                                  const PiecewisePolynomial& curve);

/// "0.123 m (41 %)": a place on the path.
std::string placeOf(const ToolPath& path, double u);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_BRANCH_FOLLOWING_H
