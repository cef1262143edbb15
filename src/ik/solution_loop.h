#ifndef SCREWLINE_SRC_IK_SOLUTION_LOOP_H
#define SCREWLINE_SRC_IK_SOLUTION_LOOP_H

#include <functional>
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

/// The member of an arc with the free joint at a value; where the branch ends there and rounding left none, the one
/// next to `near`.
using ArcMember = std::function<MemberVector(const LoopArc& arc, double value, const MemberVector& near)>;

/// A continuum of one dimension at a singular pose: a closed curve of solutions, exact members all the way round. Where
/// the free joint turns back, two branches meet: one arc ends there and the next one begins.
class SolutionLoop {
 public:
  SolutionLoop(const SerialChain& chain, int joint, std::vector<LoopArc> arcs, ArcMember member);

  int joint() const { return joint_; }
  const std::vector<LoopArc>& arcs() const { return arcs_; }
  /// Sign 0 where its arcs differ.
  std::array<int, 3> sign() const;
  /// Member at u in [0, 1] of the way round (any u: it goes on), revolute values in the turns next to `near`.
  MemberVector at(double u, const MemberVector& near) const;

  /// By u. Holds a copy of the loop.
  WayRound round() const;

 private:
  const SerialChain* chain_;
  int joint_;
  std::vector<LoopArc> arcs_;
  ArcMember member_;
};

/// Loops that have one joint free, and solutions of the kind that turn out to be single points.
struct SolutionLoops {
  std::vector<SolutionLoop> loops;
  std::vector<PlanSolution> points;
};

/// Those that leave a joint of the pair free, in closed form. Plan and chain must outlive them.
SolutionLoops loopsOfPair(const ParallelPlan& plan, const SerialChain& chain, const Pose& target);

/// Those that have `joint` free, whichever it is: branches are looked for at every two degrees of it.
SolutionLoops sampledLoops(const ParallelPlan& plan, const SerialChain& chain, const Pose& target, const VectorX& seed,
                           int joint);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_SOLUTION_LOOP_H
