#ifndef SCREWLINE_SPATIAL_ATAN2_KERNEL_H
#define SCREWLINE_SPATIAL_ATAN2_KERNEL_H

#include <cstdint>
#include <cstring>

namespace screwline {

/// Angle of the point (x, y) in [-pi, pi], within 2 units in the last place, without a branch: of one double (Bits: a
/// 64-bit unsigned integer) or of a vector of them (Bits: of as many such integers), each lane alike. 0 at the origin.
/// Numbers are finite and below 1e300; NaN stays NaN. Source: reduction to |t| <= tan(pi/8), there t + t^3 P(t^2) with
/// P the minimax polynomial of degree 9 (Remez), relative error 3.6e-17.
template <typename Bits, typename Real>
[[gnu::always_inline]] inline void atan2Kernel(const Real& y, const Real& x, Real& angle) {
  static_assert(sizeof(Bits) == sizeof(Real), "as many bits as reals");
  constexpr std::uint64_t kSign = 0x8000000000000000U;
  constexpr double kQuarter = 7.85398163397448309616e-01;  // pi/4
  constexpr double kRest = 3.89817183251937560e-17;        // What the double nearest to pi lacks, as a share of it.
  constexpr double kSteep = 4.14213562373095048802e-01;    // tan(pi/8)

  Bits x_bits;
  Bits y_bits;
  std::memcpy(&x_bits, &x, sizeof x_bits);
  std::memcpy(&y_bits, &y, sizeof y_bits);
  const Bits y_sign = y_bits & kSign;
  x_bits &= ~kSign;
  y_bits &= ~kSign;
  Real across;
  Real up;
  std::memcpy(&across, &x_bits, sizeof across);
  std::memcpy(&up, &y_bits, sizeof up);

  const auto is_up = up > across;
  const Real less = is_up ? across : up;
  const Real more = is_up ? up : across;
  const auto is_steep = less > kSteep * more;
  const Real zero = more - more;
  const Real sum = is_steep ? less + more : more;
  const Real t = (is_steep ? less - more : less) / (sum == zero ? zero + 1.0 : sum);
  const Real z = t * t;
  const Real z2 = z * z;
  // Two sums of every other power, as the second need not wait for the first.
  Real even = z2 * -4.35883405725184456e-02 - 6.64110432168252690e-02;
  even = even * z2 - 9.09078227974345482e-02;
  even = even * z2 - 1.42857141951309774e-01;
  even = even * z2 - 3.33333333333301451e-01;
  Real odd = z2 * 2.12566167387957354e-02 + 5.69244954569018205e-02;
  odd = odd * z2 + 7.69006639029803790e-02;
  odd = odd * z2 + 1.11111066480431120e-01;
  odd = odd * z2 + 1.99999999990874616e-01;
  const Real part = t + t * (z * (even + z * odd));

  // The angle is base + part or base - part.
  Real base = is_steep ? zero + kQuarter : zero;
  base = is_up ? 2.0 * kQuarter - base : base;
  Real turn = is_up ? -part : part;
  const auto is_behind = x < zero;
  base = is_behind ? 4.0 * kQuarter - base : base;
  turn = is_behind ? -turn : turn;
  const Real size = base + (turn + base * kRest);
  Bits bits;
  std::memcpy(&bits, &size, sizeof bits);
  bits |= y_sign;
  std::memcpy(&angle, &bits, sizeof angle);
}

}  // namespace screwline

#endif  // SCREWLINE_SPATIAL_ATAN2_KERNEL_H
