#include "screwline/symbolic/determinant.h"

#include <limits>
#include <memory>
#include <utility>

#include "exact_determinant.h"

namespace screwline {
namespace {

bool isWholeOrNone(int count) {
  return count == 0 || count == 3;
}

FactoredFormula formulaOf(const ExactChain& chain, const FactoredPolynomial& polynomial) {
  FactoredFormula result{chain.formula(polynomial.coefficient), {}};
  for (const PolynomialFactor& factor : polynomial.factors)
    result.factors.push_back({chain.formula(factor.base), factor.multiplicity});
  return result;
}

/// The task's rows of a Jacobian whose components are in `frame`, those about the tool's axes of one in the tip's.
TrigMatrix rowsOf(const ExactChain& chain, const Task& task, int frame, int point) {
  std::vector<int> rows;
  for (int i = 0; i < task.size(); ++i) rows.push_back(task.row(i));
  if (!task.usesToolAxes()) return chain.jacobian(frame, point).selected(rows);
  TrigMatrix all(chain.ring, Task::kFirstToolRow + 3, chain.joints);
  all.setBlock(0, 0, chain.jacobian(frame, point));
  all.setBlock(Task::kFirstToolRow, 0, chain.jacobian(chain.size + 1, point).selected({3, 4, 5}));
  return all.selected(rows);
}

ExactDeterminant workedOut(const ExactChain& chain, const Task& task) {
  const int tip = chain.size + 1;
  // Turning whole blocks of rows, and with all six moving the reference point, does not change the determinant.
  const bool turns =
      isWholeOrNone(task.translationCount()) && (task.usesToolAxes() || isWholeOrNone(task.rotationCount()));
  const bool moves = task.size() == 6 && chain.joints >= 6;
  ExactDeterminant result{0, tip, TrigMatrix(chain.ring, 0, 0), {}};
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  for (int frame = 0; frame <= (turns ? tip : 0); ++frame) {
    TrigMatrix J = rowsOf(chain, task, frame, moves ? frame : tip);
    const std::size_t count = J.termCount();
    if (count >= fewest) continue;
    fewest = count;
    result.frame = frame;
    result.point = moves ? frame : tip;
    result.jacobian = std::move(J);
  }
  for (const TrigPolynomial& minor : largestMinors(result.jacobian)) {
    if (minor.isZero()) {
      result.minors.push_back({TrigPolynomial(chain.ring), {}});
    } else {
      result.minors.push_back(factored(minor, chain.table.symbols));
    }
  }
  return result;
}

}  // namespace

const ExactDeterminant& exactDeterminant(const ExactChain& chain, const Task& task) {
  for (const auto& [known_task, known] : chain.determinants) {
    if (known_task == task) return *known;
  }
  chain.determinants.emplace_back(task, std::make_shared<const ExactDeterminant>(workedOut(chain, task)));
  return *chain.determinants.back().second;
}

Formula FactoredFormula::product() const {
  std::vector<Formula> parts = {coefficient};
  for (const FormulaFactor& factor : factors) parts.push_back(Formula::power(factor.base, factor.multiplicity));
  return Formula::product(parts);
}

Formula DeterminantFormula::value() const {
  if (square) return minors.front().product();
  std::vector<Formula> squares;
  for (const FactoredFormula& minor : minors) {
    if (!minor.coefficient.isZero()) squares.push_back(Formula::power(minor.product(), 2));
  }
  return Formula::sum(squares);
}

DeterminantFormula determinantOf(const SymbolicChain& chain, const Task& task) {
  const ExactDeterminant& exact = exactDeterminant(chain.exact(), task);
  DeterminantFormula result{exact.isSquare(), exact.frame, {}};
  for (const FactoredPolynomial& minor : exact.minors) result.minors.push_back(formulaOf(chain.exact(), minor));
  return result;
}

}  // namespace screwline
