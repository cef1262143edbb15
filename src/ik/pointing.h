#ifndef SCREWLINE_SRC_IK_POINTING_H
#define SCREWLINE_SRC_IK_POINTING_H

#include "screwline/spatial/pose.h"

namespace screwline {

/// The smallest turn that takes the tool's axis number `axis` (0..2) from its direction in the orientation `actual` to
/// that in `target`: rotation vector [rad], base frame, across the axis, of length 0 to pi. Where the two are opposite,
/// about the tool's next axis. Accurate at 0.
Vector3 pointingTurn(const Matrix3& target, const Matrix3& actual, int axis);

/// Minus the derivative of that turn, in tool coordinates, by the tool's turning (tool coordinates): the identity
/// across the axis where the directions agree. Exact elsewhere too; what grows without bound at opposite directions is
/// held finite.
Matrix3 pointingDerivative(const Matrix3& target, const Matrix3& actual, int axis);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_POINTING_H
