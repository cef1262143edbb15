#ifndef SCREWLINE_SYMBOLIC_FORMULA_H
#define SCREWLINE_SYMBOLIC_FORMULA_H

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "screwline/symbolic/symbol_table.h"

namespace screwline {

enum class FormulaFunction { kSine, kCosine, kSquareRoot, kArcTangent2, kArcCosine, kArcSine };

/// An expression to be read, printed and evaluated: an immutable tree, cheap to copy, safe to share by threads. It is
/// kept as it was built: only numbers are folded, zeros and ones dropped, sums and products of the same kind flattened.
/// What makes it short and canonical is done before, by whoever builds it.
class Formula {
 public:
  enum class Kind { kNumber, kDecimal, kSymbol, kSum, kProduct, kPower, kCall };

  Formula() : Formula(number(0)) {}
  /// The exact number numerator / denominator. @pre denominator != 0.
  static Formula number(std::int64_t numerator, std::int64_t denominator = 1);
  static Formula decimal(double value);
  static Formula pi();
  static Formula symbol(int id);
  static Formula sum(const std::vector<Formula>& terms);
  static Formula product(const std::vector<Formula>& factors);
  static Formula power(const Formula& base, int exponent);
  static Formula call(FormulaFunction function, std::vector<Formula> arguments);
  static Formula sqrt(const Formula& argument) { return call(FormulaFunction::kSquareRoot, {argument}); }
  static Formula sin(const Formula& argument) { return call(FormulaFunction::kSine, {argument}); }
  static Formula cos(const Formula& argument) { return call(FormulaFunction::kCosine, {argument}); }

  Kind kind() const { return node_->kind; }
  bool isNumber(std::int64_t value) const;
  bool isZero() const { return isNumber(0); }
  std::int64_t numerator() const { return node_->numerator; }         ///< Of a kNumber; of a kPower its exponent.
  std::int64_t denominator() const { return node_->denominator; }     ///< Of a kNumber, positive.
  double decimalValue() const { return node_->decimal; }              ///< Of a kDecimal.
  int symbolId() const { return node_->symbol; }                      ///< Of a kSymbol; kPiSymbol is the number pi.
  FormulaFunction function() const { return node_->function; }        ///< Of a kCall.
  const std::vector<Formula>& parts() const { return node_->parts; }  ///< Terms, factors, base, or arguments.

  /// Value with the symbols' values by number. @pre all symbols that occur are among them.
  double evaluate(const std::vector<double>& values) const;
  /// The same with values in place of the symbols for which `replaced` is true.
  Formula withValues(const SymbolTable& symbols, const std::vector<bool>& replaced) const;

  static constexpr int kPiSymbol = -1;

 private:
  struct Node {
    Kind kind = Kind::kNumber;
    std::int64_t numerator = 0;
    std::int64_t denominator = 1;
    double decimal = 0.0;
    int symbol = 0;
    FormulaFunction function = FormulaFunction::kSine;
    std::vector<Formula> parts;
  };
  explicit Formula(Node node) : node_(std::make_shared<const Node>(std::move(node))) {}
  static Formula composite(Kind kind, std::vector<Formula> parts);

  std::shared_ptr<const Node> node_;
};

Formula operator+(const Formula& a, const Formula& b);
Formula operator-(const Formula& a, const Formula& b);
Formula operator-(const Formula& a);
Formula operator*(const Formula& a, const Formula& b);
Formula operator/(const Formula& a, const Formula& b);

/// A matrix of formulas, row-major.
struct FormulaMatrix {
  int rows = 0;
  int columns = 0;
  std::vector<Formula> entries;

  const Formula& operator()(int i, int j) const { return entries[static_cast<std::size_t>(i * columns + j)]; }
  MatrixX evaluate(const std::vector<double>& values) const;
};

enum class FormulaStyle {
  kText,   ///< "L1 c1 + L2 c12": sines and cosines of joints by their numbers, products by blanks.
  kInfix,  ///< "L1*cos(theta1) + L2*cos(theta1 + theta2)": + - * / ^ sin cos sqrt atan2 acos asin pi, symbols by name.
  kLatex,  ///< "L_{1} c_{1} + L_{2} c_{12}"
};

std::string write(const Formula& formula, const SymbolTable& symbols, FormulaStyle style);

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_FORMULA_H
