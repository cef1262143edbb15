#ifndef SCREWLINE_SRC_SYMBOLIC_WHERE_ZERO_H
#define SCREWLINE_SRC_SYMBOLIC_WHERE_ZERO_H

#include <vector>

#include "trig_polynomial.h"

namespace screwline {

/// What is left of a polynomial where all of the conditions are zero: each of them g L + h, with L a length or a slide,
/// gives L = -h / g, and the polynomial is multiplied by g as often as it takes. So where the conditions hold, the
/// result is zero where the polynomial is, and where a g is. Conditions without such an L are left aside. The
/// polynomial as it was where the result would have more than `most_terms`. Deterministic; allocates.
TrigPolynomial whereZero(std::vector<TrigPolynomial> conditions, const TrigPolynomial& polynomial,
                         std::size_t most_terms);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_WHERE_ZERO_H
