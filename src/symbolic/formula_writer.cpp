#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <utility>

#include "screwline/symbolic/formula.h"

namespace screwline {
namespace {

using Kind = Formula::Kind;

enum class Binding { kSum, kProduct, kPower, kAtom };

struct Written {
  std::string text;
  Binding binding = Binding::kAtom;
};

/// The shortest text that reads back as the same number.
std::string decimalText(double value) {
  char text[40];
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

bool isNegative(const Formula& formula) {
  if (formula.kind() == Kind::kNumber) return formula.numerator() < 0;
  if (formula.kind() == Kind::kDecimal) return formula.decimalValue() < 0.0;
  return formula.kind() == Kind::kProduct && isNegative(formula.parts().front());
}

struct AngleShare {
  int symbol;
  std::int64_t times;
};

/// An angle's joints and how often each occurs; none where it is something else.
std::optional<std::vector<AngleShare>> anglesOf(const Formula& angle) {
  if (angle.kind() == Kind::kSymbol) return std::vector<AngleShare>{{angle.symbolId(), 1}};
  if (angle.kind() == Kind::kProduct && angle.parts().size() == 2) {
    const Formula number = angle.parts()[0];
    const Formula symbol = angle.parts()[1];
    if (number.kind() != Kind::kNumber || number.denominator() != 1 || symbol.kind() != Kind::kSymbol)
      return std::nullopt;
    return std::vector<AngleShare>{{symbol.symbolId(), number.numerator()}};
  }
  if (angle.kind() != Kind::kSum) return std::nullopt;
  std::vector<AngleShare> all;
  for (const Formula& term : angle.parts()) {
    const auto one = anglesOf(term);
    if (!one) return std::nullopt;
    all.insert(all.end(), one->begin(), one->end());
  }
  return all;
}

class Writer {
 public:
  Writer(const SymbolTable& symbols, FormulaStyle style) : symbols_(symbols), style_(style) {}

  Written write(const Formula& formula) const {
    switch (formula.kind()) {
      case Kind::kNumber:
        return number(formula);
      case Kind::kDecimal:
        return {decimalText(formula.decimalValue()), formula.decimalValue() < 0.0 ? Binding::kSum : Binding::kAtom};
      case Kind::kSymbol:
        return {symbolText(formula.symbolId()), Binding::kAtom};
      case Kind::kSum:
        return sum(formula);
      case Kind::kProduct:
        return product(formula.parts());
      case Kind::kPower:
        return formula.numerator() < 0 ? product({formula}) : power(formula.parts().front(), formula.numerator());
      case Kind::kCall:
        break;
    }
    return call(formula);
  }

 private:
  bool isLatex() const { return style_ == FormulaStyle::kLatex; }
  std::string times() const { return style_ == FormulaStyle::kInfix ? "*" : " "; }

  std::string symbolText(int id) const {
    if (id == Formula::kPiSymbol) return isLatex() ? "\\pi" : "pi";
    const Symbol& symbol = symbols_[id];
    if (isLatex()) return symbol.latex;
    return style_ == FormulaStyle::kText ? symbol.brief : symbol.name;
  }

  std::string enclosed(const Formula& formula, Binding needed) const {
    const Written inner = write(formula);
    if (inner.binding >= needed) return inner.text;
    return isLatex() ? "\\left(" + inner.text + "\\right)" : "(" + inner.text + ")";
  }

  Written number(const Formula& formula) const {
    const std::int64_t top = formula.numerator();
    const std::string sign = top < 0 ? "-" : "";
    const std::string size = std::to_string(std::abs(top));
    const Binding binding = top < 0 ? Binding::kSum : Binding::kAtom;
    if (formula.denominator() == 1) return {sign + size, binding};
    const std::string below = std::to_string(formula.denominator());
    if (isLatex()) return {sign + "\\frac{" + size + "}{" + below + "}", binding};
    return {sign + size + "/" + below, std::min(binding, Binding::kProduct)};
  }

  /// A number stands last, but "1 - D" is not written "-D + 1".
  Written sum(const Formula& formula) const {
    std::vector<Formula> terms = formula.parts();
    const bool turned = terms.back().kind() == Kind::kNumber && !isNegative(terms.back()) && isNegative(terms.front());
    if (turned) std::rotate(terms.begin(), terms.end() - 1, terms.end());
    std::string text;
    for (const Formula& term : terms) {
      const bool negative = isNegative(term);
      text += text.empty() ? (negative ? "-" : "") : (negative ? " - " : " + ");
      text += enclosed(negative ? -term : term, Binding::kProduct);
    }
    return {text, Binding::kSum};
  }

  Written product(const std::vector<Formula>& factors) const {
    if (isNegative(factors.front())) {
      std::vector<Formula> positive = factors;
      positive.front() = -positive.front();
      const Formula rest = Formula::product(positive);
      return {"-" + enclosed(rest, Binding::kProduct), Binding::kSum};
    }
    std::vector<Formula> above;
    std::vector<Formula> below;
    for (const Formula& factor : factors) {
      const bool inverse = factor.kind() == Kind::kPower && factor.numerator() < 0;
      (inverse ? below : above)
          .push_back(inverse ? Formula::power(factor.parts().front(), -static_cast<int>(factor.numerator())) : factor);
    }
    if (below.empty()) return {joined(above), Binding::kProduct};
    if (isLatex()) return {"\\frac{" + numeratorText(above) + "}{" + numeratorText(below) + "}", Binding::kAtom};
    const std::string bottom = below.size() == 1 ? enclosed(below.front(), Binding::kPower) : "(" + joined(below) + ")";
    return {(above.empty() ? "1" : joined(above)) + "/" + bottom, Binding::kProduct};
  }

  std::string numeratorText(const std::vector<Formula>& factors) const {
    if (factors.empty()) return "1";
    return factors.size() == 1 ? write(factors.front()).text : joined(factors);
  }

  std::string joined(const std::vector<Formula>& factors) const {
    std::string text;
    for (const Formula& factor : factors) {
      const bool leading_fraction = text.empty() && factor.kind() == Kind::kNumber;
      text += (text.empty() ? "" : times()) + enclosed(factor, leading_fraction ? Binding::kProduct : Binding::kPower);
    }
    return text;
  }

  Written power(const Formula& base, std::int64_t exponent) const {
    const std::string text = std::to_string(exponent);
    return {enclosed(base, Binding::kAtom) + (isLatex() ? "^{" + text + "}" : "^" + text), Binding::kPower};
  }

  Written call(const Formula& formula) const {
    const FormulaFunction function = formula.function();
    const bool circular = function == FormulaFunction::kSine || function == FormulaFunction::kCosine;
    if (circular && style_ != FormulaStyle::kInfix) {
      const std::string brief = briefCircular(function == FormulaFunction::kSine ? "s" : "c", formula.parts().front());
      if (!brief.empty()) return {brief, Binding::kAtom};
    }
    if (isLatex() && function == FormulaFunction::kSquareRoot)
      return {"\\sqrt{" + write(formula.parts().front()).text + "}", Binding::kAtom};
    std::string arguments;
    for (const Formula& argument : formula.parts()) arguments += (arguments.empty() ? "" : ", ") + write(argument).text;
    return {nameOf(function) + (isLatex() ? "\\left(" + arguments + "\\right)" : "(" + arguments + ")"),
            Binding::kAtom};
  }

  std::string nameOf(FormulaFunction function) const {
    switch (function) {
      case FormulaFunction::kSine:
        return isLatex() ? "\\sin" : "sin";
      case FormulaFunction::kCosine:
        return isLatex() ? "\\cos" : "cos";
      case FormulaFunction::kSquareRoot:
        return "sqrt";
      case FormulaFunction::kArcTangent2:
        return isLatex() ? "\\operatorname{atan2}" : "atan2";
      case FormulaFunction::kArcCosine:
        return isLatex() ? "\\arccos" : "acos";
      case FormulaFunction::kArcSine:
        break;
    }
    return isLatex() ? "\\arcsin" : "asin";
  }

  /// "s23" for the sine of theta2 + theta3; empty where the angle is not made of joints' values alone.
  std::string briefCircular(const std::string& letter, const Formula& angle) const {
    const auto shares = anglesOf(angle);
    if (!shares) return "";
    std::string joints;
    bool plain = true;
    for (const AngleShare& share : *shares) {
      if (share.symbol == Formula::kPiSymbol || symbols_[share.symbol].kind != SymbolKind::kAngle) return "";
      const int index = symbols_[share.symbol].index;
      if (share.times != 1 || index > 9) plain = false;
      joints += std::to_string(index);
    }
    if (!plain) joints = "(" + signedJoints(*shares) + ")";
    return isLatex() ? letter + "_{" + joints + "}" : letter + joints;
  }

  /// "2-3", "2*2+3", "10+11": joints by number where digits side by side would not tell.
  std::string signedJoints(const std::vector<AngleShare>& shares) const {
    std::string text;
    for (const AngleShare& share : shares) {
      if (share.times < 0) text += "-";
      if (share.times > 0 && !text.empty()) text += "+";
      if (std::abs(share.times) != 1) text += std::to_string(std::abs(share.times)) + (isLatex() ? "\\cdot " : "*");
      text += std::to_string(symbols_[share.symbol].index);
    }
    return text;
  }

  const SymbolTable& symbols_;
  FormulaStyle style_;
};

}  // namespace

std::string write(const Formula& formula, const SymbolTable& symbols, FormulaStyle style) {
  return Writer(symbols, style).write(formula).text;
}

}  // namespace screwline
