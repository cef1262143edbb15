#ifndef SCREWLINE_SRC_IK_REDUNDANT_USUAL_RANK_H
#define SCREWLINE_SRC_IK_REDUNDANT_USUAL_RANK_H

#include "screwline/model/serial_chain.h"

namespace screwline {

/// Rank of the Jacobian of a chain of seven joints at regular configurations, one joint standing still or none (-1).
/// Below six, poses' solutions are surfaces, or the joint does not move along curves of them.
int usualRank(const SerialChain& chain, int still = -1);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_REDUNDANT_USUAL_RANK_H
