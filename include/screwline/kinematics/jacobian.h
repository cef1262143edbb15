#ifndef SCREWLINE_KINEMATICS_JACOBIAN_H
#define SCREWLINE_KINEMATICS_JACOBIAN_H

#include "screwline/kinematics/forward.h"
#include "screwline/model/task.h"

namespace screwline {

/// The numbers of ComputeJacobian.srv.
enum class JacobianMethod {
  kGeometric = 0,
  kDirectDifferentiation = 1,
  kVelocityPropagation = 2,
  kForcePropagation = 3,
  kNumerical = 4,
};
constexpr int kJacobianMethodCount = 5;

/// Geometric Jacobian, 6 x n [v; w]: velocity of the tip's origin per joint rate, base frame; columns [axis x arm;
/// axis] and [axis; 0] (Craig, ch. 5; Angeles, ch. 5.2). Writes into J (resized only where its size differs: no
/// allocation when 6 x n already) and returns X_BT, which it computes on the way.
Pose geometricJacobian(const SerialChain& chain, const ConstVectorRef& q, Matrix6X& J);

/// The same Jacobian by one of five methods that share no code. Base frame, tip origin. Allocates.
///   direct differentiation: dual numbers through the product of exponentials, exact derivatives of the pose;
///   velocity propagation: outward over the modified-DH links, Craig eq. 5.45 to 5.48;
///   force propagation: inward, Craig eq. 5.80 and 5.81; its transpose;
///   numerical: central differences of the pose, error about 1e-9.
Matrix6X jacobian(const SerialChain& chain, const ConstVectorRef& q, JacobianMethod method);

/// J of the same rigid body's point displaced by r (base frame, from the tip's origin): v' = v + w x r.
Matrix6X movedReference(const Matrix6X& J, const Vector3& r);

/// J with both blocks expressed in another frame: R_FB applied to rows v and w.
Matrix6X expressedIn(const Matrix6X& J, const Matrix3& R_FB);

/// The task's rows of J, in task order: m x n. R_BT: the tip's orientation in J's frame, for rows about the tool's
/// axes. Allocates.
MatrixX taskJacobian(const Task& task, const Matrix6X& J, const Matrix3& R_BT);
/// Of a task without such rows. @throws Exception for others.
MatrixX taskJacobian(const Task& task, const Matrix6X& J);
/// At a configuration.
MatrixX taskJacobian(const SerialChain& chain, const ConstVectorRef& q, const Task& task);

/// Determinant where J is square, else NaN.
double determinantOrNan(const MatrixX& J);

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_JACOBIAN_H
