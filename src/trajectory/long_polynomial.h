#ifndef SCREWLINE_TRAJECTORY_LONG_POLYNOMIAL_H
#define SCREWLINE_TRAJECTORY_LONG_POLYNOMIAL_H

#include <array>

#include "screwline/trajectory/polynomial.h"
#include "screwline/trajectory/sample_kernel.h"

namespace screwline {

/// A polynomial over [0, 1] of the degree that a composition of two others has. Only c[0 .. degree] are filled. No
/// function here allocates.
struct LongPolynomial {
  static constexpr int kMaxDegree = Polynomial::kMaxDegree * Polynomial::kMaxDegree;
  int degree = 0;
  std::array<double, kMaxDegree + 1> c;
};

/// The polynomial of one joint of a segment, of x(w).
LongPolynomial compose(const SegmentCoefficients& segment, int joint, const Polynomial& x, int x_degree);

/// Its derivative times a rate.
LongPolynomial derivative(const LongPolynomial& p, double rate);

double valueAtOne(const LongPolynomial& p);

/// The largest of |p| over [0, 1] and `known`: at most 1e-13 of itself above it, never below. The coefficients in
/// Bernstein form bound the polynomial; where they may pass what is known the interval is halved.
double largestMagnitude(const LongPolynomial& p, double known);

/// Integral of the square over [0, 1].
double integralOfSquare(const LongPolynomial& p);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_LONG_POLYNOMIAL_H
