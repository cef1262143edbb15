#include "screwline/spatial/sincos.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace screwline {
namespace {

constexpr double kTwoOverPi = 6.36619772367581382433e-01;
// pi/2 in parts of 33 bits: k * part is exact for |k| < 2^20.
constexpr double kHalfPi1 = 1.57079632673412561417e+00;
constexpr double kHalfPi2 = 6.07710050630396597660e-11;
constexpr double kHalfPi3 = 2.02226624879595063154e-21;
// Adding and subtracting 1.5 * 2^52 rounds to the nearest integer, without a branch or an SSE4 instruction.
constexpr double kRounder = 6755399441055744.0;

inline double sinePolynomial(double x, double x2) {
  double p = 1.58969099521155010221e-10;
  p = p * x2 - 2.50507602534068634195e-08;
  p = p * x2 + 2.75573137070700676789e-06;
  p = p * x2 - 1.98412698298579493134e-04;
  p = p * x2 + 8.33333333332248946124e-03;
  p = p * x2 - 1.66666666666666324348e-01;
  return x + x * (x2 * p);
}

inline double cosinePolynomial(double x2) {
  double p = -1.13596475577881948265e-11;
  p = p * x2 + 2.08757232129817482790e-09;
  p = p * x2 - 2.75573143513906633035e-07;
  p = p * x2 + 2.48015872894767294178e-05;
  p = p * x2 - 1.38888888888741095749e-03;
  p = p * x2 + 4.16666666666666019037e-02;
  return 1.0 - 0.5 * x2 + x2 * x2 * p;
}

inline double select(std::uint64_t mask, double if_set, double if_clear) {
  std::uint64_t a = 0;
  std::uint64_t b = 0;
  std::memcpy(&a, &if_set, sizeof a);
  std::memcpy(&b, &if_clear, sizeof b);
  const std::uint64_t bits = (a & mask) | (b & ~mask);
  double result = 0.0;
  std::memcpy(&result, &bits, sizeof result);
  return result;
}

inline double withSign(double value, std::uint64_t sign_bit) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  bits ^= sign_bit;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace

void sincosMany(const double* __restrict angle, double* __restrict sine, double* __restrict cosine, int count) {
  for (int i = 0; i < count; ++i) {
    const double rounded = angle[i] * kTwoOverPi + kRounder;
    const double k = rounded - kRounder;
    const double x = ((angle[i] - k * kHalfPi1) - k * kHalfPi2) - k * kHalfPi3;
    std::uint64_t quadrant = 0;
    std::memcpy(&quadrant, &rounded, sizeof quadrant);  // The low bits of `rounded` are those of k.
    const double x2 = x * x;
    const double s = sinePolynomial(x, x2);
    const double c = cosinePolynomial(x2);
    const std::uint64_t odd = 0 - (quadrant & 1U);
    sine[i] = withSign(select(odd, c, s), (quadrant & 2U) << 62U);
    cosine[i] = withSign(select(odd, s, c), ((quadrant + 1U) & 2U) << 62U);
  }
}

}  // namespace screwline
