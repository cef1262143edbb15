#ifndef SCREWLINE_TRAJECTORY_BSPLINE_H
#define SCREWLINE_TRAJECTORY_BSPLINE_H

#include <vector>

#include "screwline/spatial/pose.h"
#include "screwline/trajectory/piecewise_polynomial.h"

namespace screwline {

/// A clamped B-spline over [knots.front(), knots.back()]: knots.size() = control.cols() + degree + 1, not decreasing.
struct Bspline {
  int degree = 3;             ///< 1 .. Polynomial::kMaxDegree.
  std::vector<double> knots;  ///< [s]
  MatrixX control;            ///< n x control points.
};

/// degree + 1 copies of 0 and of the duration around the interior knots.
std::vector<double> clampedKnots(int degree, const std::vector<double>& interior, double duration);

/// The same curve as polynomials between its distinct knots: de Boor's recursion carried out on polynomials. Continuity
/// is degree - 1 (at most 3), for simple interior knots. Source: Biagiotti & Melchiorri, appendix B.
PiecewisePolynomial piecesOf(const Bspline& spline);

/// Velocities and accelerations of all joints where a spline begins and ends, n values each; empty: zero.
struct SplineEnds {
  VectorX first_velocity;
  VectorX first_acceleration;
  VectorX last_velocity;
  VectorX last_acceleration;

  bool firstRests() const { return first_velocity.isZero(0.0) && first_acceleration.isZero(0.0); }
  bool lastRests() const { return last_velocity.isZero(0.0) && last_acceleration.isZero(0.0); }
};

/// Replaces the `count` - 1 control points next to either end so that the spline has the derivatives of `ends` there
/// (and zero jerk where count is 4): the recursion of the control points of derivatives, read backwards.
/// @pre simple interior knots, at least 2 count control points. Source: Biagiotti & Melchiorri, appendix B.
void meetEnds(const SplineEnds& ends, int count, Bspline& spline);

/// The B-spline through the columns of positions (n x N, N >= 2) at the instants, with the velocities and accelerations
/// of `ends` (and, from degree 6, zero jerk). Knots: the instants for odd degrees (3: and one inside the first and the
/// last segment), the middles of the segments for even ones, so the banded system is square and never singular
/// (Schoenberg-Whitney). Linear in N. @pre degree 3 .. 7, instants strictly increasing from 0.
Bspline interpolatingBspline(int degree, const std::vector<double>& times, const MatrixX& positions,
                             const SplineEnds& ends = {});

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_BSPLINE_H
