#ifndef SCREWLINE_SRC_IK_CONTINUUM_H
#define SCREWLINE_SRC_IK_CONTINUUM_H

#include "candidate.h"

namespace screwline {

/// What is told of a continuum.
struct Continuum {
  VectorX nearest;     ///< Its member nearest to the seed; within limits, where they are honoured and any member is.
  MatrixX directions;  ///< k x n, orthonormal rows: tangents at `nearest`.
  std::vector<int> free_joints;  ///< That move along it.
  VectorX lower;  ///< Range of each of them, moving from `nearest` one parameter at a time until a limit is met.
  VectorX upper;
};

/// @pre candidate.free is not empty. Tangents by central differences of exact members (error about 1e-9), the range by
/// steps of two degrees with the end points refined to 1e-10.
Continuum describeContinuum(const SerialChain& chain, const Candidate& candidate, const VectorX& seed,
                            bool ignore_limits);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_CONTINUUM_H
