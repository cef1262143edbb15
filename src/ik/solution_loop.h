#ifndef SCREWLINE_SRC_IK_SOLUTION_LOOP_H
#define SCREWLINE_SRC_IK_SOLUTION_LOOP_H

#include <memory>
#include <vector>

#include "continuum.h"
#include "screwline/ik/closed_form/parallel_plan.h"

namespace screwline {

/// A stretch of a continuum on one branch, over an interval of the free joint's value.
struct LoopArc {
  double from = 0.0;  ///< [rad]
  double to = 0.0;    ///< [rad] Above `from` by a full turn at most, or below: the way the loop runs.
  std::array<int, 3> sign{};
};

/// A continuum of one dimension at a singular pose: a closed curve of solutions, exact members all the way round. Where
/// the free joint turns back, two branches meet: one arc ends there and the next one begins.
class SolutionLoop {
 public:
  SolutionLoop(const ParallelPlan& plan, const SerialChain& chain, const Pose& target, int joint,
               std::vector<LoopArc> arcs);

  int joint() const { return joint_; }
  const std::vector<LoopArc>& arcs() const { return arcs_; }
  /// Sign 0 where its arcs differ.
  std::array<int, 3> sign() const;
  /// Member at u in [0, 1] of the way round (any u: it goes on), revolute values in the turns next to `near`.
  VectorX at(double u, const VectorX& near) const;

  /// As SolutionCurve does, over the way round.
  Continuum describe(const VectorX& seed, bool ignore_limits) const;

 private:
  const ParallelPlan* plan_;
  const SerialChain* chain_;
  Pose target_;
  int joint_;
  std::vector<LoopArc> arcs_;
};

/// Every loop that has `joint` free. Solutions that turn out to be single points of the kind are added to `points`.
/// Branches are looked for at every two degrees of the joint, and where the plan says that they are farthest in.
std::vector<SolutionLoop> solutionLoops(const ParallelPlan& plan, const SerialChain& chain, const Pose& target,
                                        const VectorX& seed, int joint, std::vector<PlanSolution>& points);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_SOLUTION_LOOP_H
