// The kernels for processors with AVX2 and FMA, in intrinsics: g++ lowers its generic vectors before it inlines, so
// that one template would not become four lanes wide in a function of another target.
#include "sample_kernel_wide.h"

#if defined(__x86_64__) && defined(__GNUC__)

#include <immintrin.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "screwline/spatial/pose.h"
#include "screwline/spatial/sincos_kernel.h"
#include "screwline/trajectory/scaling_table.h"

namespace screwline {
namespace {

/// Four joints on their way through Horner's scheme with the derivatives carried along: each is the sum of what the one
/// below has been.
struct Four {
  const double* c;
  __m256d p, d1, d2, d3;
};

[[gnu::target("avx2,fma")]] inline __m256d nextRow(Four& f, std::ptrdiff_t joints) {
  f.c -= joints;
  return _mm256_loadu_pd(f.c);
}

/// Through all rows. In the first three steps most derivatives are zero. @pre degree >= 3
[[gnu::target("avx2,fma")]] inline Four fourOf(const double* c, PieceShape shape, __m256d x) {
  const std::ptrdiff_t joints = shape.joints;
  Four f;
  f.c = c + shape.degree * joints;
  f.d3 = f.d2 = f.d1 = _mm256_loadu_pd(f.c);
  f.p = _mm256_fmadd_pd(f.d1, x, nextRow(f, joints));
  f.d1 = _mm256_fmadd_pd(f.d1, x, f.p);
  f.p = _mm256_fmadd_pd(f.p, x, nextRow(f, joints));
  f.d2 = _mm256_fmadd_pd(f.d2, x, f.d1);
  f.d1 = _mm256_fmadd_pd(f.d1, x, f.p);
  f.p = _mm256_fmadd_pd(f.p, x, nextRow(f, joints));
  for (int k = shape.degree; k > 3; --k) {
    f.d3 = _mm256_fmadd_pd(f.d3, x, f.d2);
    f.d2 = _mm256_fmadd_pd(f.d2, x, f.d1);
    f.d1 = _mm256_fmadd_pd(f.d1, x, f.p);
    f.p = _mm256_fmadd_pd(f.p, x, nextRow(f, joints));
  }
  return f;
}

/// Derivatives by time, of four joints from `joint` on.
[[gnu::target("avx2,fma")]] inline void finish(const Four& four, int joint, const ChainFactors& f,
                                               const SampleOutput& output) {
  const __m256d d2 = _mm256_add_pd(four.d2, four.d2);
  const __m256d d3 = _mm256_mul_pd(four.d3, _mm256_set1_pd(6.0));
  _mm256_storeu_pd(output.position + joint, four.p);
  _mm256_storeu_pd(output.velocity + joint, _mm256_mul_pd(four.d1, _mm256_set1_pd(f.v1)));
  const __m256d a = _mm256_mul_pd(four.d1, _mm256_set1_pd(f.a1));
  _mm256_storeu_pd(output.acceleration + joint, _mm256_fmadd_pd(d2, _mm256_set1_pd(f.a2), a));
  const __m256d j = _mm256_fmadd_pd(d2, _mm256_set1_pd(f.j2), _mm256_mul_pd(four.d1, _mm256_set1_pd(f.j1)));
  _mm256_storeu_pd(output.jerk + joint, _mm256_fmadd_pd(d3, _mm256_set1_pd(f.j3), j));
}

/// What derivatives by x become those by time with where x is linear in it: the powers of its rate, times the factors
/// that fourOf() leaves out.
struct Rates {
  __m256d x, first, second, third;
};

/// Four joints from the i-th on.
[[gnu::target("avx2,fma")]] inline void pieceFour(const double* coefficients, PieceShape shape, const Rates& by,
                                                  std::ptrdiff_t i, double* position, double* velocity,
                                                  double* acceleration, double* jerk) {
  const Four four = fourOf(coefficients + i, shape, by.x);
  _mm256_storeu_pd(position + i, four.p);
  _mm256_storeu_pd(velocity + i, _mm256_mul_pd(four.d1, by.first));
  _mm256_storeu_pd(acceleration + i, _mm256_mul_pd(four.d2, by.second));
  _mm256_storeu_pd(jerk + i, _mm256_mul_pd(four.d3, by.third));
}

/// Even and odd powers apart: neither waits for the other.
template <int kRows>
[[gnu::target("avx2,fma")]] inline __m256d scalingRow(const double* r, double at) {
  const __m256d x = _mm256_set1_pd(at);
  const __m256d x2 = _mm256_mul_pd(x, x);
  __m256d even = _mm256_loadu_pd(r + 4 * kRows - 8);
  __m256d odd = _mm256_loadu_pd(r + 4 * kRows - 4);
  for (int k = kRows - 4; k >= 0; k -= 2) {
    even = _mm256_fmadd_pd(even, x2, _mm256_loadu_pd(r + 4 * k));
    odd = _mm256_fmadd_pd(odd, x2, _mm256_loadu_pd(r + 4 * k + 4));
  }
  return _mm256_fmadd_pd(odd, x, even);
}

/// s and its derivatives, each in all four lanes.
struct Spread {
  __m256d s, ds, dds, ddds;
};

/// Four joints from the i-th on.
[[gnu::target("avx2,fma")]] inline void lineFour(const Spread& by, const double* start, const double* delta,
                                                 std::ptrdiff_t i, double* position, double* velocity,
                                                 double* acceleration, double* jerk) {
  const __m256d d = _mm256_loadu_pd(delta + i);
  _mm256_storeu_pd(position + i, _mm256_fmadd_pd(d, by.s, _mm256_loadu_pd(start + i)));
  _mm256_storeu_pd(velocity + i, _mm256_mul_pd(d, by.ds));
  _mm256_storeu_pd(acceleration + i, _mm256_mul_pd(d, by.dds));
  _mm256_storeu_pd(jerk + i, _mm256_mul_pd(d, by.ddds));
}

/// How many pieces a scaling has: that decides how the one that holds is found.
enum class Pieces { kOne, kFew, kMany };

/// How many of the breaks between few pieces are not behind t.
[[gnu::target("avx2,fma,popcnt")]] inline std::size_t passed(const double* breaks, double t) {
  static_assert(ScalingTable::kFew == 8, "two registers");
  const __m256d at = _mm256_set1_pd(t);
  const int low = _mm256_movemask_pd(_mm256_cmp_pd(_mm256_load_pd(breaks), at, _CMP_LE_OQ));
  const int high = _mm256_movemask_pd(_mm256_cmp_pd(_mm256_load_pd(breaks + 4), at, _CMP_LE_OQ));
  return static_cast<std::size_t>(_mm_popcnt_u32(static_cast<unsigned>(low | (high << 4))));
}

template <int kRows, Pieces kPieces>
[[gnu::target("avx2,fma,popcnt")]] inline ScalingRows rowsAt(const ScalingTable& scale, double t) {
  if (kPieces == Pieces::kOne) return scale.inOnly(t, kRows);
  if (kPieces == Pieces::kFew) return scale.in(passed(scale.fewBreaks(), t), t, kRows);
  return scale.at(t, kRows);
}

/// The last four joints may overlap those before: they get the same values twice.
[[gnu::target("avx2,fma")]] inline void lineOf(const Spread& by, const ScaledLine& line, double* position,
                                               double* velocity, double* acceleration, double* jerk) {
  const double* start = line.start.data();
  const double* delta = line.delta.data();
  const std::ptrdiff_t last = line.joints - 4;
  lineFour(by, start, delta, 0, position, velocity, acceleration, jerk);
  if (last == 0) return;
  for (std::ptrdiff_t i = 4; i < last; i += 4) lineFour(by, start, delta, i, position, velocity, acceleration, jerk);
  lineFour(by, start, delta, last, position, velocity, acceleration, jerk);
}

template <int kRows, Pieces kPieces>
[[gnu::target("avx2,fma,popcnt")]] void scaleLine(const ScaledLine& line, double t, double* position, double* velocity,
                                                  double* acceleration, double* jerk) {
  const ScalingRows at = rowsAt<kRows, kPieces>(line.scale, t);
  const __m256d row = scalingRow<kRows>(at.rows, at.x);
  const Spread by{_mm256_permute4x64_pd(row, 0x00), _mm256_permute4x64_pd(row, 0x55), _mm256_permute4x64_pd(row, 0xaa),
                  _mm256_permute4x64_pd(row, 0xff)};
  lineOf(by, line, position, velocity, acceleration, jerk);
}

[[gnu::target("avx2,fma")]] void scaleCycloid(const ScaledLine& line, double t, double* position, double* velocity,
                                              double* acceleration, double* jerk) {
  const double tau = std::min(1.0, t * line.cycloid_rate);
  double sine, cosine;
  sincosKernel<std::uint64_t>(kTwoPi * tau, sine, cosine);
  const double turn = kTwoPi * line.cycloid_rate;
  const Spread by{_mm256_set1_pd(tau - sine * (1.0 / kTwoPi)), _mm256_set1_pd(line.cycloid_rate * (1.0 - cosine)),
                  _mm256_set1_pd(line.cycloid_rate * turn * sine),
                  _mm256_set1_pd(line.cycloid_rate * turn * turn * cosine)};
  lineOf(by, line, position, velocity, acceleration, jerk);
}

template <int kRows>
LineKernel scaleLineOf(std::size_t pieces) {
  if (pieces == 1) return scaleLine<kRows, Pieces::kOne>;
  return pieces <= ScalingTable::kFew + 1 ? scaleLine<kRows, Pieces::kFew> : scaleLine<kRows, Pieces::kMany>;
}

}  // namespace

// The last four joints may overlap those before: they get the same values twice.

[[gnu::target("avx2,fma")]] void evaluateSegmentWide(const SegmentCoefficients& segment, double at,
                                                     const ChainFactors& f, const SampleOutput& output) {
  const PieceShape shape{segment.joints, segment.degree};
  if (!isWide(shape)) return evaluateSegmentPlain(segment, at, f, output);
  const __m256d x = _mm256_set1_pd(at);
  const int last = shape.joints - 4;
  for (int i = 0; i < last; i += 4) finish(fourOf(segment.c + i, shape, x), i, f, output);
  finish(fourOf(segment.c + last, shape, x), last, f, output);
}

[[gnu::target("avx2,fma")]] void evaluatePieceWide(const double* coefficients, PieceShape shape, double at, double rate,
                                                   double* position, double* velocity, double* acceleration,
                                                   double* jerk) {
  const double square = rate * rate;
  const Rates by{_mm256_set1_pd(at), _mm256_set1_pd(rate), _mm256_set1_pd(2.0 * square),
                 _mm256_set1_pd(6.0 * square * rate)};
  const std::ptrdiff_t last = shape.joints - 4;
  pieceFour(coefficients, shape, by, 0, position, velocity, acceleration, jerk);
  if (last == 0) return;
  for (std::ptrdiff_t i = 4; i < last; i += 4)
    pieceFour(coefficients, shape, by, i, position, velocity, acceleration, jerk);
  pieceFour(coefficients, shape, by, last, position, velocity, acceleration, jerk);
}

[[gnu::target("avx2,fma")]] void evaluateScalingWide(const ScalingRows& scaling, double* values) {
  const __m256d row = scaling.count == 4   ? scalingRow<4>(scaling.rows, scaling.x)
                      : scaling.count == 6 ? scalingRow<6>(scaling.rows, scaling.x)
                                           : scalingRow<8>(scaling.rows, scaling.x);
  _mm256_storeu_pd(values, row);
}

LineKernel lineKernelOfFour(const ScaledLine& line) {
  if (line.cycloid_rate > 0.0) return scaleCycloid;
  if (line.scale.rowCount() == 4) return scaleLineOf<4>(line.scale.size());
  return line.scale.rowCount() == 6 ? scaleLineOf<6>(line.scale.size()) : scaleLineOf<8>(line.scale.size());
}

}  // namespace screwline

#endif
