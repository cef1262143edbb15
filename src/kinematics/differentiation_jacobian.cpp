#include <array>

#include "dual.h"
#include "jacobian_methods.h"

namespace screwline {
namespace {

template <class T>
struct Transform {
  std::array<std::array<T, 3>, 3> R;
  std::array<T, 3> p;
};

template <class T>
Transform<T> fromPose(const Pose& X) {
  Transform<T> M;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Index row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < 3; ++j) M.R[i][j] = T(X.R(row, static_cast<Eigen::Index>(j)));
    M.p[i] = T(X.p[row]);
  }
  return M;
}

template <class T>
Transform<T> operator*(const Transform<T>& A, const Transform<T>& B) {
  Transform<T> C = A;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      C.R[i][j] = A.R[i][0] * B.R[0][j] + A.R[i][1] * B.R[1][j] + A.R[i][2] * B.R[2][j];
    }
    C.p[i] = A.R[i][0] * B.p[0] + A.R[i][1] * B.p[1] + A.R[i][2] * B.p[2] + A.p[i];
  }
  return C;
}

/// e^([S] displacement): Rodrigues' formula about the axis' point, or a translation (Lynch & Park, prop. 3.25).
template <class T>
Transform<T> exponential(const Axis& axis, const T& displacement) {
  Transform<T> X = fromPose<T>(Pose());
  const Vector3& u = axis.direction;
  if (axis.prismatic) {
    for (std::size_t i = 0; i < 3; ++i) X.p[i] = T(u[static_cast<Eigen::Index>(i)]) * displacement;
    return X;
  }
  Matrix3 K;
  K << 0.0, -u.z(), u.y(), u.z(), 0.0, -u.x(), -u.y(), u.x(), 0.0;
  const Matrix3 K2 = K * K;
  const Vector3 Kp = K * axis.point;
  const Vector3 K2p = K2 * axis.point;
  const T s = sin(displacement);
  const T one_minus_c = T(1.0) - cos(displacement);
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Index row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < 3; ++j) {
      const Eigen::Index col = static_cast<Eigen::Index>(j);
      X.R[i][j] = X.R[i][j] + T(K(row, col)) * s + T(K2(row, col)) * one_minus_c;
    }
    X.p[i] = T(0.0) - T(Kp[row]) * s - T(K2p[row]) * one_minus_c;
  }
  return X;
}

template <class T>
Transform<T> tipPose(const SerialChain& chain, const std::vector<T>& q) {
  Transform<T> X = fromPose<T>(Pose());
  for (const Axis& axis : chain.axes()) {
    X = X * exponential<T>(axis, T(axis.multiplier) * q[static_cast<std::size_t>(axis.source)]);
  }
  return X * fromPose<T>(chain.home());
}

/// Twist of a pose that changes: v = dp, [w]x = dR R^T.
Vector6 twistOf(const Transform<Dual>& X) {
  const auto spin = [&X](std::size_t i, std::size_t j) {
    return X.R[i][0].slope * X.R[j][0].value + X.R[i][1].slope * X.R[j][1].value + X.R[i][2].slope * X.R[j][2].value;
  };
  Vector6 V;
  V << X.p[0].slope, X.p[1].slope, X.p[2].slope, spin(2, 1), spin(0, 2), spin(1, 0);
  return V;
}

}  // namespace

Matrix6X differentiationJacobian(const SerialChain& chain, const ConstVectorRef& q) {
  std::vector<Dual> variables(static_cast<std::size_t>(chain.size()));
  for (std::size_t i = 0; i < variables.size(); ++i) variables[i] = Dual(q[static_cast<Eigen::Index>(i)]);
  Matrix6X J(6, chain.size());
  for (std::size_t i = 0; i < variables.size(); ++i) {
    variables[i].slope = 1.0;
    J.col(static_cast<Eigen::Index>(i)) = twistOf(tipPose<Dual>(chain, variables));
    variables[i].slope = 0.0;
  }
  return J;
}

}  // namespace screwline
