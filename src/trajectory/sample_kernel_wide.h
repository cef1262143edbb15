#ifndef SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_WIDE_H
#define SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_WIDE_H

#include "screwline/trajectory/sample_kernel.h"

namespace screwline {

/// Whether the wide kernels do it: joints fill a register, and there are as many derivatives.
constexpr bool isWide(PieceShape shape) {
  return shape.joints >= 4 && shape.degree >= 3;
}

/// Of the kernels for any processor: the wide one leaves few joints and low degrees to it.
void evaluateSegmentPlain(const SegmentCoefficients& segment, double x, const ChainFactors& f,
                          const SampleOutput& output);

// The kernels of sample_kernel.h for x86-64 processors with AVX2 and FMA; nowhere else defined.
void evaluateSegmentWide(const SegmentCoefficients& segment, double x, const ChainFactors& f,
                         const SampleOutput& output);
void evaluateScalingWide(const ScalingRows& scaling, double* values);
/// @pre isWide(shape).
void evaluatePieceWide(const double* coefficients, PieceShape shape, double x, double rate, double* position,
                       double* velocity, double* acceleration, double* jerk);
/// @pre at least four joints.
LineKernel lineKernelOfFour(const ScaledLine& line);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_WIDE_H
