#ifndef SCREWLINE_IK_CLOSED_FORM_ORIENTATION_PROBLEM_H
#define SCREWLINE_IK_CLOSED_FORM_ORIENTATION_PROBLEM_H

#include <array>
#include <optional>

#include "screwline/model/joint.h"

namespace screwline {

/// One way to turn to the goal.
struct OrientationSolution {
  std::array<double, 3> q{};  ///< [rad], not wrapped.
  bool free = false;  ///< Axes 1 and 3 are in line: only a sum of their angles is fixed; q[0] is the preferred value.
  int sign = 0;  ///< Of the sine of the middle angle from where axes 1 and 3 come nearest; 0 where two solutions meet.
};

struct OrientationSolutions {
  std::array<OrientationSolution, 2> solutions;
  int count = 0;

  const OrientationSolution* begin() const { return solutions.data(); }
  const OrientationSolution* end() const { return solutions.data() + count; }
};

/// R1(q1) R2(q2) R3(q3) = Q for three revolute axes of any directions (neighbours not parallel): what axis 1 keeps of
/// axis 3's image gives the middle angle, the others follow (Paden's second subproblem; Craig, ch. 4.7). Solving
/// allocates nothing.
class OrientationProblem {
 public:
  /// Empty where neighbouring directions are parallel.
  static std::optional<OrientationProblem> compile(const std::array<Axis, 3>& axes);

  /// @param preferred value of q1 where it turns out free.
  void solve(const Matrix3& Q, double preferred, OrientationSolutions& solutions) const;

 private:
  std::array<Vector3, 3> axis_;
  double first_angle_ = 0.0;   ///< Between axes 1 and 2, in (0, pi).
  double second_angle_ = 0.0;  ///< Between axes 2 and 3.
  double nearest_ = 0.0;       ///< Middle angle at which axis 3 is nearest to axis 1.
  Vector3 x1_, y1_;            ///< Across axis 1.
  Vector3 x3_, y3_;            ///< Across axis 3.
};

}  // namespace screwline

#endif  // SCREWLINE_IK_CLOSED_FORM_ORIENTATION_PROBLEM_H
