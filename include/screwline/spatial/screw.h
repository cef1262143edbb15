#ifndef SCREWLINE_SPATIAL_SCREW_H
#define SCREWLINE_SPATIAL_SCREW_H

#include "screwline/spatial/pose.h"

namespace screwline {

/// Screw axis S = [v; w] of a revolute joint about unit `axis` through `point`: w = axis, v = point x axis (Lynch &
/// Park, ch. 3.3.2).
Vector6 revoluteScrew(const Vector3& axis, const Vector3& point);

/// Screw axis [axis; 0] of a prismatic joint along unit `axis`.
Vector6 prismaticScrew(const Vector3& axis);

/// Matrix exponential e^([S] q) of a screw axis with |w| = 1, or w = 0 and |v| = 1 (Lynch & Park, prop. 3.25).
Pose screwExponential(const Vector6& S, double q);

/// Matrix logarithm: the twist [v; w] with exp = X; rotation angle in [0, pi].
Vector6 poseLogarithm(const Pose& X);

/// Ad_X (linear first): maps a twist about B's origin in B coordinates to one about A's origin in A coordinates, X =
/// X_AB.
Matrix6 adjoint(const Pose& X);

/// Twist difference that takes `from` to `to`: [p_to - p_from; rotation vector of R_to R_from^T], both in the base
/// frame.
Vector6 poseDifference(const Pose& to, const Pose& from);

}  // namespace screwline

#endif  // SCREWLINE_SPATIAL_SCREW_H
