#include "screwline/model/chain_kernel.h"

#include <cmath>

#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

/// A frame on an axis: z along it, origin on it.
/// Unit vector perpendicular to both axes; any perpendicular where they are parallel. The cross product of two almost
/// parallel axes is mostly rounding, even along them: taking off that part keeps the frames orthonormal.
Vector3 commonNormal(const Vector3& first, const Vector3& second) {
  const Vector3 normal = first.cross(second);
  const double length = normal.norm();
  if (length == 0.0) return anyPerpendicular(first);
  const Vector3 across = normal / length - first * first.dot(normal / length);
  return across.norm() > 0.5 ? Vector3((across - first * first.dot(across)).normalized()) : anyPerpendicular(first);
}

}  // namespace

ChainKernel compileChain(const std::vector<Axis>& axes, const Pose& home) {
  ChainKernel kernel;
  // frame = the frame on the axis before, at zero, after its rotation; the base for the first axis, with the axis along
  // its z.
  Pose frame;
  kernel.axes.reserve(axes.size());
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Axis& axis = axes[i];
    AxisKernel k;
    k.prismatic = axis.prismatic;
    k.multiplier = axis.multiplier;
    k.source = axis.source;
    if (i == 0) {
      kernel.base = {frameOn(axis.direction, anyPerpendicular(axis.direction)), axis.point};
      frame = kernel.base;
    } else {
      // The frame before is turned about its own axis until its x is the common normal: that turn was left open as its
      // offset.
      const Vector3 previous = axes[i - 1].direction;
      const Vector3 x = commonNormal(previous, axis.direction);
      kernel.axes.back().offset += std::atan2(x.dot(frame.R.col(1)), x.dot(frame.R.col(0)));
      const Pose before = {frameOn(previous, x), axes[i - 1].point};
      k.p = before.R.transpose() * (axis.point - before.p);
      const Vector3 direction = before.R.transpose() * axis.direction;
      const double length = std::hypot(direction.y(), direction.z());
      k.sin_alpha = -direction.y() / length;
      k.cos_alpha = direction.z() / length;
      frame = {frameOn(axis.direction, x), axis.point};
    }
    kernel.axes.push_back(k);
  }
  kernel.tool = frame.inverse() * home;
  return kernel;
}

}  // namespace screwline
