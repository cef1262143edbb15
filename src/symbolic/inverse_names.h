#ifndef SCREWLINE_SRC_SYMBOLIC_INVERSE_NAMES_H
#define SCREWLINE_SRC_SYMBOLIC_INVERSE_NAMES_H

#include <array>
#include <string>

#include "screwline/symbolic/symbol_table.h"

namespace screwline {

/// What polynomials of an inverse solution may have in them besides the target and the joints: a point, distances,
/// entries of a rotation, a direction, a place in a plane, a point without a given joint, open rows (the last two).
constexpr std::array<const char*, 32> kInverseResults = {
    "wx",  "wy",  "wz",  "f",   "u",   "v",   "m11", "m12", "m13", "m21", "m22", "m23", "m31", "m32", "m33", "t11",
    "t12", "t13", "t21", "t22", "t23", "t31", "t32", "t33", "hx",  "hy",  "hz",  "qx",  "qy",  "qz",  "o1",  "o2"};

/// A symbol of that name, its letter with the rest as subscript.
inline Symbol inputSymbol(const std::string& name) {
  Symbol symbol;
  symbol.name = name;
  symbol.brief = name;
  const std::size_t letters = name.size() > 1 && name != "phi" ? 1 : name.size();
  symbol.latex = letters < name.size() ? name.substr(0, 1) + "_{" + name.substr(1) + "}" : latexOfName(name);
  return symbol;
}

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_INVERSE_NAMES_H
