#ifndef SCREWLINE_SRC_SYMBOLIC_NUMERIC_CHECK_H
#define SCREWLINE_SRC_SYMBOLIC_NUMERIC_CHECK_H

#include <algorithm>
#include <functional>
#include <vector>

#include "../kinematics/sampling.h"
#include "screwline/symbolic/formula.h"

namespace screwline {

/// Compares formulas with numbers at a fixed sequence of configurations.
class NumericCheck {
 public:
  NumericCheck(const SerialChain& chain, const SymbolTable& symbols, int configurations)
      : chain_(chain), symbols_(symbols), configurations_(configurations) {}

  /// Largest difference of entries over the largest magnitude of `reference` (at least `least`); kept if the worst so
  /// far. A difference that is not a number counts as infinite.
  double compare(const FormulaMatrix& formulas, const std::function<MatrixX(const VectorX&)>& reference,
                 double least = 1.0) {
    double worst = 0.0;
    for (int k = 0; k < configurations_; ++k) {
      const VectorX q = sampleConfiguration(chain_, k);
      const MatrixX expected = reference(q);
      const MatrixX difference = formulas.evaluate(symbols_.valuesAt(q)) - expected;
      const double share = difference.cwiseAbs().maxCoeff() / std::max(least, expected.cwiseAbs().maxCoeff());
      worst = share <= std::numeric_limits<double>::max() ? std::max(worst, share)
                                                          : std::numeric_limits<double>::infinity();
    }
    worst_ = std::max(worst_, worst);
    return worst;
  }
  double worst() const { return worst_; }

 private:
  const SerialChain& chain_;
  const SymbolTable& symbols_;
  int configurations_;
  double worst_ = 0.0;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_NUMERIC_CHECK_H
