#ifndef SCREWLINE_IK_CLOSED_FORM_TURN_H
#define SCREWLINE_IK_CLOSED_FORM_TURN_H

#include <cmath>

#include "screwline/spatial/pose.h"

namespace screwline {

/// An angle as cosine and sine, a unit complex number: stages that follow one another need no arc functions.
struct Turn {
  double c = 1.0;
  double s = 0.0;

  static Turn of(double angle) { return {std::cos(angle), std::sin(angle)}; }
  /// Along the vector (x, y) != 0.
  static Turn along(double x, double y) {
    const double unit = 1.0 / std::sqrt(x * x + y * y);
    return {unit * x, unit * y};
  }
  Turn inverse() const { return {c, -s}; }
  double angle() const { return std::atan2(s, c); }
};

inline Turn operator*(const Turn& a, const Turn& b) {
  return {a.c * b.c - a.s * b.s, a.c * b.s + a.s * b.c};
}

/// v turned about the unit vector `axis` (Rodrigues).
inline Vector3 turned(const Vector3& axis, const Turn& turn, const Vector3& v) {
  return turn.c * v + turn.s * axis.cross(v) + (1.0 - turn.c) * axis.dot(v) * axis;
}

}  // namespace screwline

#endif  // SCREWLINE_IK_CLOSED_FORM_TURN_H
