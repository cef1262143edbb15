#ifndef SCREWLINE_SRC_IK_CONTINUUM_H
#define SCREWLINE_SRC_IK_CONTINUUM_H

#include "candidate.h"

namespace screwline {

/// @pre candidate.free is not empty. A straight continuum in closed form (see describeLine()), one of a turn that is
/// bent as SolutionCurve does. Others (a slide that is free along a bent one, more than one dimension): tangents by
/// central differences of exact members (error about 1e-9), the range by steps of two degrees or 0.02 of the chain's
/// length, its end points refined to 1e-10.
Continuum describeContinuum(const SerialChain& chain, const Candidate& candidate, const VectorX& seed,
                            bool ignore_limits);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_CONTINUUM_H
