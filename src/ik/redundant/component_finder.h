#ifndef SCREWLINE_SRC_IK_REDUNDANT_COMPONENT_FINDER_H
#define SCREWLINE_SRC_IK_REDUNDANT_COMPONENT_FINDER_H

#include "pose_curve.h"
#include "reach_margin.h"

namespace screwline {

/// Collects the curves that solve a pose: slices through the solution set at values of the parameter joint, every
/// solution of which has to lie on a curve; from those that do not yet, a curve is traced.
class ComponentFinder {
 public:
  /// `solver` may be null: then only addStart() finds curves.
  ComponentFinder(PoseCurve& pose, const RedundantSolver* solver, const Pose& target);

  /// Slices at evenly spaced values of the parameter joint.
  void addGrid();
  /// Slices at right angles and at zero, for curves along which the parameter joint stands still there.
  void addChosenValues();
  /// Slices where the margin of reach is largest, for curves too short for the grid.
  void addExtrema(const ReachMargin& margin);
  /// One slice more.
  void addValue(double value);
  /// Traces from a solution that lies on no curve yet, and the curves that cross that one. False where it is no
  /// solution, or singular.
  bool addStart(const Vector7& q, double reach);
  /// Joins what has been found about continua inside of slices into sheets.
  void finishSheets();

  std::vector<SelfMotionCurve>& curves() { return curves_; }
  std::vector<SelfMotionSheet>& sheets() { return sheets_; }
  /// Solutions of slices beside which there may be others that no curve nor sheet tells.
  int unexplained() const { return unexplained_; }

 private:
  static constexpr double kSamePoint = 1e-6;    // [rad] A configuration this near to a curve is on it.
  static constexpr double kSliceReach = 1e-3;   // [rad] A slice's solution is this near to the curve at most.
  static constexpr double kSurfaceGain = 1e-9;  // Of a node that may be on a surface.

  struct Free {
    int slice = 0;
    RedundantSolution solution;
  };

  void coverGrid(const SelfMotionCurve& curve);
  void branchOut(const Vector7& crossing);
  void addFree(const Free& free);
  bool addSurface(const Vector7& q);
  void addSheet(const RedundantSolution& told, bool parameter_moves);
  std::function<bool(const VectorX&, VectorX&)> membersOf(const RedundantSolution& member, bool parameter_moves);
  bool isAlone(const SelfMotionSheet& sheet);
  void addPoint(const RedundantSolution& solution);
  RedundantSolution refined(const RedundantSolution& member) const;

  PoseCurve& pose_;
  const RedundantSolver* solver_;
  std::shared_ptr<const RedundantSolver> held_;  ///< A copy, for what sheets need of it.
  Pose target_;
  int slices_ = 0;
  double first_ = 0.0;  ///< Value of the first slice; the others follow by step_.
  double step_ = 0.0;
  std::vector<RedundantSolutions> grid_;
  std::vector<unsigned> covered_;  ///< Per slice of the grid, bit k: its solution k lies on a curve.
  std::vector<SelfMotionCurve> curves_;
  std::vector<Vector7> crossings_;  ///< Those that were branched out from.
  std::vector<Free> free_;
  std::vector<SelfMotionSheet> sheets_;
  std::size_t nodes_ = 0;  ///< Of the curves.
  int unexplained_ = 0;
};

/// Distance of a configuration from a curve, if it is below `reach` (else infinity); revolute joints modulo full turns.
double distanceToCurve(PoseCurve& pose, const SelfMotionCurve& curve, const Vector7& q, double reach);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_REDUNDANT_COMPONENT_FINDER_H
