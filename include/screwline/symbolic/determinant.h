#ifndef SCREWLINE_SYMBOLIC_DETERMINANT_H
#define SCREWLINE_SYMBOLIC_DETERMINANT_H

#include <vector>

#include "screwline/model/task.h"
#include "screwline/symbolic/symbolic_chain.h"

namespace screwline {

struct FormulaFactor {
  Formula base;
  int multiplicity = 1;
};

/// coefficient (a number) * product of base^multiplicity: lengths, then slides, single joints, several joints.
struct FactoredFormula {
  Formula coefficient;
  std::vector<FormulaFactor> factors;

  Formula product() const;
};

/// The determinant of the task's rows: of J where that is square, else of J J^T or J^T J (whichever is smaller), which
/// is the sum of the squares of J's largest minors (Cauchy and Binet).
struct DeterminantFormula {
  bool square = true;
  FrameNumber frame = 0;                ///< In whose axes it was worked out; its value does not depend on it.
  std::vector<FactoredFormula> minors;  ///< One where square; else by the columns (or rows) kept, in binary order.

  Formula value() const;
};

/// @throws DerivationStopped
DeterminantFormula determinantOf(const SymbolicChain& chain, const Task& task);

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_DETERMINANT_H
