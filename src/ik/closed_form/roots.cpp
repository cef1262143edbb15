#include "screwline/ik/closed_form/roots.h"

#include <algorithm>
#include <cmath>

namespace screwline {
namespace {

constexpr double kNegligible = 1e-13;  // Of `scale`: coefficients below it are rounding.

/// Multiples of pi/4.
constexpr double kRootHalf = 0.70710678118654752440;
constexpr Turn kEighths[] = {{1.0, 0.0},  {kRootHalf, kRootHalf},   {0.0, 1.0},  {-kRootHalf, kRootHalf},
                             {-1.0, 0.0}, {-kRootHalf, -kRootHalf}, {0.0, -1.0}, {kRootHalf, -kRootHalf}};

int signOf(double x) {
  return (x > 0.0) - (x < 0.0);
}

double evaluate(const double* c, int degree, double x) {
  double value = c[degree];
  for (int i = degree - 1; i >= 0; --i) value = value * x + c[i];
  return value;
}

/// Sum of the magnitudes of the terms: what rounding of the value is measured by.
double magnitude(const double* c, int degree, double x) {
  double value = std::abs(c[degree]);
  for (int i = degree - 1; i >= 0; --i) value = value * std::abs(x) + std::abs(c[i]);
  return value;
}

/// `scale`: as solveBetween()'s.
RealRoots solveQuadratic(const double* c, double scale) {
  RealRoots roots;
  const double half = 0.5 * c[1];
  const double size = half * half + std::abs(c[2]) * std::max(std::abs(c[0]), scale);
  const double root = squareRootOrNone(half * half - c[2] * c[0], size);
  if (root < 0.0) return roots;
  if (root == 0.0) {
    roots.add(-half / c[2], 0);
    return roots;
  }
  // The root that does not cancel first; the other from the product of the roots.
  const double sum = -(half + std::copysign(root, half));
  double first = sum / c[2];
  double second = c[0] / sum;
  if (first > second) std::swap(first, second);
  const int slope = signOf(c[2]);
  roots.add(first, -slope);
  roots.add(second, slope);
  return roots;
}

/// The root in (low, high), where the polynomial is monotone and changes sign: Newton's method, kept inside by
/// bisection.
double bracketedRoot(const double* c, int degree, double low, double high, int sign_low) {
  double x = 0.5 * (low + high);
  for (int i = 0; i < 200; ++i) {
    double value = c[degree];
    double slope = 0.0;
    for (int k = degree - 1; k >= 0; --k) {
      slope = slope * x + value;
      value = value * x + c[k];
    }
    if (value == 0.0) return x;
    (signOf(value) == sign_low ? low : high) = x;
    double next = x - value / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - x) <= 4e-16 * std::abs(next) || next == low || next == high) return next;
    x = next;
  }
  return x;
}

/// Whether an extremum comes near to zero without passing it.
bool almostTouches(const double* c, int degree, double x, double value, double size) {
  double curvature = 0.0;
  for (int i = degree; i >= 2; --i) curvature = curvature * x + i * (i - 1) * c[i];
  return value * curvature > 0.0 && std::abs(value) <= kReachTolerance * size;
}

/// RealRoots of a polynomial of degree 3 or 4 from its critical points. `scale`: of the terms that the coefficients
/// were made of, which they do not show where those cancel.
RealRoots solveBetween(const double* c, int degree, const RealRoots& critical, double scale) {
  double bound = 0.0;
  for (int i = 0; i < degree; ++i) bound = std::max(bound, std::abs(c[i] / c[degree]));
  bound += 1.0;  // Cauchy: all roots lie within.
  RealRoots roots;
  double low = -bound;
  int sign_low = signOf(c[degree]) * (degree % 2 == 0 ? 1 : -1);
  for (int i = 0; i <= critical.count; ++i) {
    const bool last = i == critical.count;
    const double high = last ? bound : critical.roots[static_cast<std::size_t>(i)].value;
    int sign_high = signOf(c[degree]);
    double value = 0.0;
    double size = 0.0;
    if (!last) {
      value = evaluate(c, degree, high);
      size = std::max(magnitude(c, degree, high), scale);
      sign_high = std::abs(value) <= kDoubleRootTolerance * size ? 0 : signOf(value);
    }
    if (sign_low * sign_high < 0) roots.add(bracketedRoot(c, degree, low, high, sign_low), sign_high);
    const bool touches = !last && (sign_high == 0 || almostTouches(c, degree, high, value, size));
    if (touches && roots.count < 4) roots.add(high, 0);
    low = high;
    sign_low = sign_high;
  }
  return roots;
}

}  // namespace

RealRoots solveSinusoid(double k, double a, double b, double scale) {
  RealRoots roots;
  const double amplitude = std::sqrt(a * a + b * b);
  if (amplitude <= kNegligible * scale) {
    roots.always = std::abs(k) <= kNegligible * scale;
    return roots;
  }
  const double root = squareRootOrNone((amplitude - k) * (amplitude + k), amplitude * std::max(amplitude, scale));
  if (root < 0.0) return roots;
  const Turn middle = {a / amplitude, b / amplitude};
  if (root == 0.0) {
    roots.add(k < 0.0 ? middle : middle.opposite(), 0);
    return roots;
  }
  const Turn half_width = {-k / amplitude, root / amplitude};
  roots.add(middle * half_width.inverse(), 1);
  roots.add(middle * half_width, -1);
  return roots;
}

RealRoots solvePolynomial(const double* c, int degree, double scale) {
  while (degree > 0 && std::abs(c[degree]) <= kNegligible * scale) --degree;
  RealRoots roots;
  if (degree == 0) {
    roots.always = std::abs(c[0]) <= kNegligible * scale;
    return roots;
  }
  if (degree == 1) {
    roots.add(-c[0] / c[1], signOf(c[1]));
    return roots;
  }
  if (degree == 2) return solveQuadratic(c, scale);
  std::array<double, 4> derivative{};
  for (int i = 1; i <= degree; ++i) derivative[static_cast<std::size_t>(i - 1)] = i * c[i];
  return solveBetween(c, degree, solvePolynomial(derivative.data(), degree - 1, 0.0), scale);
}

RealRoots solveSecondHarmonic(double k, double a, double b, double c, double d, double scale) {
  if (std::sqrt(c * c + d * d) <= kNegligible * scale) return solveSinusoid(k, a, b, scale);
  Turn pole;
  double largest = -1.0;
  for (const Turn& turn : kEighths) {
    const Turn twice = turn * turn;
    const double value = std::abs(k + a * turn.c + b * turn.s + c * twice.c + d * twice.s);
    if (value <= largest) continue;
    largest = value;
    pole = turn;
  }
  // y = x - shift, so that y = pi, where tan(y/2) is infinite, is the pole.
  const Turn shift = pole.opposite();
  const Turn twice = shift * shift;
  const double ay = a * shift.c + b * shift.s;
  const double by = b * shift.c - a * shift.s;
  const double cy = c * twice.c + d * twice.s;
  const double dy = d * twice.c - c * twice.s;
  // (1 + t^2)^2 times the function, with t = tan(y/2).
  const double quartic[5] = {k + ay + cy, 2.0 * by + 4.0 * dy, 2.0 * k - 6.0 * cy, 2.0 * by - 4.0 * dy, k - ay + cy};
  const double terms = std::abs(k) + std::abs(a) + std::abs(b) + std::abs(c) + std::abs(d);
  RealRoots roots = solvePolynomial(quartic, 4, terms);
  for (int i = 0; i < roots.count; ++i) {
    RealRoot& root = roots.roots[static_cast<std::size_t>(i)];
    const double t = root.value;
    const double scale_y = 1.0 / (1.0 + t * t);
    root.turn = shift * Turn{(1.0 - t * t) * scale_y, 2.0 * t * scale_y};
  }
  return roots;
}

}  // namespace screwline
