#ifndef SCREWLINE_SRC_KINEMATICS_JACOBIAN_METHODS_H
#define SCREWLINE_SRC_KINEMATICS_JACOBIAN_METHODS_H

#include "screwline/kinematics/jacobian.h"

namespace screwline {

/// The methods behind jacobian(); each in its own file, none calls another. All: 6 x n, base frame, tip origin;
/// allocate.
Matrix6X differentiationJacobian(const SerialChain& chain, const ConstVectorRef& q);
Matrix6X velocityPropagationJacobian(const SerialChain& chain, const ConstVectorRef& q);
Matrix6X forcePropagationJacobian(const SerialChain& chain, const ConstVectorRef& q);
Matrix6X numericalJacobian(const SerialChain& chain, const ConstVectorRef& q);

}  // namespace screwline

#endif  // SCREWLINE_SRC_KINEMATICS_JACOBIAN_METHODS_H
