#include "screwline/trajectory/polynomial.h"

#include <algorithm>
#include <cmath>

namespace screwline {
namespace {

constexpr double kTouching = 1e-13;  // Of the largest coefficient: below it a critical point counts as a double root.

double magnitude(const Polynomial& polynomial) {
  double largest = 0.0;
  for (double c : polynomial.c) largest = std::max(largest, std::abs(c));
  return largest;
}

/// The root in [lower, upper], where the values at the ends differ in sign. Newton, with bisection where it leaves the
/// bracket.
double closeBracket(const Polynomial& polynomial, const Polynomial& slope, double lower, double upper) {
  const bool rising = polynomial(upper) > 0.0;
  double u = 0.5 * (lower + upper);
  for (int iteration = 0; iteration < 80; ++iteration) {
    const double value = polynomial(u);
    if (value == 0.0) return u;
    ((value > 0.0) == rising ? upper : lower) = u;
    const double newton = u - value / slope(u);
    const double next = newton > lower && newton < upper ? newton : 0.5 * (lower + upper);
    if (std::abs(next - u) <= 1e-16 || upper - lower <= 1e-16) return next;
    u = next;
  }
  return u;
}

Roots linearRoot(const Polynomial& polynomial) {
  Roots roots;
  const double u = -polynomial.c[0] / polynomial.c[1];
  if (u >= 0.0 && u <= 1.0) roots.at[static_cast<std::size_t>(roots.count++)] = u;
  return roots;
}

void append(Roots& roots, double u) {
  if (roots.count > 0 && roots.at[static_cast<std::size_t>(roots.count - 1)] >= u) return;
  if (roots.count < static_cast<int>(roots.at.size())) roots.at[static_cast<std::size_t>(roots.count++)] = u;
}

}  // namespace

int Polynomial::degree() const {
  int d = kMaxDegree;
  while (d > 0 && c[static_cast<std::size_t>(d)] == 0.0) --d;
  return d;
}

double Polynomial::operator()(double u) const {
  double value = c[kMaxDegree];
  for (std::size_t k = kMaxDegree; k-- > 0;) value = value * u + c[k];
  return value;
}

Polynomial Polynomial::derivative() const {
  Polynomial result;
  for (std::size_t k = 1; k < c.size(); ++k) result.c[k - 1] = static_cast<double>(k) * c[k];
  return result;
}

Roots rootsInUnitInterval(const Polynomial& polynomial) {
  const int degree = polynomial.degree();
  if (degree == 0) return {};
  if (degree == 1) return linearRoot(polynomial);

  const Polynomial slope = polynomial.derivative();
  const Roots critical = rootsInUnitInterval(slope);
  const double touching = kTouching * magnitude(polynomial);
  Roots roots;
  double lower = 0.0;
  double at_lower = polynomial(lower);
  if (std::abs(at_lower) <= touching) append(roots, lower);
  for (int i = 0; i <= critical.count; ++i) {
    const double upper = i < critical.count ? critical.at[static_cast<std::size_t>(i)] : 1.0;
    const double at_upper = polynomial(upper);
    const bool ends_count = std::abs(at_lower) > touching && std::abs(at_upper) > touching;
    if (ends_count && (at_lower > 0.0) != (at_upper > 0.0))
      append(roots, closeBracket(polynomial, slope, lower, upper));
    if (std::abs(at_upper) <= touching) append(roots, upper);
    lower = upper;
    at_lower = at_upper;
  }
  return roots;
}

Range rangeOverUnitInterval(const Polynomial& polynomial) {
  const double first = polynomial(0.0);
  const double last = polynomial(1.0);
  Range range{std::min(first, last), std::max(first, last)};
  for (double u : rootsInUnitInterval(polynomial.derivative())) {
    const double value = polynomial(u);
    range.lower = std::min(range.lower, value);
    range.upper = std::max(range.upper, value);
  }
  return range;
}

double integralOfSquare(const Polynomial& polynomial) {
  double integral = 0.0;
  for (std::size_t i = 0; i < polynomial.c.size(); ++i) {
    for (std::size_t k = 0; k < polynomial.c.size(); ++k) {
      integral += polynomial.c[i] * polynomial.c[k] / static_cast<double>(i + k + 1);
    }
  }
  return std::max(0.0, integral);
}

double totalVariation(const Polynomial& polynomial) {
  double variation = 0.0;
  double previous = polynomial(0.0);
  for (double u : rootsInUnitInterval(polynomial.derivative())) {
    const double value = polynomial(u);
    variation += std::abs(value - previous);
    previous = value;
  }
  return variation + std::abs(polynomial(1.0) - previous);
}

}  // namespace screwline
