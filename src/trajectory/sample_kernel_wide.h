#ifndef SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_WIDE_H
#define SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_WIDE_H

#include "screwline/trajectory/sample_kernel.h"

namespace screwline {

/// Of the kernels for any processor: the wide one leaves few joints and low degrees to it.
void evaluateSegmentPlain(const SegmentCoefficients& segment, double x, const ChainFactors& f,
                          const SampleOutput& output);

// The kernels of sample_kernel.h for x86-64 processors with AVX2 and FMA; nowhere else defined.
void evaluateSegmentWide(const SegmentCoefficients& segment, double x, const ChainFactors& f,
                         const SampleOutput& output);
void evaluateScalingWide(const ScalingRows& scaling, double* values);
/// @pre at least four joints, degree at least 3.
void evaluatePieceWide(const double* coefficients, PieceShape shape, double x, double rate, double* position,
                       double* velocity, double* acceleration, double* jerk);
/// @pre at least four joints.
LineKernel lineKernelOfFour(const ScaledLine& line);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_WIDE_H
