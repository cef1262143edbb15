#ifndef SCREWLINE_IK_CLOSED_FORM_DIRECTION_PROBLEM_H
#define SCREWLINE_IK_CLOSED_FORM_DIRECTION_PROBLEM_H

#include <array>
#include <optional>

#include "screwline/spatial/turn.h"

namespace screwline {

/// One way to turn the direction to its goal.
struct DirectionSolution {
  Turn first;
  Turn second;
  bool first_free = false;  ///< The goal is in line with axis 1: any turn about it does; `first` has the preferred one.
  bool second_free = false;  ///< The start is in line with axis 2.
  int sign = 0;              ///< Of the triple product of axis 1, axis 2 and the direction between; 0: two meet.
  double error = 0.0;        ///< [rad] by which rounding and the inputs' error may move the looser of the turns.
  double tight_error = 0.0;  ///< [rad] The same of the other one.
  bool first_loose = false;  ///< The looser one is the first (goal nearly in line), else the second.
  bool clamped = false;      ///< Exists only if the inputs are moved within their error.
};

struct DirectionSolutions {
  std::array<DirectionSolution, 2> solutions;
  int count = 0;

  const DirectionSolution* begin() const { return solutions.data(); }
  const DirectionSolution* end() const { return solutions.data() + count; }
};

/// R1(q1) R2(q2) start = goal for unit vectors and two axes that are not parallel (Paden's second subproblem). The
/// direction between the two turns has known components along both axes; what is left of it is across both, up to its
/// sign. No allocation.
class DirectionProblem {
 public:
  /// Empty where the axes are parallel.
  static std::optional<DirectionProblem> compile(const Vector3& first, const Vector3& second);

  /// @param error [rad] of start and goal, beyond rounding.
  /// @param preferred_first, preferred_second [rad] turns where they are free.
  void solve(const Vector3& start, const Vector3& goal, double error, double preferred_first, double preferred_second,
             DirectionSolutions& solutions) const;

 private:
  Vector3 first_ = Vector3::UnitZ();
  Vector3 second_ = Vector3::UnitX();
  Vector3 across_;       ///< Both axes, unit.
  Vector3 first_side_;   ///< Axis 2 across axis 1, unit.
  Vector3 second_side_;  ///< Axis 1 across axis 2, unit.
  double cosine_ = 0.0;  ///< Of the angle between the axes.
  double sine_ = 1.0;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_CLOSED_FORM_DIRECTION_PROBLEM_H
