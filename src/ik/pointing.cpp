#include "pointing.h"

#include <algorithm>
#include <cmath>

namespace screwline {
namespace {

constexpr double kSmallAngle = 1e-2;  ///< [rad] Series below: the next terms are beyond 1e-16 of the first.
constexpr double kLeastSine = 1e-8;   ///< Near opposite directions.
constexpr double kOpposite = 1e-15;   ///< Sine of directions with no turn between them but any half turn.

}  // namespace

Vector3 pointingTurn(const Matrix3& target, const Matrix3& actual, int axis) {
  const Vector3 from = actual.col(axis);
  const Vector3 to = target.col(axis);
  const Vector3 across = from.cross(to);
  const double sine = across.norm();
  const double cosine = from.dot(to);
  if (sine <= kOpposite && cosine < 0.0) return kPi * actual.col((axis + 1) % 3);
  return sine > 0.0 ? Vector3(across * (std::atan2(sine, cosine) / sine)) : Vector3::Zero();
}

/// In tool coordinates, with e the axis, b the wanted direction, t the angle between them: the turn is f m with m = e x
/// b and f = t / sin t. A turning w of the tool moves b by b x w.
Matrix3 pointingDerivative(const Matrix3& target, const Matrix3& actual, int axis) {
  const Vector3 e = Vector3::Unit(axis);
  const Vector3 b = actual.transpose() * target.col(axis);
  const Vector3 m = e.cross(b);
  const double sine = std::max(m.norm(), kLeastSine);
  const double angle = std::atan2(m.norm(), b[axis]);
  double f = angle / sine;
  double slope = (sine - angle * b[axis]) / (sine * sine * sine);  // df / d(cos t) = -slope
  if (angle < kSmallAngle) {
    const double squared = angle * angle;
    f = 1.0 + squared / 6.0 + 7.0 * squared * squared / 360.0;
    slope = 1.0 / 3.0 + 2.0 * squared / 15.0 + 2.0 * squared * squared / 63.0;
  }
  return slope * m * m.transpose() + f * (b[axis] * Matrix3::Identity() - b * e.transpose());
}

}  // namespace screwline
