#ifndef SCREWLINE_SPATIAL_POSE_H
#define SCREWLINE_SPATIAL_POSE_H

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace screwline {

using Vector3 = Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;  ///< Linear first: twist [v; w], wrench [f; n], screw axis [v; w].
using VectorX = Eigen::VectorXd;
using Matrix3 = Eigen::Matrix3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix6X = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using MatrixX = Eigen::MatrixXd;
using Quaternion = Eigen::Quaterniond;
using ConstVectorRef = Eigen::Ref<const VectorX>;

constexpr double kPi = 3.14159265358979323846;
constexpr double kTwoPi = 2.0 * kPi;

/// Rigid transform X_AB: maps coordinates in B to coordinates in A, x_A = R x_B + p. Lengths in m.
struct Pose {
  Matrix3 R = Matrix3::Identity();  ///< R_AB, columns are B's axes in A.
  Vector3 p = Vector3::Zero();      ///< p_AB_A, B's origin from A's origin, in A.

  Pose inverse() const { return {R.transpose(), -(R.transpose() * p)}; }
};

inline Pose operator*(const Pose& X_AB, const Pose& X_BC) {
  return {X_AB.R * X_BC.R, X_AB.R * X_BC.p + X_AB.p};
}
inline Vector3 operator*(const Pose& X_AB, const Vector3& p_B) {
  return X_AB.R * p_B + X_AB.p;
}

/// True where no entry of position [m] or rotation matrix differs by more than tolerance.
inline bool isApprox(const Pose& a, const Pose& b, double tolerance) {
  return (a.p - b.p).cwiseAbs().maxCoeff() <= tolerance && (a.R - b.R).cwiseAbs().maxCoeff() <= tolerance;
}

}  // namespace screwline

#endif  // SCREWLINE_SPATIAL_POSE_H
