#ifndef SCREWLINE_SRC_IK_CLOSED_FORM_ELIMINANT_H
#define SCREWLINE_SRC_IK_CLOSED_FORM_ELIMINANT_H

#include <array>
#include <cmath>

#include "screwline/ik/closed_form/roots.h"
#include "screwline/model/joint.h"

namespace screwline {

/// A function of the third displacement: k + a cos(q) + b sin(q) for a turn, k + a q + b q^2 for a slide.
struct Form {
  double k = 0.0;
  double a = 0.0;
  double b = 0.0;
};

inline Form operator*(double factor, const Form& f) {
  return {factor * f.k, factor * f.a, factor * f.b};
}
inline Form operator+(const Form& f, double constant) {
  return {f.k + constant, f.a, f.b};
}

/// Products of forms: 1, cos, sin, cos 2q, sin 2q for a turn, 1 to q^4 for a slide.
using SquareForm = std::array<double, 5>;

inline SquareForm squared(const Form& f, bool slide) {
  if (slide) return {f.k * f.k, 2.0 * f.k * f.a, f.a * f.a + 2.0 * f.k * f.b, 2.0 * f.a * f.b, f.b * f.b};
  return {f.k * f.k + 0.5 * (f.a * f.a + f.b * f.b), 2.0 * f.k * f.a, 2.0 * f.k * f.b, 0.5 * (f.a * f.a - f.b * f.b),
          f.a * f.b};
}

/// The point that the third axis carries: center + cos(q) e + sin(q) f for a turn, center + q e for a slide.
struct CarriedPoint {
  CarriedPoint(const Axis& axis, const Vector3& start) : slide(axis.prismatic) {
    if (slide) {
      center = start;
      e = axis.direction;
    } else {
      center = axis.point + axis.direction * axis.direction.dot(start - axis.point);
      e = start - center;
      f = axis.direction.cross(e);
    }
  }
  Vector3 at(double q) const {
    return slide ? Vector3(center + q * e) : Vector3(center + std::cos(q) * e + std::sin(q) * f);
  }
  Vector3 at(double displacement, const Turn& turn) const {
    return slide ? Vector3(center + displacement * e) : Vector3(center + turn.c * e + turn.s * f);
  }
  /// direction . (point - origin)
  Form along(const Vector3& direction, const Vector3& origin) const {
    return {direction.dot(center - origin), direction.dot(e), slide ? 0.0 : direction.dot(f)};
  }
  /// |point - origin|^2
  Form squareFrom(const Vector3& origin) const {
    const Vector3 r = center - origin;
    if (slide) return {r.squaredNorm(), 2.0 * r.dot(e), 1.0};
    return {r.squaredNorm() + e.squaredNorm(), 2.0 * r.dot(e), 2.0 * r.dot(f)};
  }

  bool slide;
  Vector3 center;
  Vector3 e;
  Vector3 f = Vector3::Zero();
};

inline RealRoots solveForm(const Form& f, bool slide, double scale) {
  if (!slide) return solveSinusoid(f.k, f.a, f.b, scale);
  const double c[3] = {f.k, f.a, f.b};
  return solvePolynomial(c, 2, scale);
}

/// f^2 + g^2 - rest - constant = 0
inline RealRoots solveSquares(const SquareForm& f2, const SquareForm& g2, const SquareForm& rest, double scale,
                              bool slide) {
  SquareForm sum;
  for (std::size_t i = 0; i < 5; ++i) sum[i] = f2[i] + g2[i] - rest[i];
  if (slide) return solvePolynomial(sum.data(), 4, scale);
  return solveSecondHarmonic(sum[0], sum[1], sum[2], sum[3], sum[4], scale);
}

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_CLOSED_FORM_ELIMINANT_H
