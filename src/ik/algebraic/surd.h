#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_SURD_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_SURD_H

#include <cmath>

#include "screwline/spatial/pose.h"

namespace screwline {

/// a + b w, where w^2 is known and w has either sign: a number on both branches of a square root at once. It stays real
/// where w is not.
struct Surd {
  double a = 0.0;
  double b = 0.0;

  double at(double w) const { return a + b * w; }
};

struct SurdVector {
  Vector3 a = Vector3::Zero();
  Vector3 b = Vector3::Zero();

  Vector3 at(double w) const { return a + w * b; }
};

/// An angle by its cosine and sine.
struct SurdTurn {
  Surd cosine;
  Surd sine;

  double at(double w) const { return std::atan2(sine.at(w), cosine.at(w)); }
};

inline SurdVector operator+(const SurdVector& u, const SurdVector& v) {
  return {u.a + v.a, u.b + v.b};
}
inline SurdVector operator-(const SurdVector& u, const SurdVector& v) {
  return {u.a - v.a, u.b - v.b};
}
inline SurdVector cross(const Vector3& u, const SurdVector& v) {
  return {u.cross(v.a), u.cross(v.b)};
}
inline Surd dot(const Vector3& u, const SurdVector& v) {
  return {u.dot(v.a), u.dot(v.b)};
}
inline Surd operator*(double x, const Surd& y) {
  return {x * y.a, x * y.b};
}

/// Those of two surds, with w^2.
inline SurdVector product(const Surd& x, const SurdVector& v, double square) {
  return {x.a * v.a + (square * x.b) * v.b, x.a * v.b + x.b * v.a};
}
inline SurdVector cross(const SurdVector& u, const SurdVector& v, double square) {
  return {u.a.cross(v.a) + square * u.b.cross(v.b), u.a.cross(v.b) + u.b.cross(v.a)};
}
inline Surd dot(const SurdVector& u, const SurdVector& v, double square) {
  return {u.a.dot(v.a) + square * u.b.dot(v.b), u.a.dot(v.b) + u.b.dot(v.a)};
}

/// v turned about the unit vector `axis` (Rodrigues).
inline SurdVector turned(const Vector3& axis, const SurdTurn& turn, const SurdVector& v, double square) {
  const SurdVector across = cross(axis, v);
  const Surd less = {1.0 - turn.cosine.a, -turn.cosine.b};
  return v + product(turn.sine, across, square) + product(less, cross(axis, across), square);
}

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_SURD_H
