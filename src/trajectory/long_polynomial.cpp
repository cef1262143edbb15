#include "long_polynomial.h"

#include <algorithm>
#include <cmath>

namespace screwline {
namespace {

constexpr double kTight = 1e-13;
constexpr int kMostHalvings = 40;

std::size_t index(int k) {
  return static_cast<std::size_t>(k);
}

/// From powers to Bernstein form, in place: b_i = sum over k of C(i, k) / C(n, k) c_k.
void toBernstein(LongPolynomial& p) {
  const int n = p.degree;
  double binomial = 1.0;
  for (int k = 0; k <= n; ++k) {
    p.c[index(k)] /= binomial;
    binomial *= static_cast<double>(n - k) / (k + 1);
  }
  for (int pass = 1; pass <= n; ++pass) {
    for (int i = n; i >= pass; --i) p.c[index(i)] += p.c[index(i - 1)];
  }
}

double raise(const LongPolynomial& b, double known, int halvings) {
  const int n = b.degree;
  const double attained = std::max({known, std::abs(b.c[0]), std::abs(b.c[index(n)])});
  double bound = attained;
  for (int i = 1; i < n; ++i) bound = std::max(bound, std::abs(b.c[index(i)]));
  if (bound <= attained * (1.0 + kTight) || halvings == 0) return bound;
  // De Casteljau at the middle: the left half's coefficients are the first of each pass, the right half remains.
  LongPolynomial left;
  LongPolynomial right = b;
  left.degree = n;
  for (int pass = 0; pass <= n; ++pass) {
    left.c[index(pass)] = right.c[0];
    for (int i = 0; i < n - pass; ++i) right.c[index(i)] = 0.5 * (right.c[index(i)] + right.c[index(i + 1)]);
  }
  return raise(right, raise(left, attained, halvings - 1), halvings - 1);
}

}  // namespace

LongPolynomial compose(const SegmentCoefficients& segment, int joint, const Polynomial& x, int x_degree) {
  LongPolynomial sum;
  LongPolynomial product;
  const auto power = [&](int k) { return segment.c[k * segment.joints + joint]; };
  sum.degree = 0;
  sum.c[0] = power(segment.degree);
  for (int k = segment.degree; k-- > 0;) {
    product.degree = sum.degree + x_degree;
    std::fill_n(product.c.begin(), product.degree + 1, 0.0);
    for (int i = 0; i <= sum.degree; ++i) {
      for (int m = 0; m <= x_degree; ++m) product.c[index(i + m)] += sum.c[index(i)] * x.c[index(m)];
    }
    product.c[0] += power(k);
    std::swap(sum, product);
  }
  return sum;
}

LongPolynomial derivative(const LongPolynomial& p, double rate) {
  LongPolynomial d;
  d.degree = std::max(0, p.degree - 1);
  d.c[0] = 0.0;
  for (int k = 1; k <= p.degree; ++k) d.c[index(k - 1)] = rate * k * p.c[index(k)];
  return d;
}

double valueAtOne(const LongPolynomial& p) {
  double sum = 0.0;
  for (int k = 0; k <= p.degree; ++k) sum += p.c[index(k)];
  return sum;
}

double largestMagnitude(const LongPolynomial& p, double known) {
  LongPolynomial bernstein = p;
  toBernstein(bernstein);
  return raise(bernstein, known, kMostHalvings);
}

double integralOfSquare(const LongPolynomial& p) {
  double integral = 0.0;
  for (int i = 0; i <= p.degree; ++i) {
    for (int k = 0; k <= p.degree; ++k) integral += p.c[index(i)] * p.c[index(k)] / (i + k + 1);
  }
  return std::max(0.0, integral);
}

}  // namespace screwline
