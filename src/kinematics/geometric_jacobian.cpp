#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/kernel_sweep.h"

namespace screwline {

Pose geometricJacobian(const SerialChain& chain, const ConstVectorRef& q, Matrix6X& J) {
  if (J.cols() != chain.size()) J.resize(6, chain.size());
  std::array<Vector3, kMaxJoints> directions;
  std::array<Vector3, kMaxJoints> points;
  std::size_t count = 0;
  const Pose X_BT =
      sweepKernel(chain.kernel(), q.data(), [&](const AxisKernel&, const Vector3& direction, const Vector3& point) {
        directions[count] = direction;
        points[count] = point;
        ++count;
      });
  if (chain.hasMimic()) J.setZero();
  for (std::size_t i = 0; i < count; ++i) {
    const AxisKernel& axis = chain.kernel().axes[i];
    Vector6 column;
    if (axis.prismatic) {
      column << directions[i], Vector3::Zero();
    } else {
      column << directions[i].cross(X_BT.p - points[i]), directions[i];
    }
    if (chain.hasMimic()) {
      J.col(axis.source) += axis.multiplier * column;
    } else {
      J.col(static_cast<Eigen::Index>(i)) = column;
    }
  }
  return X_BT;
}

}  // namespace screwline
