#ifndef SCREWLINE_IK_REDUNDANT_REDUNDANT_SOLVER_H
#define SCREWLINE_IK_REDUNDANT_REDUNDANT_SOLVER_H

#include <array>
#include <optional>
#include <string>

#include "screwline/ik/redundant/six_joint_solver.h"

namespace screwline {

constexpr int kRedundantJoints = 7;
using Vector7 = Eigen::Matrix<double, kRedundantJoints, 1>;

/// A solution at one value of the parameter joint: not wrapped, not verified. See PlanSolution.
struct RedundantSolution {
  Vector7 q;                  ///< [rad or m]
  unsigned free = 0;          ///< Bit i: joint i may take any value as well; q has the preferred one.
  std::array<int, 3> sign{};  ///< As PlanSolution's: which branch.
  int rank = 0;
};

struct RedundantSolutions {
  std::array<RedundantSolution, 16> solutions;
  int count = 0;
  bool complete = true;  ///< False where some may be missing.

  const RedundantSolution* begin() const { return solutions.data(); }
  const RedundantSolution* end() const { return solutions.data() + count; }
};

/// Inverse kinematics of a chain of seven joints, one of them given: what is left is a chain of six. Where that is the
/// first or the last joint, the other six keep their geometry and one method serves every value: a closed form, or else
/// elimination. Where it is another, a closed form is compiled for each value. The joint is chosen by geometry alone
/// (Shimizu et al. 2008 and He & Liu 2021 do so for two arms by hand). Immutable.
class RedundantSolver {
 public:
  /// Empty where the chain has not seven joints, or no single joint leaves a chain with an exact method for whole
  /// poses.
  static std::optional<RedundantSolver> compile(const SerialChain& chain);

  int parameterJoint() const { return parameter_; }
  /// As "joint7 given, position by three axes (two axes meet), spherical shoulder".
  const std::string& method() const { return method_; }
  /// Whether one plan serves every value; else solveAt() compiles (about a millisecond, allocates).
  bool compiledOnce() const { return parameter_ == 0 || parameter_ == kRedundantJoints - 1; }
  /// Method of the six others (at value zero).
  const SixJointSolver& others() const { return others_; }
  /// Of the others' plan, where one serves every value; else empty.
  std::optional<InverseOutline> outline() const;
  std::string branchName(const RedundantSolution& solution) const;
  /// Whether two branches meet in this one.
  bool isDouble(const RedundantSolution& solution) const;

  /// All branches for a pose of the tip with the parameter joint at `value` [rad or m]. `preferred` (7 values) sets
  /// joints that turn out free. No allocation where compiledOnce().
  void solveAt(const Pose& target, double value, const Vector7& preferred, RedundantSolutions& solutions) const;

 private:
  RedundantSolver(const SerialChain& chain, int parameter, SixJointSolver others);

  SerialChain chain_;
  int parameter_ = 0;
  SixJointSolver others_;
  bool prismatic_ = false;
  Vector3 direction_;  ///< Of the parameter joint's axis; in the base frame where it is the first, in the tip's where
                       ///< the last.
  Vector3 point_;
  std::string method_;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_REDUNDANT_REDUNDANT_SOLVER_H
