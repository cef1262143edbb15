// The kernels for processors with AVX2 and FMA, in intrinsics: g++ lowers its generic vectors before it inlines, so
// that one template would not become four lanes wide in a function of another target.
#include "sample_kernel_wide.h"

#if defined(__x86_64__) && defined(__GNUC__)

#include <immintrin.h>

#include <algorithm>
#include <cstddef>

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

/// The same with x linear in time, of which the factors are the powers of its rate.
[[gnu::target("avx2,fma")]] inline void finishPiece(const Four& four, double rate, double* position, double* velocity,
                                                    double* acceleration, double* jerk) {
  const double square = rate * rate;
  _mm256_storeu_pd(position, four.p);
  _mm256_storeu_pd(velocity, _mm256_mul_pd(four.d1, _mm256_set1_pd(rate)));
  _mm256_storeu_pd(acceleration, _mm256_mul_pd(four.d2, _mm256_set1_pd(2.0 * square)));
  _mm256_storeu_pd(jerk, _mm256_mul_pd(four.d3, _mm256_set1_pd(6.0 * square * rate)));
}

/// Even and odd powers apart: neither waits for the other.
template <bool kLong>
[[gnu::target("avx2,fma")]] inline __m256d scalingRow(const double* r, double at) {
  const __m256d x = _mm256_set1_pd(at);
  const __m256d x2 = _mm256_mul_pd(x, x);
  __m256d even = _mm256_loadu_pd(r + 8);
  __m256d odd = _mm256_loadu_pd(r + 12);
  if constexpr (kLong) {
    const __m256d even4 = _mm256_fmadd_pd(_mm256_loadu_pd(r + 24), x2, _mm256_loadu_pd(r + 16));
    const __m256d odd5 = _mm256_fmadd_pd(_mm256_loadu_pd(r + 28), x2, _mm256_loadu_pd(r + 20));
    even = _mm256_fmadd_pd(even4, x2, even);
    odd = _mm256_fmadd_pd(odd5, x2, odd);
  }
  even = _mm256_fmadd_pd(even, x2, _mm256_loadu_pd(r));
  odd = _mm256_fmadd_pd(odd, x2, _mm256_loadu_pd(r + 4));
  return _mm256_fmadd_pd(odd, x, even);
}

/// s and its derivatives, each in all four lanes.
struct Spread {
  __m256d s, ds, dds, ddds;
};

[[gnu::target("avx2,fma")]] inline void lineFour(const Spread& by, const double* start, const double* delta,
                                                 double* position, double* velocity, double* acceleration,
                                                 double* jerk) {
  const __m256d d = _mm256_loadu_pd(delta);
  _mm256_storeu_pd(position, _mm256_fmadd_pd(d, by.s, _mm256_loadu_pd(start)));
  _mm256_storeu_pd(velocity, _mm256_mul_pd(d, by.ds));
  _mm256_storeu_pd(acceleration, _mm256_mul_pd(d, by.dds));
  _mm256_storeu_pd(jerk, _mm256_mul_pd(d, by.ddds));
}

/// Fewer joints than a register holds. Not inlined: the others need no stack.
[[gnu::target("avx2,fma"), gnu::noinline]] void lineOfFew(__m256d row, const DeltaLine& line, double* position,
                                                          double* velocity, double* acceleration, double* jerk) {
  double values[4];
  _mm256_storeu_pd(values, row);
  const double* start = line.values.data();
  scaleDelta(values, start, start + line.joints, line.joints, {position, velocity, acceleration, jerk});
}

/// The last four joints may overlap those before: they get the same values twice. Not inlined: behind the lookup, which
/// leaves the arguments where they are, neither needs a stack.
template <bool kLong>
[[gnu::target("avx2,fma"), gnu::noinline]] void lineAt(const double* rows, double x, const DeltaLine& line,
                                                       double* position, double* velocity, double* acceleration,
                                                       double* jerk) {
  const __m256d row = scalingRow<kLong>(rows, x);
  const std::ptrdiff_t last = line.joints - 4;
  if (last < 0) return lineOfFew(row, line, position, velocity, acceleration, jerk);
  const Spread by{_mm256_permute4x64_pd(row, 0x00), _mm256_permute4x64_pd(row, 0x55), _mm256_permute4x64_pd(row, 0xaa),
                  _mm256_permute4x64_pd(row, 0xff)};
  const double* start = line.values.data();
  const double* delta = start + line.joints;
  for (std::ptrdiff_t i = 0; i < last; i += 4)
    lineFour(by, start + i, delta + i, position + i, velocity + i, acceleration + i, jerk + i);
  lineFour(by, start + last, delta + last, position + last, velocity + last, acceleration + last, jerk + last);
}

/// Whether the wide kernels do it: joints fill a register, and there are as many derivatives.
bool isWide(PieceShape shape) {
  return shape.joints >= 4 && shape.degree >= 3;
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
  if (!isWide(shape)) return evaluatePiecePlain(coefficients, shape, at, rate, position, velocity, acceleration, jerk);
  const __m256d x = _mm256_set1_pd(at);
  const std::ptrdiff_t last = shape.joints - 4;
  for (std::ptrdiff_t joint = 0;; joint += 4) {
    const std::ptrdiff_t i = std::min(joint, last);
    finishPiece(fourOf(coefficients + i, shape, x), rate, position + i, velocity + i, acceleration + i, jerk + i);
    if (i == last) return;
  }
}

[[gnu::target("avx2,fma")]] void evaluateScalingWide(const ScalingRows& scaling, double* values) {
  _mm256_storeu_pd(values, scaling.long_rows ? scalingRow<true>(scaling.rows, scaling.x)
                                             : scalingRow<false>(scaling.rows, scaling.x));
}

[[gnu::target("avx2,fma")]] void scaleLineWide(const ScalingTable& scale, double t, const DeltaLine& line,
                                               double* position, double* velocity, double* acceleration, double* jerk) {
  const ScalingRows at = scale.at(t);
  lineAt<true>(at.rows, at.x, line, position, velocity, acceleration, jerk);
}

[[gnu::target("avx2,fma")]] void scaleShortLineWide(const ScalingTable& scale, double t, const DeltaLine& line,
                                                    double* position, double* velocity, double* acceleration,
                                                    double* jerk) {
  const ScalingRows at = scale.at(t);
  lineAt<false>(at.rows, at.x, line, position, velocity, acceleration, jerk);
}

}  // namespace screwline

#endif
