#include "cpp_writer.h"

#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace screwline {
namespace {

using Kind = Formula::Kind;

bool isNegative(const Formula& formula) {
  if (formula.kind() == Kind::kNumber) return formula.numerator() < 0;
  if (formula.kind() == Kind::kDecimal) return formula.decimalValue() < 0.0;
  return formula.kind() == Kind::kProduct && isNegative(formula.parts().front());
}

bool isCircular(const Formula& formula) {
  return formula.kind() == Kind::kCall &&
         (formula.function() == FormulaFunction::kSine || formula.function() == FormulaFunction::kCosine);
}

std::string integer(std::int64_t value) {
  return std::to_string(value) + ".0";
}

const char* functionName(FormulaFunction function) {
  switch (function) {
    case FormulaFunction::kSine:
      return "std::sin";
    case FormulaFunction::kCosine:
      return "std::cos";
    case FormulaFunction::kSquareRoot:
      return "std::sqrt";
    case FormulaFunction::kArcTangent2:
      return "std::atan2";
    case FormulaFunction::kArcCosine:
      return "std::acos";
    case FormulaFunction::kArcSine:
      break;
  }
  return "std::asin";
}

}  // namespace

std::string cppNumber(double value) {
  char text[40];
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  const std::string number = text;
  return number.find_first_of(".e") == std::string::npos ? number + ".0" : number;
}

std::string cppIdentifier(const std::string& name) {
  std::string identifier;
  for (const char c : name) {
    const bool fits = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    identifier += fits ? c : '_';
  }
  const bool starts_well = !identifier.empty() && std::isalpha(static_cast<unsigned char>(identifier.front())) != 0;
  return starts_well ? identifier : "robot_" + identifier;
}

/// What the header itself uses, and short words of the language that a name could be.
CppWriter::CppWriter(const SymbolTable& symbols)
    : symbols_(symbols), taken_({"X",   "J",   "q",   "p",   "R",   "target", "preferred", "solutions", "free",
                                 "do",  "if",  "or",  "and", "not", "int",    "new",       "for",       "try",
                                 "std", "xor", "asm", "y0",  "y1",  "j0",     "j1",        "yn",        "jn"}) {}

std::string CppWriter::fresh(const std::string& wanted) {
  const std::string stem = cppIdentifier(wanted);
  std::string name = stem;
  for (int number = 2; taken_.count(name) > 0 || local_.count(name) > 0; ++number)
    name = stem + "_" + std::to_string(number);
  (in_function_ ? local_ : taken_).insert(name);
  return name;
}

void CppWriter::beginFunction() {
  in_function_ = true;
  local_.clear();
  circulars_.clear();
}

std::string CppWriter::declare(int symbol, const std::string& wanted) {
  return names_[symbol] = fresh(wanted);
}

std::vector<std::string> CppWriter::declarations(const Formula& formula) {
  std::vector<std::string> lines;
  for (const Formula& part : formula.parts()) {
    for (std::string& line : declarations(part)) lines.push_back(std::move(line));
  }
  if (!isCircular(formula)) return lines;
  const std::string key = screwline::write(formula, symbols_, FormulaStyle::kInfix);
  if (circulars_.count(key) > 0) return lines;
  const std::string name = fresh(circularName(formula));
  lines.push_back("const double " + name + " = " + functionName(formula.function()) + "(" +
                  expression(formula.parts().front()) + ");");
  circulars_[key] = name;
  return lines;
}

/// "s23" where that is how formulas print it.
std::string CppWriter::circularName(const Formula& formula) const {
  const std::string brief = screwline::write(formula, symbols_, FormulaStyle::kText);
  for (const char c : brief) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0)
      return formula.function() == FormulaFunction::kSine ? "sine" : "cosine";
  }
  return brief;
}

std::string CppWriter::write(const Formula& formula, int needed) const {
  int binding = kAtom;
  std::string text;
  switch (formula.kind()) {
    case Kind::kNumber:
      binding = formula.numerator() < 0 ? kLowest : formula.denominator() == 1 ? kAtom : kProduct;
      text = integer(formula.numerator()) + (formula.denominator() == 1 ? "" : " / " + integer(formula.denominator()));
      break;
    case Kind::kDecimal:
      binding = formula.decimalValue() < 0.0 ? kLowest : kAtom;
      text = cppNumber(formula.decimalValue());
      break;
    case Kind::kSymbol:
      text = formula.symbolId() == Formula::kPiSymbol ? "kPi" : name(formula.symbolId());
      break;
    case Kind::kSum:
      binding = kLowest;
      text = sum(formula);
      break;
    case Kind::kProduct:
      binding = isNegative(formula) ? kLowest : kProduct;
      text = product(formula.parts());
      break;
    case Kind::kPower:
      binding = formula.numerator() < 0 ? kProduct : kAtom;
      text = formula.numerator() < 0 ? product({formula}) : power(formula);
      break;
    case Kind::kCall:
      text = call(formula);
      break;
  }
  return binding >= needed ? text : "(" + text + ")";
}

std::string CppWriter::sum(const Formula& formula) const {
  std::string text;
  for (const Formula& term : formula.parts()) {
    const bool negative = isNegative(term);
    text += text.empty() ? (negative ? "-" : "") : (negative ? " - " : " + ");
    text += write(negative ? -term : term, kProduct);
  }
  return text;
}

std::string CppWriter::product(const std::vector<Formula>& factors) const {
  if (isNegative(factors.front())) {
    std::vector<Formula> positive = factors;
    positive.front() = -positive.front();
    return "-" + write(Formula::product(positive), kProduct);
  }
  std::string above;
  std::string below;
  for (const Formula& factor : factors) {
    if (factor.kind() == Kind::kPower && factor.numerator() < 0) {
      const Formula base = Formula::power(factor.parts().front(), -static_cast<int>(factor.numerator()));
      below += " / " + write(base, kAtom);
    } else {
      above += (above.empty() ? "" : " * ") + write(factor, kAtom);
    }
  }
  return (above.empty() ? "1.0" : above) + below;
}

std::string CppWriter::power(const Formula& formula) const {
  const std::string base = write(formula.parts().front(), kLowest);
  if (formula.numerator() == 2) return "square(" + base + ")";
  return "std::pow(" + base + ", " + std::to_string(formula.numerator()) + ")";
}

std::string CppWriter::call(const Formula& formula) const {
  if (isCircular(formula)) {
    const auto known = circulars_.find(screwline::write(formula, symbols_, FormulaStyle::kInfix));
    if (known != circulars_.end()) return known->second;
  }
  std::string arguments;
  for (const Formula& argument : formula.parts())
    arguments += (arguments.empty() ? "" : ", ") + write(argument, kLowest);
  return std::string(functionName(formula.function())) + "(" + arguments + ")";
}

}  // namespace screwline
