#include "screwline/kinematics/jacobian.h"

#include <limits>

#include <Eigen/LU>

#include "jacobian_methods.h"

namespace screwline {

Matrix6X jacobian(const SerialChain& chain, const ConstVectorRef& q, JacobianMethod method) {
  switch (method) {
    case JacobianMethod::kDirectDifferentiation:
      return differentiationJacobian(chain, q);
    case JacobianMethod::kVelocityPropagation:
      return velocityPropagationJacobian(chain, q);
    case JacobianMethod::kForcePropagation:
      return forcePropagationJacobian(chain, q);
    case JacobianMethod::kNumerical:
      return numericalJacobian(chain, q);
    case JacobianMethod::kGeometric:
      break;
  }
  Matrix6X J;
  geometricJacobian(chain, q, J);
  return J;
}

Matrix6X movedReference(const Matrix6X& J, const Vector3& r) {
  Matrix6X moved = J;
  for (Eigen::Index i = 0; i < J.cols(); ++i) {
    const Vector3 w = J.col(i).tail<3>();
    moved.col(i).head<3>() += w.cross(r);
  }
  return moved;
}

Matrix6X expressedIn(const Matrix6X& J, const Matrix3& R_FB) {
  Matrix6X turned(6, J.cols());
  turned.topRows<3>() = R_FB * J.topRows<3>();
  turned.bottomRows<3>() = R_FB * J.bottomRows<3>();
  return turned;
}

MatrixX taskJacobian(const Task& task, const Matrix6X& J, const Matrix3& R_BT) {
  return task.select(J, R_BT);
}

MatrixX taskJacobian(const Task& task, const Matrix6X& J) {
  return task.select(J);
}

MatrixX taskJacobian(const SerialChain& chain, const ConstVectorRef& q, const Task& task) {
  Matrix6X J;
  const Matrix3 R_BT = geometricJacobian(chain, q, J).R;
  return task.select(J, R_BT);
}

double determinantOrNan(const MatrixX& J) {
  if (J.rows() != J.cols()) return std::numeric_limits<double>::quiet_NaN();
  return J.determinant();
}

}  // namespace screwline
