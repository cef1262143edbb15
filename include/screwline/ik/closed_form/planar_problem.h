#ifndef SCREWLINE_IK_CLOSED_FORM_PLANAR_PROBLEM_H
#define SCREWLINE_IK_CLOSED_FORM_PLANAR_PROBLEM_H

#include <array>
#include <optional>

#include "screwline/spatial/turn.h"

namespace screwline {

/// One way to bring the third axis to its place and the frame behind it to its heading.
struct PlanarSolution {
  std::array<Turn, 3> turns;
  bool free = false;     ///< The links fold onto axis 1, any turn about it does; the first turn is the preferred one.
  int sign = 0;          ///< Of the sine of the elbow's angle, 0 where it is straight or folded.
  bool clamped = false;  ///< Exists only if the place is moved within its error.
};

struct PlanarSolutions {
  std::array<PlanarSolution, 2> solutions;
  int count = 0;

  const PlanarSolution* begin() const { return solutions.data(); }
  const PlanarSolution* end() const { return solutions.data() + count; }
};

/// Three parallel axes in their plane: two links bring the third axis to its place, the third turn makes the heading.
/// No allocation.
class PlanarProblem {
 public:
  static constexpr double kNoSlack = 1e-14;  ///< Of the length: a triangle this near to a line is one.

  /// Links from axis to axis at zero, as complex numbers [m]. `length` [m] is the chain's size. Empty where a link has
  /// no length.
  static std::optional<PlanarProblem> compile(const Turn& first_link, const Turn& second_link, double length);

  /// @param x, y [m] place of axis 3 from axis 1.
  /// @param error [m] of the place, beyond rounding.
  /// @param preferred [rad] first turn where it is free.
  void solve(double x, double y, const Turn& heading, double error, double preferred, PlanarSolutions& solutions) const;

  /// Distances of axis 3 from axis 1 that the links reach.
  double least() const { return std::abs(first_length_ - second_length_); }
  double most() const { return first_length_ + second_length_; }
  /// Of the sine of the elbow's angle, straight counting as zero.
  double elbowSine(const Turn& second) const { return (bend_ * second).s; }

 private:
  Turn first_link_;   ///< Not of unit length.
  Turn second_link_;  ///< Not of unit length.
  double first_length_ = 1.0;
  double second_length_ = 1.0;
  Turn bend_;  ///< Of the second link from the first at zero.
  double length_ = 1.0;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_CLOSED_FORM_PLANAR_PROBLEM_H
