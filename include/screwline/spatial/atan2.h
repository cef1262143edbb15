#ifndef SCREWLINE_SPATIAL_ATAN2_H
#define SCREWLINE_SPATIAL_ATAN2_H

namespace screwline {

/// angle[i] of the point (x[i], y[i]), i < count: [-pi, pi], within 2 units in the last place; 0 at the origin. Numbers
/// are finite and below 1e300. No allocation; two at a time, which is why a solver takes its angles together. An
/// angle does not depend on what it is taken together with. Arrays may not overlap. See atan2_kernel.h.
void atan2Many(const double* y, const double* x, double* angle, int count);

}  // namespace screwline

#endif  // SCREWLINE_SPATIAL_ATAN2_H
