#ifndef SCREWLINE_SYMBOLIC_CONDITIONS_H
#define SCREWLINE_SYMBOLIC_CONDITIONS_H

#include <optional>
#include <string>
#include <vector>

#include "screwline/kinematics/singularity_factors.h"
#include "screwline/symbolic/determinant.h"

namespace screwline {

/// A joint's values at which a condition holds.
struct ConditionSolution {
  int joint = 0;
  std::vector<Formula> values;  ///< In lengths, and in other joints' values where the condition has several joints.
};

/// Where a factor of the task determinant is zero.
struct ConditionFormula {
  std::string name;                          ///< "elbow", "shoulder", "wrist", ...
  std::string meaning;                       ///< What is lost, in a line.
  Formula left_side;                         ///< Zero where the task is singular.
  std::vector<ConditionSolution> solutions;  ///< Empty where the condition has no simple solution.
};

/// The conditions of a square task, or those that all minors of another share. @throws DerivationStopped
std::vector<ConditionFormula> conditionsOf(const SymbolicChain& symbolic, const SerialChain& chain, const Task& task);

/// As factorsOf(chain, task), which fits numbers, but from the exact factors: for analyzeSingularity(). Where the task
/// is not square the factors that all minors share, and the determinant. None where exact factors tell no more: minors
/// that share none, a determinant that is always zero or one factor of more than a hundred terms. Takes milliseconds
/// for most arms, up to a second for general ones.
/// @throws DerivationStopped
std::optional<std::vector<SingularityFactor>> derivedFactorsOf(const SerialChain& chain, const Task& task,
                                                               const Progress& progress);

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_CONDITIONS_H
