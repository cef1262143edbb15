#include "screwline/kinematics/forward.h"

#include "screwline/kinematics/kernel_sweep.h"
#include "screwline/spatial/screw.h"

namespace screwline {
namespace {

Pose axisMotion(const Axis& axis, double q_source) {
  const Vector6 S = axis.prismatic ? prismaticScrew(axis.direction) : revoluteScrew(axis.direction, axis.point);
  return screwExponential(S, axis.multiplier * q_source);
}

Pose exponentials(const SerialChain& chain, const ConstVectorRef& q, int axis_count) {
  Pose X;
  for (int i = 0; i < axis_count; ++i) {
    const Axis& axis = chain.axes()[static_cast<std::size_t>(i)];
    X = X * axisMotion(axis, q[axis.source]);
  }
  return X;
}

}  // namespace

Pose forwardKinematics(const SerialChain& chain, const ConstVectorRef& q) {
  return sweepKernel(chain.kernel(), q.data(), [](const AxisKernel&, const Vector3&, const Vector3&) {});
}

Pose linkPose(const SerialChain& chain, const Link& link, const ConstVectorRef& q) {
  return exponentials(chain, q, link.axis_count) * link.home;
}

Pose forwardByExponentials(const SerialChain& chain, const ConstVectorRef& q) {
  return exponentials(chain, q, static_cast<int>(chain.axes().size())) * chain.home();
}

}  // namespace screwline
