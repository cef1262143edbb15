#ifndef SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_WIDE_H
#define SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_WIDE_H

#include "screwline/trajectory/sample_kernel.h"

namespace screwline {

/// One joint of a segment, on any processor.
void evaluateJoint(const SegmentCoefficients& segment, int joint, double x, const ChainFactors& f,
                   const SampleOutput& output);

// The kernels of sample_kernel.h for x86-64 processors with AVX2 and FMA; nowhere else defined.
void evaluateSegmentWide(const SegmentCoefficients& segment, double x, const ChainFactors& f,
                         const SampleOutput& output);
void evaluateScalingWide(const ScalingRows& scaling, double* values);
void evaluatePieceWide(const SegmentCoefficients& segment, double x, double rate, const SampleOutput& output);
void scaleLineWide(const double* rows, double x, const double* line, int joints, double* position, double* velocity,
                   double* acceleration, double* jerk);
void scaleShortLineWide(const double* rows, double x, const double* line, int joints, double* position,
                        double* velocity, double* acceleration, double* jerk);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_WIDE_H
