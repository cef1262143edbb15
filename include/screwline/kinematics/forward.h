#ifndef SCREWLINE_KINEMATICS_FORWARD_H
#define SCREWLINE_KINEMATICS_FORWARD_H

#include "screwline/model/serial_chain.h"

namespace screwline {

/// X_BT(q): the tip in the base frame. No allocation. @pre q has chain.size() finite values (not checked here).
Pose forwardKinematics(const SerialChain& chain, const ConstVectorRef& q);

/// X_BL(q) of a link of the chain. No allocation. Computed by the product of exponentials, apart from
/// forwardKinematics().
Pose linkPose(const SerialChain& chain, const Link& link, const ConstVectorRef& q);

/// Forward kinematics by the product of exponentials (Lynch & Park, eq. 4.14): the second way to compute a pose. No
/// allocation.
Pose forwardByExponentials(const SerialChain& chain, const ConstVectorRef& q);

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_FORWARD_H
