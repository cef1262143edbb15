#ifndef SCREWLINE_IK_CLOSED_FORM_PARALLEL_SHEET_H
#define SCREWLINE_IK_CLOSED_FORM_PARALLEL_SHEET_H

#include <vector>

#include "screwline/ik/closed_form/plan.h"
#include "screwline/ik/closed_form/planar_problem.h"

namespace screwline {

/// Values of the free joint in between which the links reach, [rad], from < to; to = from + a full turn where they
/// reach all round. At an end the elbow is straight or folded: its two signs meet there and the free joint turns back,
/// or, where the circle only touches what is in reach, they change places and it goes on.
struct SheetStretch {
  double from = 0.0;
  double to = 0.0;
  bool passes_from = false;  ///< The circle touches there: the free joint goes on.
  bool passes_to = false;
  bool straight = false;  ///< The elbow's signs are one all along; from = to: a point.
  bool whole = false;     ///< No end: the links reach all round.

  bool isPoint() const { return from == to; }
};

/// Solutions of three parallel axes where the pair leaves one of its joints free: with that joint's value the place of
/// the third parallel axis runs round a circle about a parallel line, and its heading turns alike (a planar four-bar
/// linkage). Everything that follows is in closed form.
class ParallelSheet {
 public:
  /// Place and heading, as complex numbers, at the free joint's value v: middle + radius e^(i sense v), heading
  /// e^(i sense v).
  struct Circle {
    Turn middle;   ///< [m]
    Turn radius;   ///< [m]
    Turn heading;  ///< Of length 1.
    double sense = 1.0;
  };
  /// The joints that move the plane, in the problem's order, and the sense in which they turn.
  struct PlaneJoints {
    std::array<std::size_t, 3> joint{};
    std::array<double, 3> sense{};
  };

  /// @param plane must outlive it. @param length [m] of the chain. @param fixed the joints outside the plane, with
  /// their signs; exactly one is free.
  ParallelSheet(const PlanarProblem& plane, double length, const PlaneJoints& joints, const Circle& circle,
                const PlanSolution& fixed);

  int joint() const { return static_cast<int>(free_); }  ///< The free one.

  /// In order round the circle; empty where no value is in reach. Allocates.
  std::vector<SheetStretch> stretches() const;

  /// The member with the free joint at `value` and the elbow on the side of `elbow`; with a straight elbow where the
  /// links do not reach. No allocation.
  PlanSolution member(double value, int elbow) const;

 private:
  const PlanarProblem* plane_;
  double length_;
  PlaneJoints joints_;
  Circle circle_;
  PlanSolution fixed_;
  std::size_t free_;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_CLOSED_FORM_PARALLEL_SHEET_H
