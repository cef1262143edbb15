#include "inverse_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "inverse_names.h"
#include "screwline/model/structure.h"

namespace screwline {

TrigMatrix times(const TrigPose& X, const TrigMatrix& point) {
  return X.R * point + X.p;
}

/// The chain's table without rates and wrench, with the target and the results instead.
ExactTable InverseBuilder::tableOf(const SerialChain& chain, const SymbolicOptions& options) {
  ExactTable table = exactTableOf(chain, options);
  SymbolTable symbols;
  for (int id = 0; id < table.symbols.size() && table.symbols[id].kind != SymbolKind::kRate; ++id)
    symbols.add(table.symbols[id]);
  for (const char* name : {"px", "py", "pz"}) symbols.add(inputSymbol(name));
  for (const char* row : {"1", "2", "3"}) {
    for (const char* column : {"1", "2", "3"}) symbols.add(inputSymbol(std::string("r") + row + column));
  }
  table.angle_groups.push_back({symbols.add(inputSymbol("phi"))});
  for (const char* name : kInverseResults) symbols.add(inputSymbol(name));
  table.symbols = symbols;
  return table;
}

InverseBuilder::InverseBuilder(const SerialChain& chain, const InverseOutline& outline, const SymbolicOptions& options,
                               const Progress& progress)
    : chain_(chain),
      exact_(tableOf(chain, options), chain, progress),
      steps_(exact_.steps),
      base_(exact_.base),
      target_(identity()) {
  const int first = exact_.table.symbols.size() - static_cast<int>(kInverseResults.size()) - 13;
  for (int i = 0; i < 12; ++i) inputs_[static_cast<std::size_t>(i)] = first + i;
  heading_ = first + 12;
  for (int i = 0; i < 12; ++i) (i < 3 ? target_.p(i, 0) : target_.R((i - 3) / 3, i % 3)) = symbol(first + i);
  for (int i = 0; i < exact_.size; ++i) {
    const Axis& line = chain.axes()[static_cast<std::size_t>(i)];
    axes_.push_back({i, i + 1, identity(), i, line.prismatic, 1, line});
  }
  open_joint_ = outline.open_joint;
  if (outline.given >= 0) leaveOutGiven(outline.given);
  if (outline.tool_turn >= 0) addToolTurn(outline.tool_turn);
}

/// What is left ends with, or begins with, a frame that the given joint's own axis moves: see takeOff().
void InverseBuilder::leaveOutGiven(int given) {
  given_ = given;
  axes_.erase(axes_.begin() + given);
  if (given == 0) {
    first_ = 1;
    base_ = identity();
    steps_.erase(steps_.begin());
  } else {
    steps_.pop_back();
    steps_.back() = identity();
  }
  for (int i = 0; i < size(); ++i) {
    axes_[static_cast<std::size_t>(i)].place = i;
    axes_[static_cast<std::size_t>(i)].frame = i + 1;
  }
}

/// One axis more, through the tip along an axis of it; its angle is the symbol phi.
void InverseBuilder::addToolTurn(int tool_axis) {
  TrigPose turned = identity();
  turned.R = TrigMatrix(ring(), 3, 3);
  for (int i = 0; i < 3; ++i) turned.R((tool_axis + 1 + i) % 3, i) = number(1);
  TrigPose turn = identity();
  turn.R = rotationAboutZ({{{heading_, 1}}, 0});
  steps_.back() = steps_.back() * turned * turn;
  steps_.push_back(turned.inverse());
  Axis line;
  line.direction = chain_.home().R.col(tool_axis);
  line.point = chain_.home().p;
  axes_.push_back({size(), size() + 1, identity(), heading_, false, 1, line});
}

std::string InverseBuilder::marksOf(const InverseAxis& axis) const {
  return std::string("0, 1 and 2 mark the parts without and with the factors ") +
         (axis.slides ? "d and d^2" : "cos and sin") + " of " + namesOf({axis.place}) +
         "; short parts are put in at once";
}

void InverseBuilder::takeOff(bool tool) {
  const auto isTurnedBySymbols = [this](const TrigMatrix& R) {
    for (int i = 0; i < 9; ++i) {
      if (!R(i / 3, i % 3).symbols().empty()) return true;
    }
    return false;
  };
  const bool by_symbols = isTurnedBySymbols(exact_.base.R) || (tool && isTurnedBySymbols(exact_.tool.R));
  if (given_ < 0 && !by_symbols) return;
  const TrigPose before = given_ == 0 ? exact_.steps.front() : exact_.base;
  TrigPose X = before.inverse() * target_;
  if (tool) {
    const TrigPose& last = exact_.steps[exact_.steps.size() - 2];
    X = X * exact_.tool.inverse();
    if (given_ > 0) X = X * last.inverse();
    steps_.back() = identity();
  }
  say(given_ < 0 ? "The last frame, seen from the first (base and tool taken off):"
                 : "With " + exact_.table.symbols[given_].brief +
                       " given, where the others have to bring the last frame that they move, seen from the first:");
  const char* names[3] = {"qx", "qy", "qz"};
  for (int i = 0; i < 3; ++i) X.p(i, 0) = named(names[i], X.p(i, 0));
  X.R = namedEntries("t", X.R);
  target_ = X;
  steps_.front() = base_.inverse() * steps_.front();
  base_ = identity();
}

InverseAxis InverseBuilder::axis(int place, int sense) const {
  InverseAxis axis = axes_[static_cast<std::size_t>(place)];
  axis.sense = sense;
  return axis;
}

InverseAxis InverseBuilder::openRow(int row, int number) const {
  TrigPose Z = identity();
  Z.R = TrigMatrix(ring(), 3, 3);
  for (int i = 0; i < 3; ++i) Z.R((row + 1 + i) % 3, i) = this->number(1);
  Axis line;
  line.prismatic = true;
  line.direction = Vector3::Unit(row);
  const int symbol = heading_ + static_cast<int>(kInverseResults.size()) - 2 + number;
  return {-1, 0, Z, symbol, true, 1, line};
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
  if (i == size()) return X;
  const InverseAxis& axis = axes_[static_cast<std::size_t>(i)];
  const auto atZero = [&](TrigPolynomial& entry) {
    if (!entry.dependsOn(axis.symbol)) return;
    entry = axis.slides ? entry.atScalar(axis.symbol, TrigPolynomial(ring())) : entry.atAngle(axis.symbol, 0);
  };
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) atZero(X.R(row, column));
    atZero(X.p(row, 0));
  }
  return X;
}

TrigPose InverseBuilder::between(int from, int to) const {
  if (from > to) return between(to, from).inverse();
  TrigPose X = identity();
  for (int i = from; i < to; ++i) X = X * constantStep(i);
  return X;
}

TrigPose InverseBuilder::relative(const InverseAxis& from, const InverseAxis& to) const {
  return from.local.inverse() * between(from.frame, to.frame) * to.local;
}

TrigMatrix InverseBuilder::seenFrom(const InverseAxis& axis, const InversePoint& point) const {
  return times(axis.local.inverse() * between(axis.frame, point.frame), point.p);
}

TrigPolynomial InverseBuilder::offsetAlong(int place) const {
  return exact_.length(exact_.table.rows[static_cast<std::size_t>(place + first_)].d);
}

ExactAngle InverseBuilder::offsetAbout(int place) const {
  const int joint = place + first_;
  ExactAngle angle = exact_.table.rows[static_cast<std::size_t>(joint)].theta;
  const auto own = [joint](const std::pair<int, int>& share) { return share.first == joint; };
  angle.symbols.erase(std::remove_if(angle.symbols.begin(), angle.symbols.end(), own), angle.symbols.end());
  return angle;
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

std::string InverseBuilder::suffix(const InverseAxis& axis) const {
  return axis.symbol < exact_.joints ? std::to_string(axis.symbol + 1) : exact_.table.symbols[axis.symbol].brief;
}

std::string InverseBuilder::namesOf(const std::vector<int>& places) const {
  if (places.front() < 0) return "the open row";
  std::vector<int> numbers;
  for (const int place : places) numbers.push_back(axes_[static_cast<std::size_t>(place)].symbol + 1);
  std::sort(numbers.begin(), numbers.end());
  const bool tool_turns = numbers.back() > exact_.joints;
  if (tool_turns) numbers.pop_back();
  if (numbers.size() == 3) return "joints " + std::to_string(numbers[0]) + " to " + std::to_string(numbers[2]);
  std::string names = std::string(numbers.size() == 1 ? "joint " : "joints ") + std::to_string(numbers[0]);
  if (numbers.size() == 2) names += (tool_turns ? ", " : " and ") + std::to_string(numbers[1]);
  return tool_turns ? names + " and the tool's turn" : names;
}

}  // namespace screwline
