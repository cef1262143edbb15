#ifndef SCREWLINE_TRAJECTORY_PATH_H
#define SCREWLINE_TRAJECTORY_PATH_H

#include <vector>

#include "screwline/spatial/pose.h"
#include "screwline/trajectory/break_table.h"
#include "screwline/trajectory/piecewise_polynomial.h"
#include "screwline/trajectory/sample_kernel.h"

namespace screwline {

/// A joint path q(u), u in [0, length()], without time: one polynomial per joint and segment, of degree 7 at most, so
/// that its derivatives can be bounded between any two points exactly. What is not a polynomial (the joints along a
/// Cartesian line) comes as quinticPath() through points that are near enough to each other. An immutable value.
class JointPath {
 public:
  JointPath() = default;  ///< No joints, no length.

  /// The pieces with u in place of time. Which derivatives are continuous at each breakpoint is found from the
  /// pieces.
  /// @throws InputError(kInvalidGoal): no segment, breaks that do not increase from 0, a coefficient that is not
  /// finite, positions that do not meet.
  explicit JointPath(PiecewisePolynomial curve);

  int joints() const { return curve_.joints; }
  double length() const { return curve_.duration(); }
  const std::vector<double>& breaks() const { return curve_.breaks; }  ///< 0 .. length().
  const PiecewisePolynomial& curve() const { return curve_; }          ///< u in place of time.

  /// Whether the path turns at breakpoint k (0 < k < segments): dq/du steps there, so a motion has to stop.
  bool turnsAt(std::size_t k) const { return turns_[k]; }
  /// Whether dq/du or d^2q/du^2 steps there: a motion whose acceleration does not step has to stop.
  bool bendsAt(std::size_t k) const { return bends_[k]; }

  /// The segment that holds u; at a breakpoint the later one. Outside the path the nearer end's.
  std::size_t segmentAt(double u) const { return starts_.find(u); }

  /// The polynomials of one segment in x = (u - breaks[k]) / (breaks[k + 1] - breaks[k]).
  SegmentCoefficients segment(std::size_t k) const {
    const std::size_t stride = static_cast<std::size_t>(curve_.degree + 1) * static_cast<std::size_t>(curve_.joints);
    return {curve_.coefficients.data() + k * stride, curve_.joints, curve_.degree};
  }
  double inverseLength(std::size_t k) const { return inverse_lengths_[k]; }

  /// q and its first three derivatives by u, n values each; u outside [0, length()] is taken to the nearer end.
  /// Does not allocate.
  void at(double u, double* q, double* first, double* second, double* third) const;

 private:
  PiecewisePolynomial curve_;
  std::vector<bool> turns_;
  std::vector<bool> bends_;
  BreakTable starts_;
  std::vector<double> inverse_lengths_;
};

/// The natural cubic spline (C2, zero second derivative at the ends) through the columns of positions (n x N, N >= 2)
/// at the given u, which increase from 0. Linear in N. Source: Biagiotti & Melchiorri, section 4.4.
JointPath naturalSplinePath(const std::vector<double>& u, const MatrixX& positions);

/// Straight joint-space lines: it turns at each point.
JointPath linePath(const std::vector<double>& u, const MatrixX& positions);

/// Quintic pieces (C2) through points with their first and second derivatives by u, n x N each: for a path that is
/// followed point by point. Between points h apart it is off by h^6 / 46080 of the sixth derivative.
JointPath quinticPath(const std::vector<double>& u, const MatrixX& positions, const MatrixX& first,
                      const MatrixX& second);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_PATH_H
