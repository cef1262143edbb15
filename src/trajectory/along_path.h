#ifndef SCREWLINE_TRAJECTORY_ALONG_PATH_H
#define SCREWLINE_TRAJECTORY_ALONG_PATH_H

#include <vector>

#include "screwline/trajectory/path.h"
#include "screwline/trajectory/time_law.h"

namespace screwline {

/// The same scaling with a break wherever it crosses a breakpoint of the path, so that on each piece the motion is one
/// polynomial. The cycloidal scaling becomes 32 pieces of degree 7, C3 and within 1e-12 of it.
/// @pre the scaling never turns back.
PiecewisePolynomial scalingAlongPath(const JointPath& path, const TimeLaw& scaling);

/// Figures of q(length s(t / duration)) for every joint, by the exact polynomials of the composition: a peak is exact
/// to 1e-13 of itself, from above. @pre scaling comes from scalingAlongPath(); duration > 0.
std::vector<JointExtrema> extremaAlongPath(const JointPath& path, const PiecewisePolynomial& scaling, double duration);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_ALONG_PATH_H
