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
void scaleDeltaWide(const ScalingRows& scaling, const double* start, const double* delta, int joints,
                    const SampleOutput& output);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_SAMPLE_KERNEL_WIDE_H
