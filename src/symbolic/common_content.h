#ifndef SCREWLINE_SRC_SYMBOLIC_COMMON_CONTENT_H
#define SCREWLINE_SRC_SYMBOLIC_COMMON_CONTENT_H

#include <vector>

#include "factoring.h"

namespace screwline {

/// A direction counts up to its length: entries that contain one of the factors `zeros` become 0, what the others have
/// in common (factors, numbers, a square root) is taken out, and the sign is the one with fewer minuses.
void reduceDirection(std::vector<TrigPolynomial>& entries, const std::vector<TrigPolynomial>& zeros,
                     const SymbolTable& symbols);

/// Whether two reduced directions are the same, or opposite.
bool areParallel(const std::vector<TrigPolynomial>& a, const std::vector<TrigPolynomial>& b);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_COMMON_CONTENT_H
