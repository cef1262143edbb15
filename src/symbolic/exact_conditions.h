#ifndef SCREWLINE_SRC_SYMBOLIC_EXACT_CONDITIONS_H
#define SCREWLINE_SRC_SYMBOLIC_EXACT_CONDITIONS_H

#include <optional>
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

/// Of polynomials that depend on joints, named from the chain's geometry.
std::vector<ExactCondition> conditionsFrom(const ExactChain& exact, const SerialChain& chain,
                                           const std::vector<TrigPolynomial>& polynomials);

/// Joints that it depends on, ascending.
std::vector<int> jointsOf(const ExactChain& exact, const TrigPolynomial& polynomial);

/// A zero of f, of one joint, as steps of 15 degrees, where it is that exactly.
std::optional<int> exactSteps(const TrigPolynomial& f, int joint, double root);

/// The slide's value where f = 0, if it is a sum of lengths.
std::optional<TrigPolynomial> exactSlide(const TrigPolynomial& f, int slide);

/// In the order of conditionsOf(). @throws DerivationStopped
std::vector<ExactCondition> exactConditions(const ExactChain& exact, const SerialChain& chain, const Task& task);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_EXACT_CONDITIONS_H
