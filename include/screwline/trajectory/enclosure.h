#ifndef SCREWLINE_TRAJECTORY_ENCLOSURE_H
#define SCREWLINE_TRAJECTORY_ENCLOSURE_H

#include "screwline/trajectory/joint_trajectory.h"
#include "screwline/trajectory/polynomial.h"

namespace screwline {

/// Intervals that hold every value of a motion over a stretch of time: by the hull of Bernstein coefficients for
/// polynomials (exact at the ends, too wide by the square of the stretch inside), exact for sines. They share nothing
/// with the extrema that plans are made by, which come from roots. Rounding is not directed: good to about 1e-14 of the
/// terms. Nothing here allocates or throws. Source: Farouki & Rajan, On the numerical condition of polynomials in
/// Bernstein form, 1987, for the change of basis.

/// Of a polynomial over [from, to], any interval of the real line.
Range enclosure(const Polynomial& polynomial, double from, double to);

/// Of one derivative (0 position .. 3 jerk, by time) of one joint over [from, to] seconds: closed pieces, so that at a
/// corner both sides count. Outside of [0, duration] the ends are held, with no derivatives. Along a path: of the whole
/// motion, however short the stretch.
Range enclosure(const JointTrajectory& trajectory, int joint, int order, double from, double to);

/// The least interval that holds both.
Range hull(const Range& a, const Range& b);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_ENCLOSURE_H
