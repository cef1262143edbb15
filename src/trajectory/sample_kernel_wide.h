#ifndef SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_WIDE_H
#define SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_WIDE_H

#include "screwline/trajectory/sample_kernel.h"

namespace screwline {

// Of the kernels for any processor, those that the wide ones leave few joints and low degrees to.
void evaluateSegmentPlain(const SegmentCoefficients& segment, double x, const ChainFactors& f,
                          const SampleOutput& output);
void evaluatePiecePlain(const double* coefficients, PieceShape shape, double x, double rate, double* position,
                        double* velocity, double* acceleration, double* jerk);

// The kernels of sample_kernel.h for x86-64 processors with AVX2 and FMA; nowhere else defined.
void evaluateSegmentWide(const SegmentCoefficients& segment, double x, const ChainFactors& f,
                         const SampleOutput& output);
void evaluateScalingWide(const ScalingRows& scaling, double* values);
void evaluatePieceWide(const double* coefficients, PieceShape shape, double x, double rate, double* position,
                       double* velocity, double* acceleration, double* jerk);
void scaleLineWide(const ScalingTable& scale, double t, const DeltaLine& line, double* position, double* velocity,
                   double* acceleration, double* jerk);
void scaleShortLineWide(const ScalingTable& scale, double t, const DeltaLine& line, double* position, double* velocity,
                        double* acceleration, double* jerk);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_WIDE_H
