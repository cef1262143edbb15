#ifndef SCREWLINE_SRC_SYMBOLIC_FACTORING_H
#define SCREWLINE_SRC_SYMBOLIC_FACTORING_H

#include <vector>

#include "trig_polynomial.h"

namespace screwline {

struct PolynomialFactor {
  TrigPolynomial base;
  int multiplicity = 1;
};

/// coefficient (a number, with square roots of 2 and 3) times the factors: lengths first, then slides, then what
/// depends on one joint, then the others.
struct FactoredPolynomial {
  TrigPolynomial coefficient;
  std::vector<PolynomialFactor> factors;
};

/// The polynomial in factors, primitive ones with the sign that leaves most terms positive. Found over half angles,
/// where factors are unique, with GiNaC's gcd() and factor(); sines and cosines are put together again, so a factor
/// here may still be a product of half-angle ones. The product is checked to be the polynomial exactly; what fails
/// that, or is too large to factor, stays whole. Deterministic. GiNaC is not thread-safe: calls wait for each other at
/// one mutex.
/// @pre polynomial is not zero.
FactoredPolynomial factored(const TrigPolynomial& polynomial, const SymbolTable& symbols);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_FACTORING_H
