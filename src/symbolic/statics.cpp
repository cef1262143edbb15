#include "screwline/symbolic/statics.h"

#include <limits>
#include <string>
#include <utility>

#include "exact_chain.h"
#include "screwline/kinematics/jacobian.h"
#include "sections.h"

namespace screwline {
namespace {

std::string frameWords(FrameNumber frame, int size) {
  if (frame == 0) return "the base";
  return frame == size + 1 ? "the tip" : "frame " + std::to_string(frame);
}

}  // namespace

StaticsFormula staticsOf(const SymbolicChain& chain) {
  const SymbolTable& symbols = chain.symbols();
  const int first = symbols.find("fx").value_or(0);
  StaticsFormula best;
  std::size_t shortest = std::numeric_limits<std::size_t>::max();
  for (FrameNumber frame = 0; frame <= chain.size() + 1; ++frame) {
    const FormulaMatrix J = chain.jacobian(frame);
    StaticsFormula statics{frame, {}};
    std::size_t length = 0;
    for (int joint = 0; joint < J.columns; ++joint) {
      std::vector<Formula> terms;
      for (int row = 0; row < J.rows; ++row) terms.push_back(J(row, joint) * Formula::symbol(first + row));
      statics.efforts.push_back(Formula::sum(terms));
      length += write(statics.efforts.back(), symbols, FormulaStyle::kText).size();
    }
    if (length >= shortest) continue;
    shortest = length;
    best = std::move(statics);
  }
  return best;
}

void writeStatics(const SectionDraft& draft) {
  DocumentWriter& document = draft.document;
  const SymbolicChain& symbolic = draft.symbolic;
  const StaticsFormula statics = staticsOf(symbolic);
  document.heading(2, "Statics");
  document.paragraph(document.symbol("tau = J^T F", "\\tau = J^{T} F") +
                     document.text(": the efforts (N m, N) that hold the arm while its tip exerts the force f and the "
                                   "moment n on the environment, about the tip's origin, in the axes of " +
                                   frameWords(statics.frame, symbolic.size()) +
                                   ". For a wrench of the environment on the tip they have the opposite sign."));
  for (std::size_t i = 0; i < statics.efforts.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    document.equation("tau_" + number, "\\tau_{" + number + "}", statics.efforts[i]);
  }
  // A wrench of no special kind, turned into the base's axes by the derived rotation, which has a check of its own.
  Vector6 wrench;
  wrench << 1.1, -0.7, 0.4, 0.3, -0.2, 0.5;
  const SymbolTable& symbols = symbolic.symbols();
  const int first = symbols.find("fx").value_or(0);
  const FormulaMatrix rotation = symbolic.pose(0, statics.frame).R;
  FormulaMatrix efforts{static_cast<int>(statics.efforts.size()), 1, statics.efforts};
  SymbolTable filled;
  std::vector<bool> given;
  for (int id = 0; id < symbols.size(); ++id) {
    Symbol symbol = symbols[id];
    given.push_back(id >= first && id < first + 6);
    if (given.back()) symbol.value = wrench[id - first];
    filled.add(std::move(symbol));
  }
  for (Formula& entry : efforts.entries) entry = entry.withValues(filled, given);
  draft.check.compare(
      efforts,
      [&](const VectorX& q) -> MatrixX {
        const Matrix3 R = rotation.evaluate(symbols.valuesAt(q));
        Vector6 in_base;
        in_base << R * wrench.head<3>(), R * wrench.tail<3>();
        Matrix6X J;
        geometricJacobian(draft.chain, q, J);
        return J.transpose() * in_base;
      },
      draft.chain.characteristicLength());
}

}  // namespace screwline
