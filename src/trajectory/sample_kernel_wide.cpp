// The kernels for processors with AVX2 and FMA, in intrinsics: g++ lowers its generic vectors before it inlines, so
// that one template would not become four lanes wide in a function of another target.
#include "sample_kernel_wide.h"

#if defined(__x86_64__) && defined(__GNUC__)

#include <immintrin.h>

#include <algorithm>
#include <cstddef>

namespace screwline {
namespace {

/// Horner's scheme with the derivatives carried along: each is the sum of what the one below has been.
[[gnu::target("avx2,fma")]] inline void segmentFour(const SegmentCoefficients& segment, int joint, double at,
                                                    const ChainFactors& f, const SampleOutput& output) {
  const double* c = segment.c + segment.degree * segment.joints + joint;
  const __m256d x = _mm256_set1_pd(at);
  __m256d p = _mm256_loadu_pd(c);
  __m256d d1 = _mm256_setzero_pd(), d2 = d1, d3 = d1;
  for (int k = segment.degree; k > 0; --k) {
    c -= segment.joints;
    d3 = _mm256_fmadd_pd(d3, x, d2);
    d2 = _mm256_fmadd_pd(d2, x, d1);
    d1 = _mm256_fmadd_pd(d1, x, p);
    p = _mm256_fmadd_pd(p, x, _mm256_loadu_pd(c));
  }
  d2 = _mm256_add_pd(d2, d2);
  d3 = _mm256_mul_pd(d3, _mm256_set1_pd(6.0));
  _mm256_storeu_pd(output.position + joint, p);
  _mm256_storeu_pd(output.velocity + joint, _mm256_mul_pd(d1, _mm256_set1_pd(f.v1)));
  const __m256d a = _mm256_mul_pd(d1, _mm256_set1_pd(f.a1));
  _mm256_storeu_pd(output.acceleration + joint, _mm256_fmadd_pd(d2, _mm256_set1_pd(f.a2), a));
  const __m256d j = _mm256_fmadd_pd(d2, _mm256_set1_pd(f.j2), _mm256_mul_pd(d1, _mm256_set1_pd(f.j1)));
  _mm256_storeu_pd(output.jerk + joint, _mm256_fmadd_pd(d3, _mm256_set1_pd(f.j3), j));
}

/// Estrin's scheme: the pairs of rows do not wait for each other.
[[gnu::target("avx2,fma")]] inline __m256d scalingRow(const ScalingRows& scaling) {
  const double* r = scaling.rows;
  const __m256d x = _mm256_set1_pd(scaling.x);
  const __m256d x2 = _mm256_mul_pd(x, x);
  const __m256d low0 = _mm256_fmadd_pd(_mm256_loadu_pd(r + 4), x, _mm256_loadu_pd(r));
  const __m256d low1 = _mm256_fmadd_pd(_mm256_loadu_pd(r + 12), x, _mm256_loadu_pd(r + 8));
  const __m256d low = _mm256_fmadd_pd(low1, x2, low0);
  if (!scaling.long_rows) return low;
  const __m256d high0 = _mm256_fmadd_pd(_mm256_loadu_pd(r + 20), x, _mm256_loadu_pd(r + 16));
  const __m256d high1 = _mm256_fmadd_pd(_mm256_loadu_pd(r + 28), x, _mm256_loadu_pd(r + 24));
  return _mm256_fmadd_pd(_mm256_fmadd_pd(high1, x2, high0), _mm256_mul_pd(x2, x2), low);
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
  for (int joint = 0; joint < joints; joint += 4) segmentFour(segment, std::min(joint, joints - 4), x, f, output);
}

[[gnu::target("avx2,fma")]] void evaluateScalingWide(const ScalingRows& scaling, double* values) {
  _mm256_storeu_pd(values, scalingRow(scaling));
}

[[gnu::target("avx2,fma")]] void scaleDeltaWide(const ScalingRows& scaling, const double* start, const double* delta,
                                                int joints, const SampleOutput& output) {
  const __m256d row = scalingRow(scaling);
  if (joints < 4) {
    double values[4];
    _mm256_storeu_pd(values, row);
    scaleDelta(values, start, delta, joints, output);
    return;
  }
  const __m256d s = _mm256_permute4x64_pd(row, 0x00), ds = _mm256_permute4x64_pd(row, 0x55);
  const __m256d dds = _mm256_permute4x64_pd(row, 0xaa), ddds = _mm256_permute4x64_pd(row, 0xff);
  for (int joint = 0; joint < joints; joint += 4) {
    const int i = std::min(joint, joints - 4);
    const __m256d by = _mm256_loadu_pd(delta + i);
    _mm256_storeu_pd(output.position + i, _mm256_fmadd_pd(by, s, _mm256_loadu_pd(start + i)));
    _mm256_storeu_pd(output.velocity + i, _mm256_mul_pd(by, ds));
    _mm256_storeu_pd(output.acceleration + i, _mm256_mul_pd(by, dds));
    _mm256_storeu_pd(output.jerk + i, _mm256_mul_pd(by, ddds));
  }
}

}  // namespace screwline

#endif
