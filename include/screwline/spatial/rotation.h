#ifndef SCREWLINE_SPATIAL_ROTATION_H
#define SCREWLINE_SPATIAL_ROTATION_H

#include <cmath>

#include "screwline/spatial/pose.h"

namespace screwline {

/// [v]x, the matrix with skew(v) u = v x u.
Matrix3 skew(const Vector3& v);

/// Rotation by `angle` [rad] about the unit vector `axis` (Rodrigues).
Matrix3 rotationAbout(const Vector3& axis, double angle);

/// Rotation vector (axis times angle, angle in [0, pi]) of R; accurate at 0 and at pi. Inverse of exp(skew(.)).
Vector3 rotationVector(const Matrix3& R);

/// Angle [rad] in [0, pi] of the rotation R.
double rotationAngle(const Matrix3& R);

/// Some unit vector perpendicular to the unit vector `axis`; the same for the same input.
Vector3 anyPerpendicular(const Vector3& axis);

/// Right-handed frame with the unit vector `z`; x, of norm 1, perpendicular to it.
inline Matrix3 frameOn(const Vector3& z, const Vector3& x) {
  Matrix3 frame;
  frame << x, z.cross(x), z;
  return frame;
}

/// Nearest rotation matrix to M (polar decomposition): takes off rounding, not errors of substance.
Matrix3 orthonormalized(const Matrix3& M);

/// Angle wrapped to (-pi, pi].
double wrapAngle(double angle);

/// std::remainder(angle, 2 pi) to the bit, in [-pi, pi]; most often a comparison, or a difference that is exact.
inline double withoutTurns(double angle) {
  const double size = std::abs(angle);
  if (size <= kPi) return angle;
  return size < 1.4 * kTwoPi ? angle - std::copysign(kTwoPi, angle) : std::remainder(angle, kTwoPi);
}

}  // namespace screwline

#endif  // SCREWLINE_SPATIAL_ROTATION_H
