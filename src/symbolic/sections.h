#ifndef SCREWLINE_SRC_SYMBOLIC_SECTIONS_H
#define SCREWLINE_SRC_SYMBOLIC_SECTIONS_H

#include <vector>

#include "numeric_check.h"
#include "screwline/symbolic/conditions.h"
#include "screwline/symbolic/document.h"

namespace screwline {

/// What the sections of a derivation are written from and to.
struct SectionDraft {
  const SerialChain& chain;
  const Task& task;
  const SymbolicChain& symbolic;
  DocumentWriter& document;
  NumericCheck& check;
};

/// The conditions, what each loses and to which rank, and the rank where they meet. @throws DerivationStopped
std::vector<ConditionFormula> writeSingularities(const SectionDraft& draft);

/// Joint efforts for a wrench at the tip, joint by joint, with the wrench in the axes where they are shortest.
void writeStatics(const SectionDraft& draft);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_SECTIONS_H
