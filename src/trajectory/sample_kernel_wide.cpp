// The kernels for processors with AVX2 and FMA, in intrinsics: g++ lowers its generic vectors before it inlines, so
// that one template would not become four lanes wide in a function of another target.
#include "sample_kernel_wide.h"

#if defined(__x86_64__) && defined(__GNUC__)

#include <immintrin.h>

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

[[gnu::target("avx2,fma")]] inline void segmentTwo(const SegmentCoefficients& segment, int joint, double at,
                                                   const ChainFactors& f, const SampleOutput& output) {
  const double* c = segment.c + segment.degree * segment.joints + joint;
  const __m128d x = _mm_set1_pd(at);
  __m128d p = _mm_loadu_pd(c);
  __m128d d1 = _mm_setzero_pd(), d2 = d1, d3 = d1;
  for (int k = segment.degree; k > 0; --k) {
    c -= segment.joints;
    d3 = _mm_fmadd_pd(d3, x, d2);
    d2 = _mm_fmadd_pd(d2, x, d1);
    d1 = _mm_fmadd_pd(d1, x, p);
    p = _mm_fmadd_pd(p, x, _mm_loadu_pd(c));
  }
  d2 = _mm_add_pd(d2, d2);
  d3 = _mm_mul_pd(d3, _mm_set1_pd(6.0));
  _mm_storeu_pd(output.position + joint, p);
  _mm_storeu_pd(output.velocity + joint, _mm_mul_pd(d1, _mm_set1_pd(f.v1)));
  const __m128d a = _mm_mul_pd(d1, _mm_set1_pd(f.a1));
  _mm_storeu_pd(output.acceleration + joint, _mm_fmadd_pd(d2, _mm_set1_pd(f.a2), a));
  const __m128d j = _mm_fmadd_pd(d2, _mm_set1_pd(f.j2), _mm_mul_pd(d1, _mm_set1_pd(f.j1)));
  _mm_storeu_pd(output.jerk + joint, _mm_fmadd_pd(d3, _mm_set1_pd(f.j3), j));
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

[[gnu::target("avx2,fma")]] void evaluateSegmentWide(const SegmentCoefficients& segment, double x,
                                                     const ChainFactors& f, const SampleOutput& output) {
  int joint = 0;
  for (; joint + 4 <= segment.joints; joint += 4) segmentFour(segment, joint, x, f, output);
  if (joint == segment.joints) return;
  if (joint + 2 <= segment.joints) {
    segmentTwo(segment, joint, x, f, output);
    joint += 2;
  }
  if (joint < segment.joints) evaluateJoint(segment, joint, x, f, output);
}

[[gnu::target("avx2,fma")]] void evaluateScalingWide(const ScalingRows& scaling, double* values) {
  _mm256_storeu_pd(values, scalingRow(scaling));
}

[[gnu::target("avx2,fma")]] void scaleDeltaWide(const ScalingRows& scaling, const double* start, const double* delta,
                                                int joints, const SampleOutput& output) {
  const __m256d row = scalingRow(scaling);
  const __m256d s = _mm256_permute4x64_pd(row, 0x00), ds = _mm256_permute4x64_pd(row, 0x55);
  const __m256d dds = _mm256_permute4x64_pd(row, 0xaa), ddds = _mm256_permute4x64_pd(row, 0xff);
  int i = 0;
  for (; i + 4 <= joints; i += 4) {
    const __m256d by = _mm256_loadu_pd(delta + i);
    _mm256_storeu_pd(output.position + i, _mm256_fmadd_pd(by, s, _mm256_loadu_pd(start + i)));
    _mm256_storeu_pd(output.velocity + i, _mm256_mul_pd(by, ds));
    _mm256_storeu_pd(output.acceleration + i, _mm256_mul_pd(by, dds));
    _mm256_storeu_pd(output.jerk + i, _mm256_mul_pd(by, ddds));
  }
  if (i + 2 <= joints) {
    const __m128d by = _mm_loadu_pd(delta + i);
    _mm_storeu_pd(output.position + i, _mm_fmadd_pd(by, _mm256_castpd256_pd128(s), _mm_loadu_pd(start + i)));
    _mm_storeu_pd(output.velocity + i, _mm_mul_pd(by, _mm256_castpd256_pd128(ds)));
    _mm_storeu_pd(output.acceleration + i, _mm_mul_pd(by, _mm256_castpd256_pd128(dds)));
    _mm_storeu_pd(output.jerk + i, _mm_mul_pd(by, _mm256_castpd256_pd128(ddds)));
    i += 2;
  }
  if (i == joints) return;
  output.position[i] = start[i] + delta[i] * _mm256_cvtsd_f64(s);
  output.velocity[i] = delta[i] * _mm256_cvtsd_f64(ds);
  output.acceleration[i] = delta[i] * _mm256_cvtsd_f64(dds);
  output.jerk[i] = delta[i] * _mm256_cvtsd_f64(ddds);
}

}  // namespace screwline

#endif
