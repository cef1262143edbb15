#ifndef SCREWLINE_SRC_SYMBOLIC_CPP_WRITER_H
#define SCREWLINE_SRC_SYMBOLIC_CPP_WRITER_H

#include <map>
#include <set>
#include <string>
#include <vector>

#include "screwline/symbolic/formula.h"

namespace screwline {

/// A number that reads back as the same, with a point or an exponent.
std::string cppNumber(double value);

/// Letters, digits and underscores, no digit first.
std::string cppIdentifier(const std::string& name);

/// Writes formulas as C++ expressions. Sines and cosines become variables, declared before their first use.
class CppWriter {
 public:
  explicit CppWriter(const SymbolTable& symbols);

  /// What a symbol is called; a fresh identifier made from `wanted` where that is taken.
  std::string declare(int symbol, const std::string& wanted);
  /// Gives a symbol an expression that is an identifier or an element.
  void assign(int symbol, const std::string& expression) { names_[symbol] = expression; }
  /// An identifier that nothing else has.
  std::string fresh(const std::string& wanted);
  const std::string& name(int symbol) const { return names_.at(symbol); }

  /// Declarations, a line each, of sines and cosines in the formula that were not declared yet.
  std::vector<std::string> declarations(const Formula& formula);
  std::string expression(const Formula& formula) const { return write(formula, kLowest); }
  /// Forgets the sines, cosines and names that were declared since the last function began.
  void beginFunction();

 private:
  static constexpr int kLowest = 0;  // Sums.
  static constexpr int kProduct = 1;
  static constexpr int kAtom = 2;

  std::string write(const Formula& formula, int needed) const;
  std::string sum(const Formula& formula) const;
  std::string product(const std::vector<Formula>& factors) const;
  std::string power(const Formula& formula) const;
  std::string call(const Formula& formula) const;
  std::string circularName(const Formula& formula) const;

  const SymbolTable& symbols_;
  std::map<int, std::string> names_;
  std::set<std::string> taken_;
  std::set<std::string> local_;  ///< The same, within the present function.
  bool in_function_ = false;
  std::map<std::string, std::string> circulars_;  ///< By the call in infix.
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_CPP_WRITER_H
