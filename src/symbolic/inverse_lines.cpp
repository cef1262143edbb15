// The lines themselves: adding them, and leaving out what nothing needs.

#include <algorithm>
#include <set>
#include <utility>

#include "inverse_builder.h"
#include "inverse_names.h"

namespace screwline {
namespace {

void collectSymbols(const Formula& formula, std::set<int>& found) {
  if (formula.kind() == Formula::Kind::kSymbol) found.insert(formula.symbolId());
  for (const Formula& part : formula.parts()) collectSymbols(part, found);
}

/// Of symbols' squares only: never negative.
bool isSumOfSquares(const Formula& formula) {
  if (formula.kind() == Formula::Kind::kNumber) return formula.numerator() >= 0;
  if (formula.kind() == Formula::Kind::kPower) return formula.numerator() % 2 == 0;
  const bool composed = formula.kind() == Formula::Kind::kSum || formula.kind() == Formula::Kind::kProduct;
  return composed && std::all_of(formula.parts().begin(), formula.parts().end(), isSumOfSquares);
}

Symbol plusOrMinus(const std::string& name, const char* brief, const char* latex) {
  Symbol symbol;
  symbol.name = name;
  symbol.brief = brief;
  symbol.latex = latex;
  return symbol;
}

void collectSymbols(const InverseStep& step, std::set<int>& found) {
  collectSymbols(step.value, found);
  collectSymbols(step.radicand, found);
  for (const Formula& formula : step.free_if) collectSymbols(formula, found);
  for (const Formula& formula : step.equation) collectSymbols(formula, found);
}

}  // namespace

int InverseBuilder::addSymbol(const std::string& name) {
  return exact_.table.symbols.add(inputSymbol(name));
}

void InverseBuilder::addStep(InverseStep step) {
  step.before = std::exchange(before_, "");
  lines_.push_back(std::move(step));
}

int InverseBuilder::resultSymbol(const std::string& name) const {
  return heading_ + 1 +
         static_cast<int>(std::find(kInverseResults.begin(), kInverseResults.end(), name) - kInverseResults.begin());
}

TrigPolynomial InverseBuilder::named(const std::string& name, const TrigPolynomial& polynomial) {
  if (polynomial.terms().size() <= 1 || isConstant(polynomial)) return polynomial;
  return named(name, formula(polynomial));
}

TrigPolynomial InverseBuilder::named(const std::string& name, const Formula& value) {
  InverseStep step;
  step.symbol = resultSymbol(name);
  step.value = value;
  addStep(step);
  return symbol(step.symbol);
}

TrigMatrix InverseBuilder::namedEntries(const std::string& letter, TrigMatrix matrix) {
  for (int i = 0; i < matrix.rows(); ++i) {
    for (int j = 0; j < matrix.columns(); ++j)
      matrix(i, j) = named(letter + std::to_string(i + 1) + std::to_string(j + 1), matrix(i, j));
  }
  return matrix;
}

TrigPolynomial InverseBuilder::root(const std::string& name, const TrigPolynomial& radicand) {
  const int id = resultSymbol(name);
  addRoot(id, inputsFirst(radicand));
  return symbol(id);
}

void InverseBuilder::addRoot(int id, const Formula& radicand) {
  const bool only_sign = radicand.isNumber(1);
  const std::string name = "sign" + std::to_string(++signs_);
  InverseStep step;
  step.symbol = id;
  step.radicand = radicand;
  step.reach = !isSumOfSquares(radicand);
  step.sign = exact_.table.symbols.add(plusOrMinus(name, only_sign ? "+-1" : "+-", only_sign ? "\\pm 1" : "\\pm"));
  const Formula sign = Formula::symbol(step.sign);
  step.value = only_sign ? sign : sign * Formula::sqrt(radicand);
  addStep(std::move(step));
}

Formula InverseBuilder::inputsFirst(const TrigPolynomial& polynomial) const {
  TrigPolynomial constant(ring());
  for (const auto& [key, coefficient] : polynomial.terms()) {
    const TrigPolynomial term = TrigPolynomial::term(ring(), key, coefficient);
    if (isConstant(term)) constant += term;
  }
  return formula(polynomial - constant) + formula(constant);
}

Formula InverseBuilder::formulaNamed(const std::string& name, const Formula& value) {
  InverseStep step;
  step.symbol = addSymbol(name);
  step.value = value;
  const Formula result = Formula::symbol(step.symbol);
  addStep(std::move(step));
  return result;
}

Formula InverseBuilder::rootNamed(const std::string& name, const Formula& radicand) {
  const int id = addSymbol(name);
  addRoot(id, radicand);
  return Formula::symbol(id);
}

void InverseBuilder::setJoint(int symbol, const Formula& value, const std::vector<Formula>& free_if) {
  InverseStep step;
  step.symbol = symbol;
  step.value = value;
  // "wz" says as much as "-wz".
  const auto isNegated = [](const Formula& formula) {
    return formula.kind() == Formula::Kind::kProduct && formula.parts().front().kind() == Formula::Kind::kNumber &&
           formula.parts().front().numerator() < 0;
  };
  for (const Formula& formula : free_if) step.free_if.push_back(isNegated(formula) ? -formula : formula);
  addStep(std::move(step));
}

/// Backwards from the joints: what is needed, and what that needs.
InverseFormulas InverseBuilder::finished() {
  std::set<int> needed;
  for (const InverseAxis& axis : axes_) {
    if (axis.symbol < exact_.joints && axis.symbol != open_joint_) needed.insert(axis.symbol);
  }
  std::vector<InverseStep> kept;
  for (std::size_t i = lines_.size(); i > 0; --i) {
    const InverseStep& step = lines_[i - 1];
    if (needed.count(step.symbol) > 0) {
      collectSymbols(step, needed);
      kept.push_back(step);
    } else if (!kept.empty() && kept.back().before.empty()) {
      kept.back().before = step.before;
    }
  }
  std::reverse(kept.begin(), kept.end());
  InverseFormulas result;
  result.symbols = exact_.table.symbols;
  result.joints = exact_.joints;
  result.target = inputs_;
  result.given = given_;
  result.open_joint = open_joint_;
  if (!axes_.empty() && axes_.back().symbol >= exact_.joints) result.tool_turn = axes_.back().symbol;
  result.steps = std::move(kept);
  for (bool slides : exact_.prismatic) result.revolute.push_back(!slides);
  result.length = chain_.characteristicLength();
  return result;
}

}  // namespace screwline
