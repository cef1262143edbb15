#ifndef SCREWLINE_KINEMATICS_KERNEL_SWEEP_H
#define SCREWLINE_KINEMATICS_KERNEL_SWEEP_H

#include <array>

#include "screwline/model/serial_chain.h"
#include "screwline/spatial/sincos.h"

namespace screwline {

/// Runs once along a compiled chain and returns X_BT. `visit(axis, direction, point)` is told each axis where it now
/// is, base frame. q points to the joint values. No allocation. All sines and cosines are taken together, because they
/// cost the most.
template <typename Visitor>
inline Pose sweepKernel(const ChainKernel& kernel, const double* q, Visitor&& visit) {
  std::array<double, kMaxJoints> angle;
  std::array<double, kMaxJoints> sine;
  std::array<double, kMaxJoints> cosine;
  const std::size_t count = kernel.axes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const AxisKernel& axis = kernel.axes[i];
    angle[i] = axis.prismatic ? axis.offset : axis.offset + axis.multiplier * q[axis.source];
  }
  sincosMany(angle.data(), sine.data(), cosine.data(), static_cast<int>(count));

  Vector3 x = kernel.base.R.col(0);
  Vector3 y = kernel.base.R.col(1);
  Vector3 z = kernel.base.R.col(2);
  Vector3 p = kernel.base.p;
  for (std::size_t i = 0; i < count; ++i) {
    const AxisKernel& axis = kernel.axes[i];
    p += axis.p.x() * x + axis.p.y() * y + axis.p.z() * z;
    const Vector3 tilted_y = axis.cos_alpha * y + axis.sin_alpha * z;
    z = axis.cos_alpha * z - axis.sin_alpha * y;
    y = cosine[i] * tilted_y - sine[i] * x;
    x = cosine[i] * x + sine[i] * tilted_y;
    visit(axis, z, p);
    if (axis.prismatic) p += (axis.multiplier * q[axis.source]) * z;
  }
  Pose X_BT;
  for (int j = 0; j < 3; ++j) {
    X_BT.R.col(j) = kernel.tool.R(0, j) * x + kernel.tool.R(1, j) * y + kernel.tool.R(2, j) * z;
  }
  X_BT.p = p + kernel.tool.p.x() * x + kernel.tool.p.y() * y + kernel.tool.p.z() * z;
  return X_BT;
}

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_KERNEL_SWEEP_H
