#ifndef SCREWLINE_SRC_KINEMATICS_FACTOR_FIT_H
#define SCREWLINE_SRC_KINEMATICS_FACTOR_FIT_H

#include <functional>
#include <vector>

#include "screwline/kinematics/singularity_factors.h"

namespace screwline {

using JointFunction = std::function<double(const VectorX&)>;

/// f as a sum of terms in `joints`, the others held at `base`: trigonometric of first or second degree in each revolute
/// joint, polynomial of first or second degree in each slide. Terms are checked at points that the fit has not seen;
/// none: f is not such a sum, or too long a one to be read.
std::vector<FactorTerm> fitTerms(const JointFunction& f, const SerialChain& chain, const VectorX& base,
                                 const std::vector<int>& joints);

/// Value of terms over the given joints.
double valueOf(const std::vector<FactorTerm>& terms, const std::vector<int>& joints, const ConstVectorRef& q);

}  // namespace screwline

#endif  // SCREWLINE_SRC_KINEMATICS_FACTOR_FIT_H
