#ifndef SCREWLINE_ROS_LINK_JACOBIAN_H
#define SCREWLINE_ROS_LINK_JACOBIAN_H

#include <array>

#include "screwline/kinematics/jacobian.h"

namespace screwline {
namespace ros_bridge {

/// Any link's Jacobian: where it is, and its Jacobian by each method.
struct LinkJacobians {
  Pose X_BL;
  std::array<Matrix6X, kJacobianMethodCount> by_method;  ///< 6 x n, [v; w] of the link's origin, base frame.
};

/// By all five methods, of a link of the chain; columns of joints beyond the link are zero. Allocates.
LinkJacobians linkJacobians(const SerialChain& chain, const Link& link, const ConstVectorRef& q);

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_LINK_JACOBIAN_H
