#ifndef SCREWLINE_SRC_SYMBOLIC_EXACT_CONDITIONS_H
#define SCREWLINE_SRC_SYMBOLIC_EXACT_CONDITIONS_H

#include <vector>

#include "exact_chain.h"
#include "screwline/kinematics/singularity_factors.h"
#include "screwline/model/task.h"

namespace screwline {

/// A factor of the task determinant that depends on the joints, exact and as numbers.
struct ExactCondition {
  TrigPolynomial base;
  SingularityFactor numeric;
};

/// In the order of conditionsOf(). @throws DerivationStopped
std::vector<ExactCondition> exactConditions(const ExactChain& exact, const SerialChain& chain, const Task& task);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_EXACT_CONDITIONS_H
