#include "screwline/trajectory/sample_kernel.h"

#include <cstddef>
#include <cstring>

#include "sample_kernel_wide.h"
#include "screwline/trajectory/scaling_table.h"

namespace screwline {
namespace {

using Pair = double __attribute__((vector_size(16)));

template <typename Real>
inline Real load(const double* from) {
  Real value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

template <typename Real>
inline void store(const Real& from, double* to) {
  std::memcpy(to, &from, sizeof(from));
}

/// Horner's scheme with the derivatives carried along: each is the sum of what the one below has been.
template <typename Real>
inline void segmentBlock(const SegmentCoefficients& segment, int joint, double x, const ChainFactors& f,
                         const SampleOutput& output) {
  const double* c = segment.c + segment.degree * segment.joints + joint;
  Real p = load<Real>(c);
  Real d1 = p - p, d2 = d1, d3 = d1;
  for (int k = segment.degree; k > 0; --k) {
    c -= segment.joints;
    d3 = d3 * x + d2;
    d2 = d2 * x + d1;
    d1 = d1 * x + p;
    p = p * x + load<Real>(c);
  }
  store<Real>(p, output.position + joint);
  store<Real>(d1 * f.v1, output.velocity + joint);
  store<Real>(d1 * f.a1 + d2 * (2.0 * f.a2), output.acceleration + joint);
  store<Real>(d1 * f.j1 + d2 * (2.0 * f.j2) + d3 * (6.0 * f.j3), output.jerk + joint);
}

/// Estrin's scheme: the pairs of rows do not wait for each other.
inline Pair scalingPair(const ScalingRows& scaling, int column) {
  const double* r = scaling.rows + column;
  const double x = scaling.x;
  const double x2 = x * x;
  const auto row = [r](int k) { return load<Pair>(r + 4 * k); };
  const Pair low = (row(0) + row(1) * x) + (row(2) + row(3) * x) * x2;
  if (!scaling.long_rows) return low;
  return low + ((row(4) + row(5) * x) + (row(6) + row(7) * x) * x2) * (x2 * x2);
}

template <typename Real>
inline void deltaBlock(const double* start, const double* delta, int joint, const double* values,
                       const SampleOutput& output) {
  const Real by = load<Real>(delta + joint);
  store<Real>(load<Real>(start + joint) + by * values[0], output.position + joint);
  store<Real>(by * values[1], output.velocity + joint);
  store<Real>(by * values[2], output.acceleration + joint);
  store<Real>(by * values[3], output.jerk + joint);
}

void evaluateScalingPlain(const ScalingRows& scaling, double* values) {
  store<Pair>(scalingPair(scaling, 0), values);
  store<Pair>(scalingPair(scaling, 2), values + 2);
}

void scaleLinePlain(const ScalingTable& scale, double t, const DeltaLine& line, double* position, double* velocity,
                    double* acceleration, double* jerk) {
  double values[4];
  evaluateScalingPlain(scale.at(t), values);
  const double* start = line.values.data();
  scaleDelta(values, start, start + line.joints, line.joints, {position, velocity, acceleration, jerk});
}

constexpr SampleKernels kPlain{evaluateSegmentPlain, evaluateScalingPlain, scaleLinePlain, scaleLinePlain,
                               evaluatePiecePlain};

SampleKernels chosenKernels() {
#if defined(__x86_64__) && defined(__GNUC__)
  constexpr SampleKernels kWide{evaluateSegmentWide, evaluateScalingWide, scaleLineWide, scaleShortLineWide,
                                evaluatePieceWide};
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return kWide;
#endif
  return kPlain;
}

}  // namespace

const SampleKernels& plainSampleKernels() {
  return kPlain;
}

const SampleKernels& sampleKernels() {
  static const SampleKernels kernels = chosenKernels();
  return kernels;
}

void evaluateSegmentPlain(const SegmentCoefficients& segment, double x, const ChainFactors& f,
                          const SampleOutput& output) {
  int joint = 0;
  for (; joint + 2 <= segment.joints; joint += 2) segmentBlock<Pair>(segment, joint, x, f, output);
  if (joint < segment.joints) segmentBlock<double>(segment, joint, x, f, output);
}

void evaluatePiecePlain(const double* coefficients, PieceShape shape, double x, double rate, double* position,
                        double* velocity, double* acceleration, double* jerk) {
  evaluateSegmentPlain({coefficients, shape.joints, shape.degree}, x,
                       {rate, 0.0, rate * rate, 0.0, 0.0, rate * rate * rate},
                       {position, velocity, acceleration, jerk});
}

void scaleDelta(const double* values, const double* start, const double* delta, int joints,
                const SampleOutput& output) {
  int joint = 0;
  for (; joint + 2 <= joints; joint += 2) deltaBlock<Pair>(start, delta, joint, values, output);
  if (joint < joints) deltaBlock<double>(start, delta, joint, values, output);
}

}  // namespace screwline
