#include "jacobian_rate.h"

#include "screwline/kinematics/jacobian.h"

namespace screwline {

void jacobianRate(const SerialChain& chain, const VectorX& q, const VectorX& rates, const Matrix6X& J,
                  Matrix6X& J_rate) {
  const int n = chain.size();
  if (chain.hasMimic()) {
    constexpr double kStep = 1e-5;
    Matrix6X behind(6, n);
    geometricJacobian(chain, q + kStep * rates, J_rate);
    geometricJacobian(chain, q - kStep * rates, behind);
    J_rate = (J_rate - behind) / (2.0 * kStep);
    return;
  }
  Vector3 turning = Vector3::Zero();     // Of axis i, by itself and those before it.
  Vector3 tip = J.topRows<3>() * rates;  // Velocity of the tip by the joints behind i.
  for (int i = 0; i < n; ++i) {
    const Vector3 v = J.col(i).head<3>();
    const Vector3 w = J.col(i).tail<3>();
    turning += rates[i] * w;
    tip -= rates[i] * v;
    J_rate.col(i) << turning.cross(v) + w.cross(tip), turning.cross(w);
  }
}

}  // namespace screwline
