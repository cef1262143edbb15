#include "inverse_builder.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "screwline/model/structure.h"

namespace screwline {
namespace {

/// What polynomials may have in them besides the target and the joints: a point, distances, entries of a rotation, a
/// direction, a place in a plane, open rows.
constexpr std::array<const char*, 29> kResults = {"wx",  "wy",  "wz",  "f",   "u",   "v",   "m11", "m12", "m13", "m21",
                                                  "m22", "m23", "m31", "m32", "m33", "t11", "t12", "t13", "t21", "t22",
                                                  "t23", "t31", "t32", "t33", "hx",  "hy",  "hz",  "o1",  "o2"};

Symbol input(const std::string& name) {
  Symbol symbol;
  symbol.name = name;
  symbol.brief = name;
  const std::size_t letters = name.size() > 1 && name != "phi" ? 1 : name.size();
  symbol.latex = letters < name.size() ? name.substr(0, 1) + "_{" + name.substr(1) + "}" : latexOfName(name);
  return symbol;
}

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
}

}  // namespace

TrigMatrix times(const TrigPose& X, const TrigMatrix& point) {
  return X.R * point + X.p;
}

/// The chain's table without rates and wrench, with the target and the results instead.
ExactTable InverseBuilder::tableOf(const SerialChain& chain, const SymbolicOptions& options) {
  ExactTable table = exactTableOf(chain, options);
  SymbolTable symbols;
  for (int id = 0; id < table.symbols.size() && table.symbols[id].kind != SymbolKind::kRate; ++id)
    symbols.add(table.symbols[id]);
  for (const char* name : {"px", "py", "pz"}) symbols.add(input(name));
  for (const char* row : {"1", "2", "3"}) {
    for (const char* column : {"1", "2", "3"}) symbols.add(input(std::string("r") + row + column));
  }
  table.angle_groups.push_back({symbols.add(input("phi"))});
  for (const char* name : kResults) symbols.add(input(name));
  table.symbols = symbols;
  return table;
}

InverseBuilder::InverseBuilder(const SerialChain& chain, const SymbolicOptions& options, const Progress& progress)
    : chain_(chain), exact_(tableOf(chain, options), chain, progress) {
  const SymbolTable& symbols = exact_.table.symbols;
  const int first = symbols.size() - static_cast<int>(kResults.size()) - 13;
  for (int i = 0; i < 12; ++i) target_[static_cast<std::size_t>(i)] = first + i;
  heading_ = first + 12;
}

InverseAxis InverseBuilder::axis(int joint, int sense) const {
  const Axis& line = chain_.axes()[static_cast<std::size_t>(joint)];
  return {zeroFrame(joint + 1), joint, joint, line.prismatic, sense, line};
}

InverseAxis InverseBuilder::openRow(int row, int number) const {
  TrigPose Z = identity();
  Z.R = TrigMatrix(ring(), 3, 3);
  for (int i = 0; i < 3; ++i) Z.R((row + 1 + i) % 3, i) = this->number(1);
  Axis line;
  line.prismatic = true;
  line.direction = Vector3::Unit(row);
  const int symbol = heading_ + static_cast<int>(kResults.size()) - 2 + number;
  return {Z, -1, symbol, true, 1, line};
}

TrigPose InverseBuilder::identity() const {
  return {TrigMatrix::identity(ring(), 3), TrigMatrix(ring(), 3, 1)};
}

TrigPose InverseBuilder::motion(const InverseAxis& axis) const {
  TrigPose J = identity();
  if (axis.slides) {
    J.p(2, 0) = symbol(axis.symbol).scaled(axis.sense);
  } else {
    J.R = rotationAboutZ({{{axis.symbol, axis.sense}}, 0});
  }
  return J;
}

TrigMatrix InverseBuilder::rotationAboutZ(const ExactAngle& angle) const {
  TrigMatrix R = TrigMatrix::identity(ring(), 3);
  const TrigPolynomial c = TrigPolynomial::cosine(ring(), angle.symbols, angle.steps);
  const TrigPolynomial s = TrigPolynomial::sine(ring(), angle.symbols, angle.steps);
  R(0, 0) = c;
  R(1, 1) = c;
  R(0, 1) = -s;
  R(1, 0) = s;
  return R;
}

TrigPose InverseBuilder::shiftAlongZ(const TrigPolynomial& length) const {
  TrigPose X = identity();
  X.p(2, 0) = length;
  return X;
}

TrigPose InverseBuilder::constantStep(int i) const {
  TrigPose X = step(i);
  if (i == exact_.size) return X;
  const auto atZero = [&](TrigPolynomial& entry) {
    if (!entry.dependsOn(i)) return;
    const bool slides = exact_.prismatic[static_cast<std::size_t>(i)];
    entry = slides ? entry.atScalar(i, TrigPolynomial(ring())) : entry.atAngle(i, 0);
  };
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) atZero(X.R(row, column));
    atZero(X.p(row, 0));
  }
  return X;
}

TrigPose InverseBuilder::zeroFrame(int frame) const {
  TrigPose X = identity();
  for (int i = 0; i < frame; ++i) X = X * constantStep(i);
  return X;
}

TrigPolynomial InverseBuilder::offsetAlong(int joint) const {
  return exact_.length(exact_.table.rows[static_cast<std::size_t>(joint)].d);
}

ExactAngle InverseBuilder::offsetAbout(int joint) const {
  ExactAngle angle = exact_.table.rows[static_cast<std::size_t>(joint)].theta;
  const auto own = [joint](const std::pair<int, int>& share) { return share.first == joint; };
  angle.symbols.erase(std::remove_if(angle.symbols.begin(), angle.symbols.end(), own), angle.symbols.end());
  return angle;
}

TrigMatrix InverseBuilder::targetPoint() const {
  TrigMatrix p(ring(), 3, 1);
  for (int i = 0; i < 3; ++i) p(i, 0) = symbol(target_[static_cast<std::size_t>(i)]);
  return p;
}

TrigMatrix InverseBuilder::targetRotation() const {
  TrigMatrix R(ring(), 3, 3);
  for (int i = 0; i < 9; ++i) R(i / 3, i % 3) = symbol(target_[static_cast<std::size_t>(i) + 3]);
  return R;
}

bool InverseBuilder::isConstant(const TrigPolynomial& polynomial) const {
  const std::vector<int> symbols = polynomial.symbols();
  return std::all_of(symbols.begin(), symbols.end(), [this](int id) {
    const SymbolKind kind = exact_.table.symbols[id].kind;
    return kind == SymbolKind::kLength || kind == SymbolKind::kConstantAngle;
  });
}

double InverseBuilder::valueOf(const TrigPolynomial& constant) const {
  std::vector<double> values;
  for (int id = 0; id < exact_.table.symbols.size(); ++id) values.push_back(exact_.table.symbols[id].value);
  return constant.evaluate(values);
}

/// Lengths that the solver's plan takes as zero, too.
bool InverseBuilder::isZero(const TrigPolynomial& polynomial) const {
  if (polynomial.isZero()) return true;
  const double bound = kStructureLengthTolerance * std::min(1.0, chain_.characteristicLength());
  return isConstant(polynomial) && std::abs(valueOf(polynomial)) <= bound * bound;
}

int InverseBuilder::addSymbol(const std::string& name) {
  return exact_.table.symbols.add(input(name));
}

void InverseBuilder::addStep(InverseStep step) {
  step.before = std::exchange(before_, "");
  steps_.push_back(std::move(step));
}

TrigPolynomial InverseBuilder::named(const std::string& name, const TrigPolynomial& polynomial) {
  if (polynomial.terms().size() <= 1 || isConstant(polynomial)) return polynomial;
  const auto place = std::find(kResults.begin(), kResults.end(), name) - kResults.begin();
  InverseStep step;
  step.symbol = heading_ + 1 + static_cast<int>(place);
  step.value = formula(polynomial);
  addStep(step);
  return symbol(step.symbol);
}

TrigPolynomial InverseBuilder::root(const std::string& name, const TrigPolynomial& radicand) {
  const auto place = std::find(kResults.begin(), kResults.end(), name) - kResults.begin();
  const int id = heading_ + 1 + static_cast<int>(place);
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

std::string InverseBuilder::suffix(const InverseAxis& axis) const {
  return axis.joint < 0 ? exact_.table.symbols[axis.symbol].brief : std::to_string(axis.joint + 1);
}

/// Backwards from the joints: what is needed, and what that needs.
InverseFormulas InverseBuilder::finished() {
  std::set<int> needed;
  for (int i = 0; i < exact_.joints; ++i) needed.insert(i);
  std::vector<InverseStep> kept;
  for (std::size_t i = steps_.size(); i > 0; --i) {
    const InverseStep& step = steps_[i - 1];
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
  result.target = target_;
  result.steps = std::move(kept);
  for (bool slides : exact_.prismatic) result.revolute.push_back(!slides);
  result.length = chain_.characteristicLength();
  return result;
}

}  // namespace screwline
