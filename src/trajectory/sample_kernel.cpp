#include "screwline/trajectory/sample_kernel.h"

#include <cstddef>
#include <cstring>

namespace screwline {
namespace {

template <int kCount>
struct Lanes;
template <>
struct Lanes<1> {
  using Real = double;
};
template <>
struct Lanes<2> {
  using Real = double __attribute__((vector_size(16)));
};
template <>
struct Lanes<4> {
  using Real = double __attribute__((vector_size(32)));
};

template <int kCount>
[[gnu::always_inline]] inline void load(const double* from, typename Lanes<kCount>::Real& to) {
  std::memcpy(&to, from, sizeof(to));
}

template <int kCount>
[[gnu::always_inline]] inline void store(const typename Lanes<kCount>::Real& from, double* to) {
  std::memcpy(to, &from, sizeof(from));
}

/// Horner's scheme with the derivatives carried along: each is the sum of what the one below has been.
template <int kCount>
[[gnu::always_inline]] inline void segmentBlock(const SegmentCoefficients& segment, int joint, double x,
                                                const ChainFactors& f, const SampleOutput& output) {
  using Real = typename Lanes<kCount>::Real;
  const double* c = segment.c + segment.degree * segment.joints + joint;
  Real p, powers;
  load<kCount>(c, p);
  Real d1 = p - p, d2 = d1, d3 = d1;
  for (int k = segment.degree; k > 0; --k) {
    c -= segment.joints;
    load<kCount>(c, powers);
    d3 = d3 * x + d2;
    d2 = d2 * x + d1;
    d1 = d1 * x + p;
    p = p * x + powers;
  }
  store<kCount>(p, output.position + joint);
  store<kCount>(d1 * f.v1, output.velocity + joint);
  store<kCount>(d1 * f.a1 + d2 * (2.0 * f.a2), output.acceleration + joint);
  store<kCount>(d1 * f.j1 + d2 * (2.0 * f.j2) + d3 * (6.0 * f.j3), output.jerk + joint);
}

template <int kMost>
[[gnu::always_inline]] inline void segmentBlocks(const SegmentCoefficients& segment, double x, const ChainFactors& f,
                                                 const SampleOutput& output) {
  int joint = 0;
  if constexpr (kMost >= 4) {
    for (; joint + 4 <= segment.joints; joint += 4) segmentBlock<4>(segment, joint, x, f, output);
  }
  for (; joint + 2 <= segment.joints; joint += 2) segmentBlock<2>(segment, joint, x, f, output);
  if (joint < segment.joints) segmentBlock<1>(segment, joint, x, f, output);
}

/// Estrin's scheme: the pairs of rows do not wait for each other.
template <int kCount>
[[gnu::always_inline]] inline void scalingBlock(const ScalingRows& scaling, int column, double* values) {
  using Real = typename Lanes<kCount>::Real;
  const double x = scaling.x;
  const double x2 = x * x;
  Real r[8];
  for (int k = 0; k < 4; ++k) load<kCount>(scaling.rows + 4 * k + column, r[k]);
  Real sum = (r[0] + r[1] * x) + (r[2] + r[3] * x) * x2;
  if (scaling.long_rows) {
    for (int k = 4; k < 8; ++k) load<kCount>(scaling.rows + 4 * k + column, r[k]);
    sum += ((r[4] + r[5] * x) + (r[6] + r[7] * x) * x2) * (x2 * x2);
  }
  store<kCount>(sum, values + column);
}

template <int kMost>
[[gnu::always_inline]] inline void scalingBlocks(const ScalingRows& scaling, double* values) {
  for (int column = 0; column < 4; column += kMost) scalingBlock<kMost>(scaling, column, values);
}

template <int kCount>
[[gnu::always_inline]] inline void deltaBlock(const double* start, const double* delta, int joint, const double* values,
                                              const SampleOutput& output) {
  typename Lanes<kCount>::Real from, by;
  load<kCount>(start + joint, from);
  load<kCount>(delta + joint, by);
  store<kCount>(from + by * values[0], output.position + joint);
  store<kCount>(by * values[1], output.velocity + joint);
  store<kCount>(by * values[2], output.acceleration + joint);
  store<kCount>(by * values[3], output.jerk + joint);
}

template <int kMost>
[[gnu::always_inline]] inline void deltaBlocks(const ScalingRows& scaling, const double* start, const double* delta,
                                               int joints, const SampleOutput& output) {
  double values[4];
  scalingBlocks<kMost>(scaling, values);
  int joint = 0;
  if constexpr (kMost >= 4) {
    for (; joint + 4 <= joints; joint += 4) deltaBlock<4>(start, delta, joint, values, output);
  }
  for (; joint + 2 <= joints; joint += 2) deltaBlock<2>(start, delta, joint, values, output);
  if (joint < joints) deltaBlock<1>(start, delta, joint, values, output);
}

struct Kernels {
  void (*segment)(const SegmentCoefficients&, double, const ChainFactors&, const SampleOutput&);
  void (*scaling)(const ScalingRows&, double*);
  void (*delta)(const ScalingRows&, const double*, const double*, int, const SampleOutput&);
};

// The one source, compiled for two kinds of processor.
void segmentTwo(const SegmentCoefficients& segment, double x, const ChainFactors& f, const SampleOutput& output) {
  segmentBlocks<2>(segment, x, f, output);
}
void scalingTwo(const ScalingRows& scaling, double* values) {
  scalingBlocks<2>(scaling, values);
}
void deltaTwo(const ScalingRows& scaling, const double* start, const double* delta, int joints,
              const SampleOutput& output) {
  deltaBlocks<2>(scaling, start, delta, joints, output);
}
constexpr Kernels kTwo{segmentTwo, scalingTwo, deltaTwo};

#if defined(__x86_64__) && defined(__GNUC__)

[[gnu::target("avx2,fma")]] void segmentFour(const SegmentCoefficients& segment, double x, const ChainFactors& f,
                                             const SampleOutput& output) {
  segmentBlocks<4>(segment, x, f, output);
}
[[gnu::target("avx2,fma")]] void scalingFour(const ScalingRows& scaling, double* values) {
  scalingBlocks<4>(scaling, values);
}
[[gnu::target("avx2,fma")]] void deltaFour(const ScalingRows& scaling, const double* start, const double* delta,
                                           int joints, const SampleOutput& output) {
  deltaBlocks<4>(scaling, start, delta, joints, output);
}
constexpr Kernels kFour{segmentFour, scalingFour, deltaFour};

Kernels chosenKernels() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? kFour : kTwo;
}

#else

Kernels chosenKernels() {
  return kTwo;
}

#endif

/// Usable before it is chosen: what runs while the program is still being loaded gets the plain kernels.
Kernels kernels = kTwo;
[[maybe_unused]] const bool kChosen = (kernels = chosenKernels(), true);

}  // namespace

void evaluateSegment(const SegmentCoefficients& segment, double x, const ChainFactors& chain,
                     const SampleOutput& output) {
  kernels.segment(segment, x, chain, output);
}

void evaluateScaling(const ScalingRows& scaling, double* values) {
  kernels.scaling(scaling, values);
}

void scaleDelta(const ScalingRows& scaling, const double* start, const double* delta, int joints,
                const SampleOutput& output) {
  kernels.delta(scaling, start, delta, joints, output);
}

void scaleDelta(const double* values, const double* start, const double* delta, int joints,
                const SampleOutput& output) {
  for (int joint = 0; joint < joints; ++joint) deltaBlock<1>(start, delta, joint, values, output);
}

}  // namespace screwline
