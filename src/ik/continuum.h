#ifndef SCREWLINE_SRC_IK_CONTINUUM_H
#define SCREWLINE_SRC_IK_CONTINUUM_H

#include "candidate.h"

namespace screwline {

/// @pre candidate.free is not empty. Tangents by central differences of exact members (error about 1e-9), the range by
/// steps of two degrees with the end points refined to 1e-10.
Continuum describeContinuum(const SerialChain& chain, const Candidate& candidate, const VectorX& seed,
                            bool ignore_limits);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_CONTINUUM_H
