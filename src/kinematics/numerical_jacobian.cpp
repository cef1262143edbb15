#include <algorithm>
#include <cmath>

#include "jacobian_methods.h"

namespace screwline {
namespace {

constexpr double kStep = 1e-3;  ///< rad: balances h^4/30 of the extrapolated difference against rounding over h.

/// [v; S] with S the nine entries of dR/dq, by a central difference of half-width h.
struct PoseSlope {
  Vector3 p;
  Matrix3 R;
};

/// Leaves q as it was.
PoseSlope centralDifference(const SerialChain& chain, VectorX& q, Eigen::Index i, double h) {
  const double middle = q[i];
  q[i] = middle + h;
  const double above = q[i];
  const Pose X_plus = forwardKinematics(chain, q);
  q[i] = middle - h;
  const double width = above - q[i];
  const Pose X_minus = forwardKinematics(chain, q);
  q[i] = middle;
  return {(X_plus.p - X_minus.p) / width, (X_plus.R - X_minus.R) / width};
}

/// A joint's displacement turns its fastest axis by multiplier times it; the step keeps that turn at kStep.
double stepOf(const SerialChain& chain, Eigen::Index i) {
  double fastest = 1.0;
  for (const Axis& axis : chain.axes()) {
    if (axis.source == i) fastest = std::max(fastest, std::abs(axis.multiplier));
  }
  return kStep / fastest;
}

}  // namespace

Matrix6X numericalJacobian(const SerialChain& chain, const ConstVectorRef& q) {
  const Matrix3 R_TB = forwardKinematics(chain, q).R.transpose();
  Matrix6X J(6, chain.size());
  VectorX shifted = q;
  for (Eigen::Index i = 0; i < chain.size(); ++i) {
    // Richardson: two widths cancel the error of order h^2.
    const double h = stepOf(chain, i);
    const PoseSlope fine = centralDifference(chain, shifted, i, h);
    const PoseSlope coarse = centralDifference(chain, shifted, i, 2.0 * h);
    const Matrix3 spin = (4.0 * fine.R - coarse.R) / 3.0 * R_TB;
    J.col(i).head<3>() = (4.0 * fine.p - coarse.p) / 3.0;
    J.col(i).tail<3>() << spin(2, 1) - spin(1, 2), spin(0, 2) - spin(2, 0), spin(1, 0) - spin(0, 1);
    J.col(i).tail<3>() *= 0.5;
  }
  return J;
}

}  // namespace screwline
