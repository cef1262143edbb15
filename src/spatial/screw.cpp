#include "screwline/spatial/screw.h"

#include <cmath>

#include "screwline/spatial/rotation.h"

namespace screwline {

Vector6 revoluteScrew(const Vector3& axis, const Vector3& point) {
  Vector6 S;
  S << point.cross(axis), axis;
  return S;
}

Vector6 prismaticScrew(const Vector3& axis) {
  Vector6 S;
  S << axis, Vector3::Zero();
  return S;
}

Pose screwExponential(const Vector6& S, double q) {
  const Vector3 v = S.head<3>();
  const Vector3 w = S.tail<3>();
  if (w.squaredNorm() == 0.0) return {Matrix3::Identity(), v * q};
  const double half = std::sin(0.5 * q);
  const Vector3 wv = w.cross(v);
  const Vector3 wwv = w.cross(wv);
  return {rotationAbout(w, q), v * q + 2.0 * half * half * wv + (q - std::sin(q)) * wwv};
}

Vector6 poseLogarithm(const Pose& X) {
  const Vector3 w = rotationVector(X.R);
  const double angle = w.norm();
  // (1 - (angle/2) cot(angle/2)) / angle^2, whose limit at 0 is 1/12 (Lynch & Park, eq. 3.92).
  const double k =
      angle < 1e-4 ? 1.0 / 12.0 : (1.0 - 0.5 * angle * std::cos(0.5 * angle) / std::sin(0.5 * angle)) / (angle * angle);
  const Vector3 wp = w.cross(X.p);
  Vector6 twist;
  twist << X.p - 0.5 * wp + k * w.cross(wp), w;
  return twist;
}

Matrix6 adjoint(const Pose& X) {
  Matrix6 A;
  A << X.R, skew(X.p) * X.R, Matrix3::Zero(), X.R;
  return A;
}

Vector6 poseDifference(const Pose& to, const Pose& from) {
  Vector6 difference;
  difference << to.p - from.p, rotationVector(to.R * from.R.transpose());
  return difference;
}

}  // namespace screwline
