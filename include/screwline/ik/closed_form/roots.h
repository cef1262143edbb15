#ifndef SCREWLINE_IK_CLOSED_FORM_ROOTS_H
#define SCREWLINE_IK_CLOSED_FORM_ROOTS_H

#include <array>
#include <cmath>

#include "screwline/spatial/turn.h"

namespace screwline {

/// A real root and the sign of the function's derivative there: it tells roots apart along a path. 0: a double root,
/// where two meet.
struct RealRoot {
  double value = 0.0;  ///< Of a polynomial.
  Turn turn;           ///< Of an equation in an angle.
  int slope = 0;
};

/// Up to four real roots, ascending where they come from a polynomial. `always`: the function is zero everywhere.
struct RealRoots {
  std::array<RealRoot, 4> roots;
  int count = 0;
  bool always = false;

  void add(double value, int slope) { roots[static_cast<std::size_t>(count++)] = {value, Turn(), slope}; }
  void add(const Turn& turn, int slope) { roots[static_cast<std::size_t>(count++)] = {0.0, turn, slope}; }
  const RealRoot* begin() const { return roots.data(); }
  const RealRoot* end() const { return roots.data() + count; }
};

/// Radicands within this share of their terms are what rounding leaves of zero: their two roots are one. No larger than
/// that: 1e-14 swallows roots that are 1e-7 apart, and a stage behind (a wrist near alignment, an axis next to the
/// point) may part them by far more than the 1e-6 at which solutions are one.
constexpr double kDoubleRootTolerance = 1e-15;

/// Radicands this far below zero (of their terms) may be what rounding, or a stage before, has left of a double root:
/// it is proposed, and forward kinematics decides.
constexpr double kReachTolerance = 1e-10;

/// sqrt of a product or difference of squares whose exact value may be zero: `scale` is the size of its terms. Returns
/// 0 from -kReachTolerance * scale to kDoubleRootTolerance * scale, and -1 below.
inline double squareRootOrNone(double radicand, double scale) {
  if (radicand > kDoubleRootTolerance * scale) return std::sqrt(radicand);
  return radicand >= -kReachTolerance * scale ? 0.0 : -1.0;
}

/// k + a cos(x) + b sin(x) = 0. Roots are turns. `scale` is the size below which coefficients are rounding.
RealRoots solveSinusoid(double k, double a, double b, double scale);

/// Real roots of c[0] + c[1] x + ... + c[degree] x^degree, degree <= 4, by bracketing between the roots of the
/// derivative: no root is lost where two are close, touching roots are found once. `scale`: of the terms that the
/// coefficients were made of; what they have lost by cancelling is rounding.
RealRoots solvePolynomial(const double* c, int degree, double scale);

/// k + a cos(x) + b sin(x) + c cos(2x) + d sin(2x) = 0; as solvePolynomial() in a half-angle tangent whose pole is put
/// where the function is largest.
RealRoots solveSecondHarmonic(double k, double a, double b, double c, double d, double scale);

}  // namespace screwline

#endif  // SCREWLINE_IK_CLOSED_FORM_ROOTS_H
