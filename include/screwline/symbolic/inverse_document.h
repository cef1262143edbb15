#ifndef SCREWLINE_SYMBOLIC_INVERSE_DOCUMENT_H
#define SCREWLINE_SYMBOLIC_INVERSE_DOCUMENT_H

#include "screwline/symbolic/document.h"
#include "screwline/symbolic/inverse_formulas.h"

namespace screwline {

/// The lines of an inverse solution in reading order, with what they are about, where they give two branches, out of
/// which reach there is no solution, and where a joint may take any value. Returns a document's part: headings are the
/// caller's.
std::string inverseSection(const InverseFormulas& formulas, DocumentFormat format);

/// What the check found, in a sentence.
std::string sentenceOf(const InverseCheck& check);

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_INVERSE_DOCUMENT_H
