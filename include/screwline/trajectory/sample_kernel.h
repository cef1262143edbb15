#ifndef SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_H
#define SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_H

#include <vector>

namespace screwline {

class ScalingTable;

/// Coefficients of the polynomials of all joints over one segment, as [power][joint].
struct SegmentCoefficients {
  const double* c = nullptr;
  int joints = 0;
  int degree = 0;
};

/// How derivatives by the segment's own x (P1, P2, P3) become those by time: v = v1 P1, a = a1 P1 + a2 P2,
/// j = j1 P1 + j2 P2 + j3 P3. With x linear in time a1, j1 and j2 are zero; else it is the chain rule.
struct ChainFactors {
  double v1 = 0.0;
  double a1 = 0.0;
  double a2 = 0.0;
  double j1 = 0.0;
  double j2 = 0.0;
  double j3 = 0.0;
};

/// Where a sample goes: n values each.
struct SampleOutput {
  double* position = nullptr;
  double* velocity = nullptr;
  double* acceleration = nullptr;
  double* jerk = nullptr;
};

/// The polynomial piece of a scalar s: row k holds the coefficients of x^k in s, s', s'', s''' (4 values), all rows up
/// to x^7 or, where not long, to x^3.
struct ScalingRows {
  const double* rows = nullptr;
  bool long_rows = true;
  double x = 0.0;  ///< In [0, 1].
};

/// What a scalar s moves: start + delta s.
struct DeltaLine {
  int joints = 0;
  std::vector<double> values;  ///< Start, then delta, of each joint.
};

/// Of the polynomials of all joints: as SegmentCoefficients.
struct PieceShape {
  int joints = 0;
  int degree = 0;
};

// Kernels whose arguments fit into registers.

/// The line where s stands at t.
using DeltaKernel = void (*)(const ScalingTable& scale, double t, const DeltaLine& line, double* position,
                             double* velocity, double* acceleration, double* jerk);

/// SegmentCoefficients at x, which is linear in time: its rate is dx/dt.
using PieceKernel = void (*)(const double* coefficients, PieceShape shape, double x, double rate, double* position,
                             double* velocity, double* acceleration, double* jerk);

/// How a motion is sampled. None of the functions allocates.
struct SampleKernels {
  /// Position and three derivatives of all joints in one pass of Horner's scheme, neighbouring joints side by side in a
  /// register.
  void (*segment)(const SegmentCoefficients& segment, double x, const ChainFactors& chain, const SampleOutput& output);
  /// s and its three derivatives into 4 values.
  void (*scaling)(const ScalingRows& scaling, double* values);
  /// One scalar for all joints: start + delta s, delta s', delta s'', delta s'''. From 8 and from 4 rows.
  DeltaKernel long_delta;
  DeltaKernel short_delta;
  /// segment() where x is linear in time.
  PieceKernel piece;
};

/// For the processor that this runs on (AVX2 and FMA where it has them), and for any: the same but for rounding.
const SampleKernels& sampleKernels();
const SampleKernels& plainSampleKernels();

/// start + delta s and its derivatives from the 4 values of s. Does not allocate.
void scaleDelta(const double* values, const double* start, const double* delta, int joints, const SampleOutput& output);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_H
