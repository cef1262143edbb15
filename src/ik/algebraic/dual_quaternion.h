#ifndef SCREWLINE_SRC_IK_ALGEBRAIC_DUAL_QUATERNION_H
#define SCREWLINE_SRC_IK_ALGEBRAIC_DUAL_QUATERNION_H

#include "screwline/model/joint.h"
#include "screwline/spatial/pose.h"

namespace screwline {

/// Dual quaternion, real part (w, x, y, z) first. A pose is r + eps t r / 2, up to any factor but zero.
using DualQuaternion = Eigen::Matrix<double, 8, 1>;

namespace dual_quaternion_detail {

inline void addProduct(const double* a, const double* b, double* c) {
  c[0] += a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
  c[1] += a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
  c[2] += a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
  c[3] += a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

}  // namespace dual_quaternion_detail

inline DualQuaternion multiply(const DualQuaternion& a, const DualQuaternion& b) {
  DualQuaternion c = DualQuaternion::Zero();
  dual_quaternion_detail::addProduct(a.data(), b.data(), c.data());
  dual_quaternion_detail::addProduct(a.data(), b.data() + 4, c.data() + 4);
  dual_quaternion_detail::addProduct(a.data() + 4, b.data(), c.data() + 4);
  return c;
}

/// Inverse, up to the squared norm.
inline DualQuaternion conjugate(const DualQuaternion& a) {
  DualQuaternion c = -a;
  c[0] = a[0];
  c[4] = a[4];
  return c;
}

inline DualQuaternion toDualQuaternion(const Pose& X) {
  const Quaternion r(X.R);
  const Quaternion t(0.0, X.p.x(), X.p.y(), X.p.z());
  const Quaternion d = t * r;
  DualQuaternion c;
  c << r.w(), r.x(), r.y(), r.z(), 0.5 * d.w(), 0.5 * d.x(), 0.5 * d.y(), 0.5 * d.z();
  return c;
}

/// S where cos(q/2) + sin(q/2) S is the motion of a revolute axis by q, 1 + (q/2) S that of a prismatic one.
inline DualQuaternion screwOf(const Axis& axis) {
  DualQuaternion S = DualQuaternion::Zero();
  if (axis.prismatic) {
    S.tail<3>() = axis.direction;
  } else {
    S.segment<3>(1) = axis.direction;
    S.tail<3>() = axis.point.cross(axis.direction);
  }
  return S;
}

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALGEBRAIC_DUAL_QUATERNION_H
