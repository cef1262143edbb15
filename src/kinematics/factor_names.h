#ifndef SCREWLINE_SRC_KINEMATICS_FACTOR_NAMES_H
#define SCREWLINE_SRC_KINEMATICS_FACTOR_NAMES_H

#include <string>
#include <vector>

#include "screwline/kinematics/singularity_factors.h"

namespace screwline {

/// Names explicit factors from what the chain's axes share, scales them (the shoulder's to a length, others to a
/// largest coefficient of 1) and writes expression, latex and meaning.
void nameFactors(const SerialChain& chain, std::vector<SingularityFactor>& factors);

/// "0.7*cos(theta2) + 0.5*cos(theta2 + theta3)", and the same in LaTeX.
std::string infixOf(const SerialChain& chain, const SingularityFactor& factor);
std::string latexOf(const SerialChain& chain, const SingularityFactor& factor);

}  // namespace screwline

#endif  // SCREWLINE_SRC_KINEMATICS_FACTOR_NAMES_H
