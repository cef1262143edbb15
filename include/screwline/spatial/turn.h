#ifndef SCREWLINE_SPATIAL_TURN_H
#define SCREWLINE_SPATIAL_TURN_H

#include <cmath>

#include "screwline/spatial/pose.h"

namespace screwline {

/// An angle by its cosine and sine: sums, differences and rotations need no other function. The closed forms compute
/// with turns and take the angles at the end (atan2.h).
struct Turn {
  double c = 1.0;
  double s = 0.0;

  Turn inverse() const { return {c, -s}; }
  Turn opposite() const { return {-c, -s}; }
  double angle() const { return std::atan2(s, c); }
};

/// Sum of the angles; lengths multiply where they are not 1.
inline Turn operator*(const Turn& a, const Turn& b) {
  return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s};
}

inline Turn turnBy(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

/// Of length 1; the origin, as atan2() has it, is no turn.
inline Turn normalized(const Turn& turn) {
  const double square = turn.c * turn.c + turn.s * turn.s;
  if (!(square > 0.0)) return {};
  const double scale = 1.0 / std::sqrt(square);
  return {scale * turn.c, scale * turn.s};
}

/// The turn that takes the direction of (from_x, from_y) to that of (to_x, to_y).
inline Turn turnBetween(double from_x, double from_y, double to_x, double to_y) {
  return normalized({to_x * from_x + to_y * from_y, to_y * from_x - to_x * from_y});
}

/// v turned about the unit vector `axis` (Rodrigues).
inline Vector3 turned(const Vector3& axis, const Turn& turn, const Vector3& v) {
  return turn.c * v + turn.s * axis.cross(v) + (1.0 - turn.c) * axis.dot(v) * axis;
}

}  // namespace screwline

#endif  // SCREWLINE_SPATIAL_TURN_H
