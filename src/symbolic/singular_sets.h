#ifndef SCREWLINE_SRC_SYMBOLIC_SINGULAR_SETS_H
#define SCREWLINE_SRC_SYMBOLIC_SINGULAR_SETS_H

#include <vector>

#include "exact_conditions.h"

namespace screwline {

/// Conditions that together lower the rank of a task below what any of them, or fewer, leave.
struct SingularSet {
  std::vector<ExactCondition> conditions;  ///< Two or three.
  std::vector<VectorX> points;             ///< Configurations where they hold, otherwise of no special kind.
  int rank = 0;                            ///< The largest at the points.
};

/// Where the rank of the task falls further than where one of its exactConditions(), `single`, holds, or, where it is
/// not square and no single condition is enough, where two or three together are. Of a matrix of rank r each minor of r
/// rows is a product of three: what all of them share, and one factor each for its rows and its columns. So wherever
/// conditions hold, the factors of one minor (the shortest that is not zero there) are all that can lower the rank at
/// the next step; whether they do, numbers decide. Conditions are put into the minor first: angles that are multiples
/// of 15 degrees, others by a length or slide in which the condition is linear (where_zero.h); those without one are
/// left out, and what is long is not looked at, so more may exist than is found. Deterministic. @throws
/// DerivationStopped
std::vector<SingularSet> singularSets(const ExactChain& exact, const SerialChain& chain, const Task& task,
                                      const std::vector<ExactCondition>& single);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_SINGULAR_SETS_H
