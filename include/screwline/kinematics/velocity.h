#ifndef SCREWLINE_KINEMATICS_VELOCITY_H
#define SCREWLINE_KINEMATICS_VELOCITY_H

#include "screwline/kinematics/jacobian.h"

namespace screwline {

/// Twist [v; w] of the tip's origin, base frame: J(q) qd.
Vector6 tipTwist(const SerialChain& chain, const ConstVectorRef& q, const ConstVectorRef& velocity);

/// Joint rates that meet the task rows of a twist.
struct VelocitySolution {
  VectorX velocity;       ///< n; least norm where not unique.
  Vector6 twist;          ///< What they give, base frame.
  bool exact = false;     ///< residual < 1e-9 (1 + norm of the task rows) and no damping.
  double residual = 0.0;  ///< Norm over the task rows of wanted minus given; mixed SI units.
  double damping = 0.0;   ///< Damping factor lambda used; 0 away from singularities.
};

/// Least-squares rates: singular value decomposition; where the smallest singular value of the task Jacobian falls
/// below kDampingThreshold times the largest, damped by lambda^2 growing as it falls (Nakamura & Hanafusa 1986;
/// Maciejewski & Klein 1988), so that rates stay bounded and continuous. A twist that the arm can still give exactly is
/// given exactly, undamped.
VelocitySolution solveVelocity(const SerialChain& chain, const ConstVectorRef& q, const Vector6& twist,
                               const Task& task);

constexpr double kDampingThreshold = 1e-3;

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_VELOCITY_H
