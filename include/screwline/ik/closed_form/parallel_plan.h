#ifndef SCREWLINE_IK_CLOSED_FORM_PARALLEL_PLAN_H
#define SCREWLINE_IK_CLOSED_FORM_PARALLEL_PLAN_H

#include <optional>
#include <string>
#include <vector>

#include "screwline/ik/closed_form/direction_problem.h"
#include "screwline/ik/closed_form/parallel_sheet.h"
#include "screwline/ik/closed_form/plan.h"
#include "screwline/ik/closed_form/planar_problem.h"
#include "screwline/kinematics/inverse_outline.h"

namespace screwline {

/// What ParallelPlan::solve() finds. Signs are those of the single joint's root, the elbow, the pair.
struct ParallelSolutions : PlanSolutions {
  unsigned open = 0;     ///< Bit i: joint i turned out free in some stage, whether or not the stages behind it have a
                         ///< solution at its preferred value: there may be a continuum.
  unsigned clamped = 0;  ///< Bit k: solution k exists only if rounding is moved in its favour; it may prove to be none.
  unsigned unlikely = 0;    ///< Bit k: clamped, where every move that rounding allows was tried; if it is none, none is
                            ///< missing.
  bool loose = false;       ///< A turn is known so badly that its error was not carried on in full: where others are
                            ///< clamped, one may be missing.
  bool indistinct = false;  ///< A turn of the pair is hardly known: solutions may be places on a curve that the pose
                            ///< does not tell from each other.
};

/// Inverse kinematics for whole poses of six revolute joints, three neighbouring ones with parallel axes and two
/// neighbours of the others with axes that meet (Universal Robots' arms, and any with the parallel axes first, in the
/// middle or last). The parallel axes keep what points along them: the height of the meeting point gives the single
/// joint, the direction of the axes gives the pair; three joints move a plane then (Elias & Wen 2022, the family of
/// three parallel axes). Compiled once, proved by reproducing configurations of the chain. Immutable.
class ParallelPlan {
 public:
  /// Empty where the chain's geometry has no such decomposition.
  static std::optional<ParallelPlan> compile(const SerialChain& chain);

  /// All solutions for a pose of the tip, 8 at most. `preferred` (6 values) sets free joints. Errors of one stage are
  /// carried to the next: what rounding may have made impossible is kept, marked clamped. No allocation.
  void solve(const Pose& target, const double* preferred, ParallelSolutions& solutions) const;

  /// Where the pair leaves one of its joints free, and no stage before it does: solutions by that joint's value. The
  /// plan must outlive them. Allocates.
  std::vector<ParallelSheet> sheets(const Pose& target) const;
  /// Whether `joint` is one of the pair.
  bool isOfPair(int joint) const { return joint == jointOf(pair_axis_) || joint == jointOf(pair_axis_ + 1); }

  /// Signs of the branch that configuration `q` of six joints is on, as solve() would give them.
  std::array<int, 3> signsAt(const Pose& target, const double* q) const;

  /// As "three parallel axes in the middle, joint1 by a height, joint5 and joint6 by a direction".
  const std::string& method() const { return method_; }
  const std::vector<BranchPart>& branchParts() const { return parts_; }
  InverseOutline outline() const;
  bool isDouble(const PlanSolution& solution) const;
  std::string branchName(const PlanSolution& solution) const;

 private:
  /// Where the single joint stands; the chain is taken from its tip where the parallel axes are nearer to that.
  enum class Single { kBeforeParallel, kBetween, kBehindPair };
  struct Question;
  struct Root;
  struct Roots;
  struct Answer;

  bool compileOrder(const SerialChain& chain, bool reversed, int first_parallel, Single single);
  bool reproduces(const SerialChain& chain) const;
  void nameBranches(const SerialChain& chain);
  int upwards() const;

  Question questionOf(const Pose& target, const double* preferred) const;
  Roots singleRoots(const Question& question) const;
  void solvePair(const Question& question, const Root& root, Answer& answer) const;
  void placeOf(const Question& question, const Turn& single, const Turn& first, const Turn& second, Turn& place,
               Turn& heading) const;
  bool solvePlane(const Question& question, const Root& root, const DirectionSolution& pair, double error,
                  Answer& answer) const;
  void takeAngles(const Question& question, Answer& answer) const;
  void solveLoosely(const Question& question, const Root& root, const DirectionSolution& pair, Answer& answer) const;
  double wayIntoReach(const Question& question, const Root& root, const DirectionSolution& pair) const;
  ParallelSheet sheetOf(const Question& question, const Root& root, const DirectionSolution& pair) const;
  void directions(const Question& question, const Turn& single, Vector3& start, Vector3& goal) const;
  double preferredAngle(const Question& question, int axis) const;
  int jointOf(int axis) const { return reversed_ ? 5 - axis : axis; }
  unsigned bitOf(int axis) const { return 1U << jointOf(axis); }

  bool reversed_ = false;
  Single single_ = Single::kBeforeParallel;
  int first_parallel_ = 1;
  int single_axis_ = 0;
  int pair_axis_ = 4;                 ///< First of the two.
  std::array<Vector3, 6> direction_;  ///< Parallel ones all point the same way.
  std::array<Vector3, 6> point_;
  std::array<double, 6> sense_{};      ///< -1 where the joint turns the other way round.
  Vector3 meeting_ = Vector3::Zero();  ///< Where the pair's axes meet.
  Vector3 x_ = Vector3::UnitX();       ///< x, y: the plane across the parallel axes.
  Vector3 y_ = Vector3::UnitY();
  Pose home_inverse_;
  double length_ = 1.0;
  double reach_ = 1.0;  ///< [m] by which an error of an angle counts at most.
  std::optional<DirectionProblem> pair_;
  std::optional<PlanarProblem> plane_;
  std::string method_;
  std::vector<BranchPart> parts_;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_CLOSED_FORM_PARALLEL_PLAN_H
