#ifndef SCREWLINE_IK_REDUNDANT_SIX_JOINT_SOLVER_H
#define SCREWLINE_IK_REDUNDANT_SIX_JOINT_SOLVER_H

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "screwline/ik/algebraic/algebraic_solver.h"
#include "screwline/ik/closed_form/parallel_plan.h"
#include "screwline/ik/closed_form/plan.h"

namespace screwline {

/// Solutions of a whole pose of six joints, not verified where they are a plan's.
struct SixJointSolutions {
  std::array<PlanSolution, 16> solutions;
  int count = 0;
  bool complete = true;  ///< False where some may be missing.

  const PlanSolution* begin() const { return solutions.data(); }
  const PlanSolution* end() const { return solutions.data() + count; }
};

/// Inverse kinematics of six joints for whole poses by the best exact method that their geometry has: a plan, a plan
/// for three parallel axes, elimination. Immutable.
class SixJointSolver {
 public:
  /// Empty where the chain has no closed form.
  static std::optional<SixJointSolver> compileClosedForm(const SerialChain& chain);
  /// By elimination; empty where the chain has not six joints or moves its tip in less than six dimensions. Takes about
  /// 5 ms.
  static std::optional<SixJointSolver> compileAlgebraic(const SerialChain& chain);

  /// No allocation, but at continua of a plan for three parallel axes. `preferred` (6 values) sets joints that turn out
  /// free. By elimination members of a continuum are told as solutions.
  void solve(const Pose& target, const double* preferred, SixJointSolutions& solutions) const;

  bool isAlgebraic() const { return std::holds_alternative<AlgebraicSolver>(method_); }
  /// Null where another method solves.
  const ClosedFormPlan* plan() const { return std::get_if<ClosedFormPlan>(&method_); }
  const std::string& method() const;
  /// What tells branches apart; nothing where elimination solves.
  std::vector<BranchPart> branchParts() const;
  std::string branchName(const PlanSolution& solution) const;
  bool isDouble(const PlanSolution& solution) const;

 private:
  using Method = std::variant<ClosedFormPlan, ParallelPlan, AlgebraicSolver>;
  explicit SixJointSolver(Method method) : method_(std::move(method)) {}

  Method method_;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_REDUNDANT_SIX_JOINT_SOLVER_H
