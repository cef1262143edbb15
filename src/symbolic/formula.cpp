#include "screwline/symbolic/formula.h"

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "rational.h"

namespace screwline {
namespace {

/// Numbers of a sum or product, folded: exact as long as all are and they fit.
class FoldedNumber {
 public:
  explicit FoldedNumber(bool product) : product_(product), exact_(product ? 1 : 0), decimal_(product ? 1.0 : 0.0) {}

  void take(const Formula& number) {
    const bool is_exact = number.kind() == Formula::Kind::kNumber;
    const double value = is_exact ? static_cast<double>(number.numerator()) / static_cast<double>(number.denominator())
                                  : number.decimalValue();
    decimal_ = product_ ? decimal_ * value : decimal_ + value;
    if (!is_exact) is_exact_ = false;
    if (!is_exact_) return;
    const Rational next(number.numerator(), number.denominator());
    exact_ = product_ ? exact_ * next : exact_ + next;
  }
  bool isNeutral() const { return is_exact_ && exact_ == Rational(product_ ? 1 : 0); }
  bool isZero() const { return is_exact_ ? exact_.isZero() : decimal_ == 0.0; }
  Formula formula() const {
    return is_exact_ ? Formula::number(exact_.numerator(), exact_.denominator()) : Formula::decimal(decimal_);
  }

 private:
  bool product_;
  bool is_exact_ = true;
  Rational exact_;
  double decimal_;
};

bool isNumeric(const Formula& formula) {
  return formula.kind() == Formula::Kind::kNumber || formula.kind() == Formula::Kind::kDecimal;
}

double valueOf(FormulaFunction function, double first, double second) {
  switch (function) {
    case FormulaFunction::kSine:
      return std::sin(first);
    case FormulaFunction::kCosine:
      return std::cos(first);
    case FormulaFunction::kSquareRoot:
      return std::sqrt(first);
    case FormulaFunction::kArcTangent2:
      return std::atan2(first, second);
    case FormulaFunction::kArcCosine:
      return std::acos(first);
    case FormulaFunction::kArcSine:
      break;
  }
  return std::asin(first);
}

}  // namespace

Formula Formula::number(std::int64_t numerator, std::int64_t denominator) {
  const Rational value(numerator, denominator);
  Node node;
  node.numerator = value.numerator();
  node.denominator = value.denominator();
  return Formula(std::move(node));
}

Formula Formula::decimal(double value) {
  Node node;
  node.kind = Kind::kDecimal;
  node.decimal = value;
  return Formula(std::move(node));
}

Formula Formula::pi() {
  return symbol(kPiSymbol);
}

Formula Formula::symbol(int id) {
  Node node;
  node.kind = Kind::kSymbol;
  node.symbol = id;
  return Formula(std::move(node));
}

Formula Formula::composite(Kind kind, std::vector<Formula> parts) {
  Node node;
  node.kind = kind;
  node.parts = std::move(parts);
  return Formula(std::move(node));
}

Formula Formula::sum(const std::vector<Formula>& terms) {
  std::vector<Formula> parts;
  FoldedNumber constant(false);
  const auto take = [&](const Formula& term) {
    if (isNumeric(term)) {
      constant.take(term);
    } else {
      parts.push_back(term);
    }
  };
  for (const Formula& term : terms) {
    if (term.kind() != Kind::kSum) {
      take(term);
      continue;
    }
    for (const Formula& inner : term.parts()) take(inner);
  }
  if (!constant.isNeutral()) parts.push_back(constant.formula());
  if (parts.empty()) return number(0);
  return parts.size() == 1 ? parts.front() : composite(Kind::kSum, std::move(parts));
}

Formula Formula::product(const std::vector<Formula>& factors) {
  std::vector<Formula> parts;
  FoldedNumber coefficient(true);
  const auto take = [&](const Formula& factor) {
    if (isNumeric(factor)) {
      coefficient.take(factor);
    } else {
      parts.push_back(factor);
    }
  };
  for (const Formula& factor : factors) {
    if (factor.kind() != Kind::kProduct) {
      take(factor);
      continue;
    }
    for (const Formula& inner : factor.parts()) take(inner);
  }
  if (coefficient.isZero()) return number(0);
  if (!coefficient.isNeutral() || parts.empty()) parts.insert(parts.begin(), coefficient.formula());
  return parts.size() == 1 ? parts.front() : composite(Kind::kProduct, std::move(parts));
}

Formula Formula::power(const Formula& base, int exponent) {
  if (exponent == 0) return number(1);
  if (exponent == 1) return base;
  if (base.isNumber(1)) return base;
  if (base.kind() == Kind::kDecimal) return decimal(std::pow(base.decimalValue(), exponent));
  if (base.kind() == Kind::kNumber && exponent > 0) {
    return product(std::vector<Formula>(static_cast<std::size_t>(exponent), base));
  }
  Node node;
  node.kind = Kind::kPower;
  node.numerator = exponent;
  node.parts = {base};
  return Formula(std::move(node));
}

Formula Formula::call(FormulaFunction function, std::vector<Formula> arguments) {
  Node node;
  node.kind = Kind::kCall;
  node.function = function;
  node.parts = std::move(arguments);
  return Formula(std::move(node));
}

bool Formula::isNumber(std::int64_t value) const {
  return kind() == Kind::kNumber && numerator() == value && denominator() == 1;
}

double Formula::evaluate(const std::vector<double>& values) const {
  const std::vector<Formula>& p = parts();
  switch (kind()) {
    case Kind::kNumber:
      return static_cast<double>(numerator()) / static_cast<double>(denominator());
    case Kind::kDecimal:
      return decimalValue();
    case Kind::kSymbol:
      return symbolId() == kPiSymbol ? kPi : values[static_cast<std::size_t>(symbolId())];
    case Kind::kSum:
      return std::accumulate(p.begin(), p.end(), 0.0,
                             [&](double sum, const Formula& term) { return sum + term.evaluate(values); });
    case Kind::kProduct:
      return std::accumulate(p.begin(), p.end(), 1.0,
                             [&](double product, const Formula& factor) { return product * factor.evaluate(values); });
    case Kind::kPower:
      return std::pow(p.front().evaluate(values), static_cast<double>(numerator()));
    case Kind::kCall:
      break;
  }
  return valueOf(function(), p.front().evaluate(values), p.back().evaluate(values));
}

Formula Formula::withValues(const SymbolTable& symbols, const std::vector<bool>& replaced) const {
  if (kind() == Kind::kSymbol) {
    const bool swap = symbolId() >= 0 && replaced[static_cast<std::size_t>(symbolId())];
    return swap ? decimal(symbols[symbolId()].value) : *this;
  }
  if (parts().empty()) return *this;
  std::vector<Formula> changed;
  for (const Formula& part : parts()) changed.push_back(part.withValues(symbols, replaced));
  if (kind() == Kind::kSum) return sum(changed);
  if (kind() == Kind::kProduct) return product(changed);
  if (kind() == Kind::kPower) return power(changed.front(), static_cast<int>(numerator()));
  const Formula same = call(function(), changed);
  const bool constant = std::all_of(changed.begin(), changed.end(), isNumeric);
  return constant ? decimal(same.evaluate({})) : same;
}

Formula operator+(const Formula& a, const Formula& b) {
  return Formula::sum({a, b});
}
Formula operator-(const Formula& a) {
  return Formula::product({Formula::number(-1), a});
}
Formula operator-(const Formula& a, const Formula& b) {
  return a + (-b);
}
Formula operator*(const Formula& a, const Formula& b) {
  return Formula::product({a, b});
}
Formula operator/(const Formula& a, const Formula& b) {
  if (b.kind() == Formula::Kind::kNumber) return a * Formula::number(b.denominator(), b.numerator());
  return a * Formula::power(b, -1);
}

MatrixX FormulaMatrix::evaluate(const std::vector<double>& values) const {
  MatrixX result(rows, columns);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) result(i, j) = (*this)(i, j).evaluate(values);
  }
  return result;
}

}  // namespace screwline
