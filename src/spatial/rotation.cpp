#include "screwline/spatial/rotation.h"

#include <Eigen/SVD>
#include <cmath>

namespace screwline {

Matrix3 skew(const Vector3& v) {
  Matrix3 S;
  S << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return S;
}

Matrix3 rotationAbout(const Vector3& axis, double angle) {
  const double s = std::sin(angle);
  // 1 - cos written so that it keeps its digits at small angles.
  const double half = std::sin(0.5 * angle);
  const Matrix3 S = skew(axis);
  return Matrix3::Identity() + s * S + 2.0 * half * half * S * S;
}

Vector3 rotationVector(const Matrix3& R) {
  // By the quaternion: its vector part keeps its digits at 0 and its scalar part at pi.
  Quaternion q(R);
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-300) return Vector3::Zero();
  return q.vec() * (2.0 * std::atan2(sine, q.w()) / sine);
}

double rotationAngle(const Matrix3& R) {
  return rotationVector(R).norm();
}

Vector3 anyPerpendicular(const Vector3& axis) {
  Eigen::Index smallest = 0;
  axis.cwiseAbs().minCoeff(&smallest);
  return axis.cross(Vector3::Unit(smallest)).normalized();
}

Matrix3 orthonormalized(const Matrix3& M) {
  const Eigen::JacobiSVD<Matrix3> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 R = svd.matrixU() * svd.matrixV().transpose();
  if (R.determinant() < 0.0) {
    Matrix3 U = svd.matrixU();
    U.col(2) = -U.col(2);
    R = U * svd.matrixV().transpose();
  }
  return R;
}

double wrapAngle(double angle) {
  if (angle > -kPi && angle <= kPi) return angle;
  const double wrapped = std::remainder(angle, kTwoPi);
  return wrapped <= -kPi ? wrapped + kTwoPi : wrapped;
}

}  // namespace screwline
