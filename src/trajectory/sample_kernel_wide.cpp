// The kernels for processors with AVX2 and FMA, in intrinsics: g++ lowers its generic vectors before it inlines, so
// that one template would not become four lanes wide in a function of another target.
#include "sample_kernel_wide.h"

#if defined(__x86_64__) && defined(__GNUC__)

#include <immintrin.h>

#include <algorithm>
#include <cstddef>

namespace screwline {
namespace {

/// Four joints on their way through Horner's scheme with the derivatives carried along: each is the sum of what the one
/// below has been.
struct Four {
  const double* c;
  __m256d p, d1, d2, d3;
};

[[gnu::target("avx2,fma")]] inline Four startOf(const SegmentCoefficients& segment, int joint) {
  const double* c = segment.c + segment.degree * segment.joints + joint;
  const __m256d zero = _mm256_setzero_pd();
  return {c, _mm256_loadu_pd(c), zero, zero, zero};
}

[[gnu::target("avx2,fma")]] inline void step(Four& f, int joints, __m256d x) {
  f.c -= joints;
  f.d3 = _mm256_fmadd_pd(f.d3, x, f.d2);
  f.d2 = _mm256_fmadd_pd(f.d2, x, f.d1);
  f.d1 = _mm256_fmadd_pd(f.d1, x, f.p);
  f.p = _mm256_fmadd_pd(f.p, x, _mm256_loadu_pd(f.c));
}

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

/// Two fours at once: neither waits for the other.
[[gnu::target("avx2,fma")]] inline void segmentEight(const SegmentCoefficients& segment, int first, int second,
                                                     double at, const ChainFactors& f, const SampleOutput& output) {
  const __m256d x = _mm256_set1_pd(at);
  Four a = startOf(segment, first);
  Four b = startOf(segment, second);
  for (int k = segment.degree; k > 0; --k) {
    step(a, segment.joints, x);
    step(b, segment.joints, x);
  }
  finish(a, first, f, output);
  finish(b, second, f, output);
}

/// The same with x linear in time, of which the first factors are the powers of its rate.
[[gnu::target("avx2,fma")]] inline void finishPiece(const Four& four, int joint, __m256d v, __m256d a, __m256d j,
                                                    const SampleOutput& output) {
  _mm256_storeu_pd(output.position + joint, four.p);
  _mm256_storeu_pd(output.velocity + joint, _mm256_mul_pd(four.d1, v));
  _mm256_storeu_pd(output.acceleration + joint, _mm256_mul_pd(four.d2, a));
  _mm256_storeu_pd(output.jerk + joint, _mm256_mul_pd(four.d3, j));
}

/// Estrin's scheme: the pairs of rows do not wait for each other.
template <bool kLong>
[[gnu::target("avx2,fma")]] inline __m256d scalingRow(const double* r, double at) {
  const __m256d x = _mm256_set1_pd(at);
  const __m256d x2 = _mm256_mul_pd(x, x);
  const __m256d low0 = _mm256_fmadd_pd(_mm256_loadu_pd(r + 4), x, _mm256_loadu_pd(r));
  const __m256d low1 = _mm256_fmadd_pd(_mm256_loadu_pd(r + 12), x, _mm256_loadu_pd(r + 8));
  const __m256d low = _mm256_fmadd_pd(low1, x2, low0);
  if constexpr (!kLong) return low;
  const __m256d high0 = _mm256_fmadd_pd(_mm256_loadu_pd(r + 20), x, _mm256_loadu_pd(r + 16));
  const __m256d high1 = _mm256_fmadd_pd(_mm256_loadu_pd(r + 28), x, _mm256_loadu_pd(r + 24));
  return _mm256_fmadd_pd(_mm256_fmadd_pd(high1, x2, high0), _mm256_mul_pd(x2, x2), low);
}

/// s and its derivatives, each in all four lanes.
struct Spread {
  __m256d s, ds, dds, ddds;
};

[[gnu::target("avx2,fma")]] inline void lineFour(const Spread& by, const double* start, const double* delta, int i,
                                                 const SampleOutput& output) {
  const __m256d d = _mm256_loadu_pd(delta + i);
  _mm256_storeu_pd(output.position + i, _mm256_fmadd_pd(d, by.s, _mm256_loadu_pd(start + i)));
  _mm256_storeu_pd(output.velocity + i, _mm256_mul_pd(d, by.ds));
  _mm256_storeu_pd(output.acceleration + i, _mm256_mul_pd(d, by.dds));
  _mm256_storeu_pd(output.jerk + i, _mm256_mul_pd(d, by.ddds));
}

/// The last four joints may overlap those before: they get the same values twice.
[[gnu::target("avx2,fma")]] inline void lineOf(__m256d row, const double* line, int joints,
                                               const SampleOutput& output) {
  if (joints < 4) {
    double values[4];
    _mm256_storeu_pd(values, row);
    scaleDelta(values, line, line + joints, joints, output);
    return;
  }
  const Spread by{_mm256_permute4x64_pd(row, 0x00), _mm256_permute4x64_pd(row, 0x55), _mm256_permute4x64_pd(row, 0xaa),
                  _mm256_permute4x64_pd(row, 0xff)};
  lineFour(by, line, line + joints, 0, output);
  for (int joint = 4; joint < joints; joint += 4)
    lineFour(by, line, line + joints, std::min(joint, joints - 4), output);
}

}  // namespace

/// The last four joints may overlap those before: they get the same values twice.
[[gnu::target("avx2,fma")]] void evaluateSegmentWide(const SegmentCoefficients& segment, double x,
                                                     const ChainFactors& f, const SampleOutput& output) {
  const int joints = segment.joints;
  if (joints < 4) {
    for (int joint = 0; joint < joints; ++joint) evaluateJoint(segment, joint, x, f, output);
    return;
  }
  for (int joint = 0; joint < joints; joint += 8) {
    segmentEight(segment, std::min(joint, joints - 4), std::min(joint + 4, joints - 4), x, f, output);
  }
}

[[gnu::target("avx2,fma")]] void evaluatePieceWide(const SegmentCoefficients& segment, double at, double rate,
                                                   const SampleOutput& output) {
  const int joints = segment.joints;
  const double square = rate * rate;
  if (joints < 4) {
    const ChainFactors factors{rate, 0.0, square, 0.0, 0.0, square * rate};
    for (int joint = 0; joint < joints; ++joint) evaluateJoint(segment, joint, at, factors, output);
    return;
  }
  const __m256d x = _mm256_set1_pd(at);
  const __m256d v = _mm256_set1_pd(rate), a = _mm256_set1_pd(2.0 * square), j = _mm256_set1_pd(6.0 * square * rate);
  for (int joint = 0; joint < joints; joint += 8) {
    const int first = std::min(joint, joints - 4);
    const int second = std::min(joint + 4, joints - 4);
    Four left = startOf(segment, first);
    Four right = startOf(segment, second);
    for (int k = segment.degree; k > 0; --k) {
      step(left, joints, x);
      step(right, joints, x);
    }
    finishPiece(left, first, v, a, j, output);
    finishPiece(right, second, v, a, j, output);
  }
}

[[gnu::target("avx2,fma")]] void evaluateScalingWide(const ScalingRows& scaling, double* values) {
  _mm256_storeu_pd(values, scaling.long_rows ? scalingRow<true>(scaling.rows, scaling.x)
                                             : scalingRow<false>(scaling.rows, scaling.x));
}

[[gnu::target("avx2,fma")]] void scaleLineWide(const double* rows, double x, const double* line, int joints,
                                               double* position, double* velocity, double* acceleration, double* jerk) {
  lineOf(scalingRow<true>(rows, x), line, joints, {position, velocity, acceleration, jerk});
}

[[gnu::target("avx2,fma")]] void scaleShortLineWide(const double* rows, double x, const double* line, int joints,
                                                    double* position, double* velocity, double* acceleration,
                                                    double* jerk) {
  lineOf(scalingRow<false>(rows, x), line, joints, {position, velocity, acceleration, jerk});
}

}  // namespace screwline

#endif
