#ifndef SCREWLINE_SRC_SYMBOLIC_EXACT_DETERMINANT_H
#define SCREWLINE_SRC_SYMBOLIC_EXACT_DETERMINANT_H

#include <vector>

#include "exact_chain.h"
#include "factoring.h"
#include "screwline/model/task.h"

namespace screwline {

/// The task's Jacobian in the axes (and, where all six rows are asked for, at the origin) of the frame where it is
/// shortest, and its largest minors in factors.
struct ExactDeterminant {
  int frame = 0;
  int point = 0;  ///< The frame whose origin the velocity is of.
  TrigMatrix jacobian;
  std::vector<FactoredPolynomial> minors;  ///< A minor that is zero has the coefficient 0 and no factors.

  bool isSquare() const { return jacobian.rows() == jacobian.columns(); }
};

/// Kept by the chain for later calls.
const ExactDeterminant& exactDeterminant(const ExactChain& chain, const Task& task);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_EXACT_DETERMINANT_H
