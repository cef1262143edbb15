#ifndef SCREWLINE_SYMBOLIC_STATICS_H
#define SCREWLINE_SYMBOLIC_STATICS_H

#include <vector>

#include "screwline/symbolic/symbolic_chain.h"

namespace screwline {

/// Joint efforts [N m, N] that hold a wrench: tau = J^T F, with F = [f; n] exerted by the tip on the environment about
/// the tip's origin, its components the symbols fx to nz in the axes of `frame` (Craig, eq. 5.96).
struct StaticsFormula {
  FrameNumber frame = 0;
  std::vector<Formula> efforts;  ///< One for each degree of freedom.
};

/// In the axes of the frame that makes them shortest together. @throws DerivationStopped
StaticsFormula staticsOf(const SymbolicChain& chain);

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_STATICS_H
