#ifndef SCREWLINE_SRC_TRAJECTORY_JACOBIAN_RATE_H
#define SCREWLINE_SRC_TRAJECTORY_JACOBIAN_RATE_H

#include "screwline/model/serial_chain.h"

namespace screwline {

/// Derivative of the geometric Jacobian J (at q) along joint rates, 6 x n: of column i, the axes before it turn it and
/// the axes behind it move the tip. Chains with mimic joints: by central differences, to 1e-9 of the rates.
/// @pre J is geometricJacobian()'s at q; J_rate has its size.
void jacobianRate(const SerialChain& chain, const VectorX& q, const VectorX& rates, const Matrix6X& J,
                  Matrix6X& J_rate);

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_JACOBIAN_RATE_H
