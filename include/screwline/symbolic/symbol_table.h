#ifndef SCREWLINE_SYMBOLIC_SYMBOL_TABLE_H
#define SCREWLINE_SYMBOLIC_SYMBOL_TABLE_H

#include <optional>
#include <string>
#include <vector>

#include "screwline/spatial/pose.h"

namespace screwline {

enum class SymbolKind {
  kAngle,          ///< A revolute joint's value [rad].
  kSlide,          ///< A prismatic joint's value [m].
  kLength,         ///< A length of the robot [m], of which the value is known.
  kConstantAngle,  ///< An angle of the robot [rad], of which the value is known.
  kRate,           ///< A joint's velocity [rad/s, m/s].
  kInput,          ///< Anything else that a formula depends on: a wrench's components, a target's.
};

/// A name in formulas.
struct Symbol {
  std::string name;   ///< In infix: a joint's as in the chain; unique.
  std::string brief;  ///< In text: "theta3" (its sine is "s3"), "d3", "a2".
  std::string latex;
  SymbolKind kind = SymbolKind::kInput;
  double value = 0.0;   ///< Of lengths and constant angles; of joints at zero.
  int index = 0;        ///< Of a joint: 1 for the first; the subscript of its sine and cosine.
  std::string meaning;  ///< In a line: "a_2 of the modified-DH table".
};

/// The symbols of one derivation; formulas name them by their number. The chain's joints are symbols 0..n-1.
class SymbolTable {
 public:
  /// Adds a symbol and returns its number; a name that is taken gets underscores until it is free.
  int add(Symbol symbol);
  int size() const { return static_cast<int>(symbols_.size()); }
  const Symbol& operator[](int id) const { return symbols_[static_cast<std::size_t>(id)]; }
  std::optional<int> find(const std::string& name) const;
  /// Values of all symbols where the joints have the values q.
  std::vector<double> valuesAt(const ConstVectorRef& q) const;

 private:
  std::vector<Symbol> symbols_;
};

/// "theta3" as "\theta_{3}", "d4" as "d_{4}", "shoulder_pan" as "\mathrm{shoulder\_pan}".
std::string latexOfName(const std::string& name);

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_SYMBOL_TABLE_H
