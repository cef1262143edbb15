#ifndef SCREWLINE_SRC_SYMBOLIC_IRREDUCIBLE_H
#define SCREWLINE_SRC_SYMBOLIC_IRREDUCIBLE_H

#include <vector>

#include "trig_polynomial.h"

namespace screwline {

/// Whether a polynomial is proved to have no two factors of which each depends on one of the variables, the entries of
/// its keys for which variable[i] is true: on a line through their space, with numbers for all other entries, it is a
/// polynomial of one unknown. Where that is of the same degree and has no factors, the polynomial has none either; most
/// lines show it (Hilbert's irreducibility theorem). Milliseconds, where factoring it takes seconds to say the same.
/// False: not known. @pre the caller holds ginacMutex(). @throws DerivationStopped
bool isProvedIrreducible(const TrigRing& ring, const TrigPolynomial::Terms& terms, const std::vector<bool>& variable);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_IRREDUCIBLE_H
