#ifndef SCREWLINE_IK_CLOSED_FORM_PLAN_H
#define SCREWLINE_IK_CLOSED_FORM_PLAN_H

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "screwline/ik/closed_form/orientation_problem.h"
#include "screwline/ik/closed_form/position_problem.h"
#include "screwline/ik/closed_form/turn_sequence.h"
#include "screwline/kinematics/inverse_outline.h"
#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"

namespace screwline {

constexpr int kMaxPlanJoints = 6;

/// A solution as a plan gives it: not wrapped, not verified.
struct PlanSolution {
  std::array<double, kMaxPlanJoints> q{};
  unsigned free = 0;          ///< Bit i: joint i may take any value; q has the preferred one.
  std::array<int, 3> sign{};  ///< Eliminant, square root, wrist: see PositionSolution and OrientationSolution.
  int rank = 0;
};

/// The first n joint values. Allocates.
inline VectorX jointsOf(const PlanSolution& solution, int n) {
  return Eigen::Map<const VectorX>(solution.q.data(), n);
}

/// Indices of the joints that may take any value. Allocates.
inline std::vector<int> freeJointsOf(const PlanSolution& solution) {
  std::vector<int> joints;
  for (int i = 0; i < kMaxPlanJoints; ++i) {
    if ((solution.free >> i & 1U) != 0U) joints.push_back(i);
  }
  return joints;
}

struct PlanSolutions {
  std::array<PlanSolution, 8> solutions;
  int count = 0;

  const PlanSolution* begin() const { return solutions.data(); }
  const PlanSolution* end() const { return solutions.data() + count; }
};

/// One part of a branch's name, decided by a product of signs: "elbow up" and "elbow down", "elbow straight" where it
/// is zero.
struct BranchPart {
  std::array<bool, 3> signs{};  ///< Which of PlanSolution::sign are multiplied.
  int orientation = 1;          ///< Makes `positive` mean what it says.
  std::string positive;
  std::string negative;
  std::string neutral;
};

class PlanSheet;

/// Inverse kinematics of a chain for a task, compiled once from the geometry of its axes into two small problems: the
/// position of a point moved by three axes, and an orientation by three. Task rows that are missing become slides that
/// cost nothing; a heading is taken by the last turn; a spherical wrist (or shoulder) gives the point. Before a plan is
/// used it has to reproduce configurations of the chain.
class ClosedFormPlan {
 public:
  /// Empty where the chain's geometry has no such decomposition for the task (also: mimic joints, more or fewer joints
  /// than rows).
  static std::optional<ClosedFormPlan> compile(const SerialChain& chain, const Task& task);

  /// All solutions for a pose of the tip. `preferred` (n values) sets free joints. No allocation.
  void solve(const Pose& target, const double* preferred, PlanSolutions& solutions) const;

  /// The continuum of a solution with one free joint, where that joint moves none of the others that place the
  /// spherical axes' point (which lies on its axis); empty elsewhere. The plan must outlive it. No allocation.
  std::optional<PlanSheet> sheetOf(const Pose& target, const PlanSolution& solution) const;

  /// The joint that stands at opposite values for the two wrists of one arm, counted from a constant, the other two
  /// half a turn apart: where neighbouring spherical axes are at right angles.
  std::optional<int> mirroredByWrist() const {
    const bool is_mirrored = orientation_ && orientation_->isAcross();
    return is_mirrored ? std::optional<int>(spherical_first_ + 1) : std::nullopt;
  }

  /// As "position by three joints (axes that meet), spherical wrist".
  const std::string& method() const { return method_; }
  const std::vector<BranchPart>& branchParts() const { return parts_; }
  InverseOutline outline() const;
  /// Whether two solutions meet in this one: a part of its name is neutral.
  bool isDouble(const PlanSolution& solution) const;
  /// "shoulder front, elbow up"; empty where there is one branch only.
  std::string branchName(const PlanSolution& solution) const;

 private:
  friend class PlanSheet;
  enum class Shape { kPosition, kOrientation, kWrist, kShoulder, kHeading };
  /// What is left for the other axes and the spherical ones.
  struct SphericalGoal {
    Vector3 point;  ///< Where the other axes have to bring the point in which the spherical ones meet.
    Matrix3 M;      ///< In front of which the other axes' turns are undone.
  };

  bool compileShape(const SerialChain& chain, const Task& task);
  bool compilePosition(const Task& task);
  bool compileSpherical(int first);
  bool compileHeading(const Task& task);
  bool compileStage(const std::vector<int>& joints, const Task& task);
  bool reproduces(const SerialChain& chain, const Task& task) const;
  void nameBranches(const SerialChain& chain);
  void orient(const SerialChain& chain, BranchPart& branch_part) const;
  static int signOf(const BranchPart& branch_part, const PlanSolution& solution);
  double meaningOf(const BranchPart& branch_part, const double* q) const;

  void foldSpherical();
  std::array<double, 3> wishedOf(const double* preferred) const;
  void solvePosition(const Vector3& goal, const double* preferred, PlanSolutions& solutions) const;
  void solveOrientation(const Pose& target, const double* preferred, PlanSolutions& solutions) const;
  SphericalGoal sphericalGoal(const Pose& target) const;
  void solveSpherical(const Pose& target, const double* preferred, PlanSolutions& solutions) const;
  const PositionSolution* armOf(const PlanSolution& solution, const PositionSolutions& arms) const;
  void solveHeading(const Pose& target, const double* preferred, PlanSolutions& solutions) const;
  void solveTurningSlides(const Matrix3& turn, const Vector3& goal, const double* preferred,
                          PlanSolutions& solutions) const;
  void addStage(const PositionSolutions& found, PlanSolutions& solutions) const;
  PlanSolution solutionOf(const PositionSolution& position) const;
  void addOrientation(const PlanSolution& arm, const OrientationSolutions& turns, PlanSolutions& solutions) const;

  Shape shape_ = Shape::kPosition;
  Pose home_;
  double length_ = 1.0;
  std::vector<Axis> axes_;  ///< The chain's.
  std::optional<PositionProblem>
      position_;  ///< Compiled; for a heading with slides behind the last turn, of the zero heading.
  std::array<Axis, 3> stage_axes_;
  std::array<int, 3> stage_joints_{
      {-1, -1, -1}};                 ///< Joint of each axis of the position problem; -1: a row that is missing.
  double stage_sign_ = 1.0;          ///< -1 where the problem runs from the tip to the base.
  Vector3 start_ = Vector3::Zero();  ///< Point that the position problem moves, at zero.
  std::optional<OrientationProblem> orientation_;
  int spherical_first_ = 0;               ///< First joint of the orientation problem.
  TurnSequence others_;                   ///< Turns of the position problem's axes, as the spherical axes see them.
  Matrix3 before_ = Matrix3::Identity();  ///< Constants on both sides of the target's rotation.
  Matrix3 after_ = Matrix3::Identity();
  Vector3 start_in_tip_ = Vector3::Zero();  ///< [m] `start_`, tip's frame.
  int heading_joint_ = -1;                  ///< Joint that takes the heading.
  Vector3 heading_axis_ = Vector3::UnitZ();
  bool turning_slides_ =
      false;  ///< Slides behind the heading joint turn with it: the position problem is compiled per pose.
  std::string method_;
  std::vector<BranchPart> parts_;
};

/// Solutions on one branch of a continuum by the value of its one free joint, the arm's others standing still: the
/// spherical axes alone follow it (a spherical four-bar linkage). See ClosedFormPlan::sheetOf().
class PlanSheet {
 public:
  /// False where the branch has none. No allocation.
  bool member(double value, PlanSolution& solution) const;

 private:
  friend class ClosedFormPlan;
  PlanSheet() = default;

  const ClosedFormPlan* plan_ = nullptr;
  std::size_t joint_ = 0;  ///< The free one.
  double sense_ = 0.0;     ///< Of its turn; 0: it slides.
  PlanSolution branch_;    ///< With the arm's joints.
  /// What is left for the spherical axes: middle + cosine cos + sine sin of the free joint's turn.
  Matrix3 middle_;
  Matrix3 cosine_;
  Matrix3 sine_;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_CLOSED_FORM_PLAN_H
