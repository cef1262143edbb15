#ifndef SCREWLINE_SYMBOLIC_CPP_HEADER_H
#define SCREWLINE_SYMBOLIC_CPP_HEADER_H

#include <optional>
#include <string>

#include "screwline/symbolic/inverse_formulas.h"

namespace screwline {

/// A C++17 header for this one robot that needs nothing but <array>, <cmath> and <vector>: forward kinematics of the
/// tip, its geometric Jacobian [v; w] in the base link and, where `inverse` has formulas, all inverse solutions; of
/// seven joints those for a value of the parameter joint. In a namespace of the robot's name. Allocates. @throws
/// DerivationStopped
std::string cppHeaderOf(const SerialChain& chain, const std::optional<InverseFormulas>& inverse,
                        const SymbolicOptions& options = {}, const Progress& progress = {});

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_CPP_HEADER_H
