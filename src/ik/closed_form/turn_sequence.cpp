#include "screwline/ik/closed_form/turn_sequence.h"

#include <cmath>

#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr double kParallel = 1e-15;  // Sine of a tilt that rounding may have made.

/// Unit vector across both; any across the first where they are parallel. What rounding puts along the first is taken
/// off.
Vector3 commonNormal(const Vector3& first, const Vector3& second) {
  const Vector3 normal = first.cross(second);
  const double length = normal.norm();
  if (length == 0.0) return anyPerpendicular(first);
  const Vector3 across = normal / length - first * first.dot(normal / length);
  return across.norm() > 0.5 ? Vector3(across.normalized()) : anyPerpendicular(first);
}

/// The turn about `axis` from one direction across it to another.
Turn turnAbout(const Vector3& axis, const Vector3& from, const Vector3& to) {
  return normalized({from.dot(to), axis.dot(from.cross(to))});
}

/// A row of a matrix, two of its numbers in one register.
struct Row {
  using Two = double __attribute__((vector_size(16)));

  Row(const Matrix3& M, int row) : xy{M(row, 0), M(row, 1)}, z(M(row, 2)) {}
  void store(int row, Matrix3& M) const {
    M(row, 0) = xy[0];
    M(row, 1) = xy[1];
    M(row, 2) = z;
  }

  Two xy;
  double z;
};

/// Takes a turn that leads from the direction of row a to that of row b off them.
void mixRows(const Turn& turn, Row& a, Row& b) {
  const Row old = a;
  a.xy = turn.c * a.xy + turn.s * b.xy;
  a.z = turn.c * a.z + turn.s * b.z;
  b.xy = turn.c * b.xy - turn.s * old.xy;
  b.z = turn.c * b.z - turn.s * old.z;
}

}  // namespace

TurnSequence::TurnSequence(const std::array<Axis, 3>& axes, const Matrix3& N) {
  Vector3 before = commonNormal(axes[0].direction, axes[1].direction);
  base_ << before, axes[0].direction.cross(before), axes[0].direction;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3& axis = axes[i].direction;
    const Vector3 next = i < 2 ? axes[i + 1].direction : Vector3(N.col(2));
    const Vector3 normal = commonNormal(axis, next);
    offset_[i] = turnAbout(axis, before, normal);
    tilt_[i] = turnAbout(normal, axis, next);
    parallel_[i] = tilt_[i].c > 0.0 && std::abs(tilt_[i].s) <= kParallel;
    before = normal;
  }
  last_ = turnAbout(N.col(2), before, N.col(0));
}

void TurnSequence::undo(const std::array<Turn, 3>& turns, Matrix3& M) const {
  Row x(M, 0);
  Row y(M, 1);
  Row z(M, 2);
  Turn about_z;  // What has not been taken off yet: turns about parallel axes add up.
  for (std::size_t i = 0; i < 3; ++i) {
    about_z = about_z * turns[i] * offset_[i];
    if (parallel_[i]) continue;
    mixRows(about_z, x, y);
    mixRows(tilt_[i], y, z);
    about_z = Turn();
  }
  mixRows(about_z * last_, x, y);
  x.store(0, M);
  y.store(1, M);
  z.store(2, M);
}

}  // namespace screwline
