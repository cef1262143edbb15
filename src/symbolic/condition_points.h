#ifndef SCREWLINE_SRC_SYMBOLIC_CONDITION_POINTS_H
#define SCREWLINE_SRC_SYMBOLIC_CONDITION_POINTS_H

#include <vector>

#include "screwline/kinematics/singularity_factors.h"
#include "screwline/model/serial_chain.h"

namespace screwline {

/// Configurations at which all of the factors are zero, otherwise of no special kind: at each combination of the zeros
/// of those that depend on one joint, `starts` times with other values for the joints that are left free. Factors of
/// several joints are met by Newton's method. Empty where they have no common zero, or none is found. Deterministic.
/// @pre the factors are explicit.
std::vector<VectorX> commonZeros(const SerialChain& chain, const std::vector<const SingularityFactor*>& factors,
                                 int starts);

/// Rank of a task Jacobian at a configuration that is met to about 1e-13: what is below 1e-7 of its largest singular
/// value, or within the rounding of the whole Jacobian, does not count.
int rankAt(const SerialChain& chain, const Task& task, const VectorX& q);

/// The ranks at the configurations, ascending, each once.
std::vector<int> ranksAt(const SerialChain& chain, const Task& task, const std::vector<VectorX>& configurations);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_CONDITION_POINTS_H
