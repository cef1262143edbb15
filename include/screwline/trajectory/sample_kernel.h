#ifndef SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_H
#define SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_H

namespace screwline {

struct ScaledLine;

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

/// The polynomial piece of a scalar s: row k holds the coefficients of x^k in s, s', s'', s''' (4 values).
struct ScalingRows {
  const double* rows = nullptr;
  int count = 8;   ///< 4, 6 or 8: up to x^3, x^5 or x^7.
  double x = 0.0;  ///< In [0, 1].
};

/// Of the polynomials of all joints: as SegmentCoefficients.
struct PieceShape {
  int joints = 0;
  int degree = 0;
};

// Kernels whose arguments fit into registers.

/// start + delta s(t), delta s', delta s'', delta s'''.
using LineKernel = void (*)(const ScaledLine& line, double t, double* position, double* velocity, double* acceleration,
                            double* jerk);

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
  /// The kernel for a line: by the number of its joints, of the pieces of its scaling and of their rows. Null where a
  /// cycloid has none.
  LineKernel (*line)(const ScaledLine& line);
  /// The kernel of segment() where x is linear in time.
  PieceKernel (*piece)(PieceShape shape);
};

/// For the processor that this runs on (AVX2 and FMA where it has them), and for any: the same but for rounding.
const SampleKernels& sampleKernels();
const SampleKernels& plainSampleKernels();

/// start + delta s and its derivatives from the 4 values of s. Does not allocate.
void scaleDelta(const double* values, const double* start, const double* delta, int joints, const SampleOutput& output);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_H
