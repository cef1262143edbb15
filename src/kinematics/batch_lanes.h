#ifndef SCREWLINE_KINEMATICS_BATCH_LANES_H
#define SCREWLINE_KINEMATICS_BATCH_LANES_H

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "screwline/spatial/sincos_kernel.h"

namespace screwline {

/// Vectors of 2, 4 or 8 doubles by the compiler's vector extension: what the processor has no instruction for, the
/// compiler splits. Everything here is inlined into functions compiled for one processor each, and takes vectors by
/// reference: how they are passed by value depends on the processor.
template <int kCount>
struct Lanes;

template <>
struct Lanes<2> {
  using Real = double __attribute__((vector_size(16)));
  using Bits = std::uint64_t __attribute__((vector_size(16)));
  [[gnu::always_inline]] static void gather(const double* first, std::ptrdiff_t stride, Real& out) {
    out = Real{first[0], first[stride]};
  }
};

template <>
struct Lanes<4> {
  using Real = double __attribute__((vector_size(32)));
  using Bits = std::uint64_t __attribute__((vector_size(32)));
  [[gnu::always_inline]] static void gather(const double* first, std::ptrdiff_t stride, Real& out) {
    out = Real{first[0], first[stride], first[2 * stride], first[3 * stride]};
  }
};

template <>
struct Lanes<8> {
  using Real = double __attribute__((vector_size(64)));
  using Bits = std::uint64_t __attribute__((vector_size(64)));
  [[gnu::always_inline]] static void gather(const double* first, std::ptrdiff_t stride, Real& out) {
    out = Real{first[0],          first[stride],     first[2 * stride], first[3 * stride],
               first[4 * stride], first[5 * stride], first[6 * stride], first[7 * stride]};
  }
};

template <typename Real>
struct LaneVector {
  Real x, y, z;
};

/// A frame in each lane: its axes, its origin.
template <typename Real>
struct LaneFrame {
  LaneVector<Real> x, y, z, p;
};

template <typename Real>
[[gnu::always_inline]] inline void broadcast(double value, Real& out) {
  out = Real{} + value;
}

template <typename Real>
[[gnu::always_inline]] inline void broadcast(const double* xyz, LaneVector<Real>& out) {
  broadcast(xyz[0], out.x);
  broadcast(xyz[1], out.y);
  broadcast(xyz[2], out.z);
}

/// sum += scale * v. Most constants of a chain are zero, and a branch costs less than three multiplications.
template <typename Real>
[[gnu::always_inline]] inline void addScaled(double scale, const LaneVector<Real>& v, LaneVector<Real>& sum) {
  if (scale == 0.0) return;
  sum.x += scale * v.x;
  sum.y += scale * v.y;
  sum.z += scale * v.z;
}

template <typename Real>
[[gnu::always_inline]] inline void addScaled(const Real& scale, const LaneVector<Real>& v, LaneVector<Real>& sum) {
  sum.x += scale * v.x;
  sum.y += scale * v.y;
  sum.z += scale * v.z;
}

/// Turns the pair (x, y) of a frame's axes about the third: x' = c x + s y, y' = c y - s x.
template <typename Scalar, typename Real>
[[gnu::always_inline]] inline void turn(const Scalar& c, const Scalar& s, LaneVector<Real>& x, LaneVector<Real>& y) {
  const LaneVector<Real> old = x;
  x.x = c * old.x + s * y.x;
  x.y = c * old.y + s * y.y;
  x.z = c * old.z + s * y.z;
  y.x = c * y.x - s * old.x;
  y.y = c * y.y - s * old.y;
  y.z = c * y.z - s * old.z;
}

/// 1 / sqrt(s) for 4 <= s <= 16, within 2 units in the last place: a cubic within 0.7 %, then Newton's steps.
template <typename Real>
[[gnu::always_inline]] inline void inverseRoot(const Real& s, Real& root) {
  root = ((s * -1.48830515e-04 + 6.08390282e-03) * s - 9.23576487e-02) * s + 7.78092926e-01;
  for (int step = 0; step < 3; ++step) root = root + root * (0.5 - 0.5 * s * (root * root));
}

/// The unit quaternion x y z w of a frame's rotation, by the largest of its components (Shepperd 1978): nothing
/// cancels anywhere. w >= 0.
template <typename Real>
[[gnu::always_inline]] inline void quaternionOf(const LaneFrame<Real>& X, Real* quaternion) {
  const Real sum_xy = X.x.y + X.y.x;
  const Real sum_yz = X.y.z + X.z.y;
  const Real sum_zx = X.z.x + X.x.z;
  const Real difference_x = X.y.z - X.z.y;
  const Real difference_y = X.z.x - X.x.z;
  const Real difference_z = X.x.y - X.y.x;
  // Which one is chosen leaves it at least a half: the trace's part in x and y, then z or w, or x or y.
  const Real zero = Real{};
  const auto x_or_y = X.z.z < zero;
  const auto is_x = X.x.x > X.y.y;
  const auto is_z = X.x.x < -X.y.y;
  const Real trace_x = 1.0 + X.x.x - X.y.y - X.z.z;
  const Real trace_y = 1.0 - X.x.x + X.y.y - X.z.z;
  const Real trace_z = 1.0 - X.x.x - X.y.y + X.z.z;
  const Real trace_w = 1.0 + X.x.x + X.y.y + X.z.z;
  Real x = x_or_y ? (is_x ? trace_x : sum_xy) : (is_z ? sum_zx : difference_x);
  Real y = x_or_y ? (is_x ? sum_xy : trace_y) : (is_z ? sum_yz : difference_y);
  Real z = x_or_y ? (is_x ? sum_zx : sum_yz) : (is_z ? trace_z : difference_z);
  Real w = x_or_y ? (is_x ? difference_x : difference_y) : (is_z ? difference_z : trace_w);
  Real scale;
  inverseRoot(x * x + y * y + z * z + w * w, scale);
  scale = w < zero ? -scale : scale;
  quaternion[0] = x * scale + 0.0;  // No -0 for people to read.
  quaternion[1] = y * scale + 0.0;
  quaternion[2] = z * scale + 0.0;
  quaternion[3] = w * scale + 0.0;
}

/// Writes `columns` vectors as rows of `columns` numbers, one row for each of the first `rows` lanes.
template <int kCount>
[[gnu::always_inline]] inline void scatter(const typename Lanes<kCount>::Real* vectors, int columns, int rows,
                                           double* out) {
  using Pair = Lanes<2>::Real;
  const auto* lanes = reinterpret_cast<const double*>(vectors);
  int column = 0;
  for (; column + 1 < columns; column += 2) {
    const double* first = lanes + column * kCount;
    for (int row = 0; row < rows; ++row) {
      const Pair pair = {first[row], first[kCount + row]};
      std::memcpy(out + row * columns + column, &pair, sizeof pair);
    }
  }
  if (column == columns) return;
  for (int row = 0; row < rows; ++row) out[row * columns + column] = lanes[column * kCount + row];
}

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_BATCH_LANES_H
