#ifndef SCREWLINE_TRAJECTORY_POLYNOMIAL_H
#define SCREWLINE_TRAJECTORY_POLYNOMIAL_H

#include <array>

namespace screwline {

/// Real roots of a polynomial, ascending; no heap.
struct Roots {
  std::array<double, 8> at{};
  int count = 0;

  const double* begin() const { return at.data(); }
  const double* end() const { return at.data() + count; }
};

struct Range {
  double lower = 0.0;
  double upper = 0.0;

  double peak() const { return upper > -lower ? upper : -lower; }  ///< Largest magnitude.
};

/// c[0] + c[1] u + ... + c[7] u^7 in the normalised local time u of a segment, u in [0, 1]. No function here allocates
/// or throws.
struct Polynomial {
  static constexpr int kMaxDegree = 7;
  std::array<double, kMaxDegree + 1> c{};

  int degree() const;  ///< Of the highest coefficient that is not zero; 0 for the zero polynomial.
  double operator()(double u) const;
  Polynomial derivative() const;
};

/// Every real root in [0, 1], touching ones included (to 1e-13 of the largest coefficient). The critical points of
/// degree d bracket the roots of degree d, so it descends to the line and climbs back, closing each bracket by
/// safeguarded Newton steps. The zero polynomial has none.
Roots rootsInUnitInterval(const Polynomial& polynomial);

/// Least and greatest value over [0, 1]: the ends and the roots of the derivative.
Range rangeOverUnitInterval(const Polynomial& polynomial);

/// Integral of the square over [0, 1].
double integralOfSquare(const Polynomial& polynomial);

/// Length of the way there and back: the integral of |p'(u)| over [0, 1].
double totalVariation(const Polynomial& polynomial);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_POLYNOMIAL_H
