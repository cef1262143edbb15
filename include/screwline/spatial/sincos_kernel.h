#ifndef SCREWLINE_SPATIAL_SINCOS_KERNEL_H
#define SCREWLINE_SPATIAL_SINCOS_KERNEL_H

#include <cstring>

namespace screwline {

/// Sine and cosine of |angle| <= 1e6 [rad], absolute error below 2.3e-16, without a branch: of one double (Bits: a
/// 64-bit unsigned integer) or of a vector of them (Bits: of as many such integers), each lane alike. For sincosMany()
/// and the batch kernels. Source: Cody & Waite reduction in three parts, minimax polynomials on [-pi/4, pi/4] (as in
/// fdlibm's kernel functions).
template <typename Bits, typename Real>
[[gnu::always_inline]] inline void sincosKernel(const Real& angle, Real& sine, Real& cosine) {
  static_assert(sizeof(Bits) == sizeof(Real), "as many bits as reals");
  constexpr double kTwoOverPi = 6.36619772367581382433e-01;
  // pi/2 in parts of 33 bits: k * part is exact for |k| < 2^20.
  constexpr double kHalfPi1 = 1.57079632673412561417e+00;
  constexpr double kHalfPi2 = 6.07710050630396597660e-11;
  constexpr double kHalfPi3 = 2.02226624879595063154e-21;
  // Adding and subtracting 1.5 * 2^52 rounds to the nearest integer, without a branch or an SSE4 instruction.
  constexpr double kRounder = 6755399441055744.0;

  const Real rounded = angle * kTwoOverPi + kRounder;
  const Real k = rounded - kRounder;
  const Real x = ((angle - k * kHalfPi1) - k * kHalfPi2) - k * kHalfPi3;
  const Real x2 = x * x;

  Real s = x2 * 1.58969099521155010221e-10 - 2.50507602534068634195e-08;
  s = s * x2 + 2.75573137070700676789e-06;
  s = s * x2 - 1.98412698298579493134e-04;
  s = s * x2 + 8.33333333332248946124e-03;
  s = s * x2 - 1.66666666666666324348e-01;
  s = x + x * (x2 * s);

  Real c = x2 * -1.13596475577881948265e-11 + 2.08757232129817482790e-09;
  c = c * x2 - 2.75573143513906633035e-07;
  c = c * x2 + 2.48015872894767294178e-05;
  c = c * x2 - 1.38888888888741095749e-03;
  c = c * x2 + 4.16666666666666019037e-02;
  c = 1.0 - 0.5 * x2 + x2 * x2 * c;

  Bits quadrant;
  Bits s_bits;
  Bits c_bits;
  std::memcpy(&quadrant, &rounded, sizeof quadrant);  // The low bits of `rounded` are those of k.
  std::memcpy(&s_bits, &s, sizeof s_bits);
  std::memcpy(&c_bits, &c, sizeof c_bits);
  const Bits odd = 0U - (quadrant & 1U);
  const Bits sine_bits = ((c_bits & odd) | (s_bits & ~odd)) ^ ((quadrant & 2U) << 62U);
  const Bits cosine_bits = ((s_bits & odd) | (c_bits & ~odd)) ^ (((quadrant + 1U) & 2U) << 62U);
  std::memcpy(&sine, &sine_bits, sizeof sine);
  std::memcpy(&cosine, &cosine_bits, sizeof cosine);
}

}  // namespace screwline

#endif  // SCREWLINE_SPATIAL_SINCOS_KERNEL_H
