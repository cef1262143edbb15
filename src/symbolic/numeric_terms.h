#ifndef SCREWLINE_SRC_SYMBOLIC_NUMERIC_TERMS_H
#define SCREWLINE_SRC_SYMBOLIC_NUMERIC_TERMS_H

#include <vector>

#include "exact_chain.h"
#include "screwline/kinematics/singularity_factors.h"

namespace screwline {

/// The polynomial with the chain's lengths as numbers: sines and cosines of sums of joint angles, powers of slides.
std::vector<FactorTerm> numericTerms(const ExactChain& exact, const TrigPolynomial& polynomial,
                                     const std::vector<int>& joints);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_NUMERIC_TERMS_H
