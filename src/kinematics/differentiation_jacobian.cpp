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

/// Of factors of which one or none carries a derivative: constants cost half of what duals do.
template <class A, class B>
auto operator*(const Transform<A>& X, const Transform<B>& Y) {
  Transform<decltype(A() * B())> Z;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      Z.R[i][j] = X.R[i][0] * Y.R[0][j] + X.R[i][1] * Y.R[1][j] + X.R[i][2] * Y.R[2][j];
    }
    Z.p[i] = X.R[i][0] * Y.p[0] + X.R[i][1] * Y.p[1] + X.R[i][2] * Y.p[2] + X.p[i];
  }
  return Z;
}

Transform<double> valueOf(const Transform<Dual>& X) {
  Transform<double> value;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) value.R[i][j] = X.R[i][j].value;
    value.p[i] = X.p[i].value;
  }
  return value;
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
  const std::vector<Axis>& axes = chain.axes();
  std::vector<Transform<Dual>> exponentials;
  exponentials.reserve(axes.size());
  for (const Axis& axis : axes) {
    exponentials.push_back(exponential(axis, Dual(axis.multiplier * q[axis.source], axis.multiplier)));
  }
  // What follows each axis, the tip's home included.
  std::vector<Transform<double>> after(axes.size(), fromPose<double>(chain.home()));
  for (std::size_t i = axes.size(); i-- > 1;) after[i - 1] = valueOf(exponentials[i]) * after[i];
  Matrix6X J = Matrix6X::Zero(6, chain.size());
  Transform<double> before = fromPose<double>(Pose());
  for (std::size_t i = 0; i < axes.size(); ++i) {
    J.col(axes[i].source) += twistOf(before * exponentials[i] * after[i]);
    before = before * valueOf(exponentials[i]);
  }
  return J;
}

}  // namespace screwline
