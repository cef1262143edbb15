#ifndef SCREWLINE_TRAJECTORY_HERMITE_H
#define SCREWLINE_TRAJECTORY_HERMITE_H

#include <vector>

#include "screwline/spatial/pose.h"
#include "screwline/trajectory/piecewise_polynomial.h"

namespace screwline {

/// One joint's value and derivatives by time at an end of a segment.
struct EndState {
  double position = 0.0;
  double velocity = 0.0;
  double acceleration = 0.0;
};

/// The polynomial in u = t / length that has the given positions and velocities (and accelerations) at both ends.
/// @pre length > 0 [s]. Do not allocate. Source: Biagiotti & Melchiorri, section 2.1.
Polynomial cubicBetween(const EndState& first, const EndState& last, double length);
Polynomial quinticBetween(const EndState& first, const EndState& last, double length);

/// Motions through the columns of n x N matrices at N increasing instants, the first 0: straight lines (C0), cubics
/// that meet the velocities (C1), quintics that also meet the accelerations (C2). An end with a velocity or
/// acceleration other than zero is a moving one. @pre N >= 2, equal sizes.
PiecewisePolynomial linesThrough(const std::vector<double>& times, const MatrixX& positions);
PiecewisePolynomial cubicsThrough(const std::vector<double>& times, const MatrixX& positions,
                                  const MatrixX& velocities);
PiecewisePolynomial quinticsThrough(const std::vector<double>& times, const MatrixX& positions,
                                    const MatrixX& velocities, const MatrixX& accelerations);

/// Velocities (n x N) that make the cubics through the positions C2, for given velocities at both ends: one tridiagonal
/// solve for all joints, linear in N. Source: Biagiotti & Melchiorri, section 4.4.
MatrixX splineVelocities(const std::vector<double>& times, const MatrixX& positions, const VectorX& first_velocity,
                         const VectorX& last_velocity);

/// The same with zero acceleration at both ends (the natural spline).
MatrixX naturalSplineSlopes(const std::vector<double>& times, const MatrixX& positions);

/// Accelerations (n x N) at the knots of those cubics.
MatrixX splineAccelerations(const std::vector<double>& times, const MatrixX& positions, const MatrixX& velocities);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_HERMITE_H
