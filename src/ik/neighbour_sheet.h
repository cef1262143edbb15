#ifndef SCREWLINE_SRC_IK_NEIGHBOUR_SHEET_H
#define SCREWLINE_SRC_IK_NEIGHBOUR_SHEET_H

#include "candidate.h"

namespace screwline {

/// Makes of a candidate, a member of a continuum of that dimension, the continuum: by solutions next to solutions, on
/// which the joints that move most along it are given. Keeps a reference to the chain.
void openByNeighbours(const SerialChain& chain, const Task& task, const Pose& target, std::size_t dimension,
                      Candidate& candidate);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_NEIGHBOUR_SHEET_H
