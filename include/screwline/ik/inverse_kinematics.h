#ifndef SCREWLINE_IK_INVERSE_KINEMATICS_H
#define SCREWLINE_IK_INVERSE_KINEMATICS_H

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "screwline/kinematics/inverse_outline.h"
#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"

namespace screwline {

/// What is asked. Defaults are those of ComputeIK.srv.
struct IkRequest {
  Pose target;             ///< X_BT wanted, base frame; only the task's rows are read.
  VectorX seed;            ///< n values, or empty: zero, clamped into the limits.
  std::string branch;      ///< Empty: all. Else a branch name or some of its parts ("elbow up").
  int max_solutions = 0;   ///< 0: all.
  bool all_turns = false;  ///< Every multiple of 2 pi within the limits.
  bool ignore_limits = false;
  std::vector<double> redundancy;  ///< Fixed redundancy parameters of a redundant chain; empty: chosen.
  double timeout = 0.1;            ///< [s] for what is searched numerically.
  double rotation_weight = 1.0;    ///< [m/rad] how rotation counts beside translation in distance_to_reachable.
  bool find_closest = true;  ///< Search the best reachable configuration where there is no solution (milliseconds).
};

/// One solution. See IkSolution.msg.
struct IkAnswer {
  VectorX position;                ///< n: rad, m.
  std::string branch;              ///< "shoulder front, elbow up, wrist no flip"; stable along a path.
  double position_error = 0.0;     ///< [m] from forward kinematics, over the task.
  double orientation_error = 0.0;  ///< [rad]
  double joint_error =
      0.0;  ///< Residual over the smallest singular value: the band in which limit decisions are uncertain.
  bool within_limits = false;
  double distance = 0.0;  ///< Euclidean norm of position - seed.
  double manipulability = 0.0;
  bool singular = false;
  MatrixX self_motion;  ///< k x n, orthonormal rows: the directions along which the pose stays; 0 rows: isolated.
  std::vector<int> free_joints;  ///< Indices of the joints that move along it.
  VectorX self_motion_lower;     ///< Range of each free joint within limits, as long as free_joints.
  VectorX self_motion_upper;
};

enum class IkStatus {
  kSolved,
  kUnreachable,    ///< Proved: no joint values reach the pose.
  kOutsideLimits,  ///< Solutions exist, all of them break limits (or are of another branch than the one asked for).
  kNotFound,       ///< The search found none; that proves nothing.
};

struct IkResult {
  IkStatus status = IkStatus::kNotFound;
  std::vector<IkAnswer> solutions;  ///< Nearest to the seed first; those that the request lets through.
  bool complete = false;            ///< Every isolated solution and every continuum is in the list.
  std::string method;               ///< How they were found.
  int outside_limits = 0;           ///< Solutions that exist but break limits.
  int left_out = 0;                 ///< Solutions beyond max_solutions: the list is cut, and not complete.
  bool timed_out = false;
  bool indistinct = false;  ///< Rounding hides how many solutions there are: one is the same pose as all along a curve.
  IkAnswer closest;         ///< Best reachable configuration where there is no solution, if asked for.
  double distance_to_reachable = 0.0;  ///< sqrt(position_error^2 + (rotation_weight orientation_error)^2) of `closest`.
  std::string message;                 ///< One line, for people.
};

/// Inverse kinematics of a chain for a task: finds the best exact method for the chain's geometry once, answers many
/// poses. Immutable; solve() may be called from many threads.
class InverseKinematics {
 public:
  InverseKinematics(const SerialChain& chain, const Task& task);
  ~InverseKinematics();
  InverseKinematics(InverseKinematics&&) noexcept;

  const SerialChain& chain() const;
  const Task& task() const;

  /// Name of the method that the geometry allows, as "closed form: position by three joints, spherical wrist".
  const std::string& method() const;
  /// Whether that method finds every solution.
  bool complete() const;
  /// The branch names that solutions can have; empty where the method does not name them.
  std::vector<std::string> branches() const;
  /// The closed form, where there is one for all rows of the task, of seven joints for one of them given: for whoever
  /// writes it down.
  std::optional<InverseOutline> outline() const;

  /// All solutions of one pose. Verified: every solution's errors come from forward kinematics and are below 1e-9.
  /// Deterministic: the same request gives the same bytes. Allocates its result.
  /// @throws InputError: seed of wrong size or not finite (kInvalidRobotState); target not finite, turned off the axis
  /// of a single rotation row by more than 1e-6 rad, unknown branch, negative numbers (kInvalidGoal).
  IkResult solve(const IkRequest& request) const;

 private:
  struct Implementation;
  std::unique_ptr<const Implementation> implementation_;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_INVERSE_KINEMATICS_H
