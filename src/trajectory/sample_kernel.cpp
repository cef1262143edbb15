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

/// Even and odd powers apart: neither waits for the other.
inline Pair scalingPair(const ScalingRows& scaling, int column) {
  const double* r = scaling.rows + column;
  const double x2 = scaling.x * scaling.x;
  int k = scaling.count - 2;
  Pair even = load<Pair>(r + 4 * k);
  Pair odd = load<Pair>(r + 4 * k + 4);
  while (k > 0) {
    k -= 2;
    even = even * x2 + load<Pair>(r + 4 * k);
    odd = odd * x2 + load<Pair>(r + 4 * k + 4);
  }
  return even + odd * scaling.x;
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

void evaluatePiecePlain(const double* coefficients, PieceShape shape, double x, double rate, double* position,
                        double* velocity, double* acceleration, double* jerk) {
  evaluateSegmentPlain({coefficients, shape.joints, shape.degree}, x,
                       {rate, 0.0, rate * rate, 0.0, 0.0, rate * rate * rate},
                       {position, velocity, acceleration, jerk});
}

void scaleLinePlain(const ScaledLine& line, double t, double* position, double* velocity, double* acceleration,
                    double* jerk) {
  double values[4];
  evaluateScalingPlain(line.scale.at(t), values);
  scaleDelta(values, line.start.data(), line.delta.data(), static_cast<int>(line.joints),
             {position, velocity, acceleration, jerk});
}

LineKernel lineKernelPlain(const ScaledLine& line) {
  return line.cycloid_rate > 0.0 ? nullptr : scaleLinePlain;
}

PieceKernel pieceKernelPlain(PieceShape /*shape*/) {
  return evaluatePiecePlain;
}

constexpr SampleKernels kPlain{evaluateSegmentPlain, evaluateScalingPlain, lineKernelPlain, pieceKernelPlain};

#if defined(__x86_64__) && defined(__GNUC__)
/// A register of the wide kernels holds four joints; fewer, and lower degrees, are the plain ones'.
LineKernel lineKernelWide(const ScaledLine& line) {
  return line.joints < 4 ? lineKernelPlain(line) : lineKernelOfFour(line);
}

PieceKernel pieceKernelWide(PieceShape shape) {
  return isWide(shape) ? evaluatePieceWide : evaluatePiecePlain;
}
#endif

SampleKernels chosenKernels() {
#if defined(__x86_64__) && defined(__GNUC__)
  constexpr SampleKernels kWide{evaluateSegmentWide, evaluateScalingWide, lineKernelWide, pieceKernelWide};
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("popcnt")) return kWide;
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

void scaleDelta(const double* values, const double* start, const double* delta, int joints,
                const SampleOutput& output) {
  int joint = 0;
  for (; joint + 2 <= joints; joint += 2) deltaBlock<Pair>(start, delta, joint, values, output);
  if (joint < joints) deltaBlock<double>(start, delta, joint, values, output);
}

}  // namespace screwline
