#ifndef SCREWLINE_SRC_SYMBOLIC_READABLE_H
#define SCREWLINE_SRC_SYMBOLIC_READABLE_H

#include <map>
#include <string>

#include "screwline/symbolic/formula.h"
#include "trig_polynomial.h"

namespace screwline {

/// Writes polynomials as people do: common factors in front, what belongs together in brackets, the shortest of the
/// ways tried. Deterministic. Remembers what it has written; belongs to one thread.
class Reader {
 public:
  Reader(RingPointer ring, const SymbolTable& symbols) : ring_(std::move(ring)), symbols_(symbols) {}

  Formula formula(const TrigPolynomial& polynomial);
  /// Characters of its text, the measure of what is short.
  std::size_t length(const Formula& formula) const;

 private:
  using Terms = TrigPolynomial::Terms;
  Formula write(const Terms& terms);
  Formula bracket(const Terms& terms);
  Formula flat(const Terms& terms) const;
  Formula collected(const Terms& terms, int first, int count);
  Formula monomial(const TrigKey& key, const Rational& coefficient) const;
  Formula circular(const AngleGroup& group, const TrigKey& key) const;
  Terms withFewestTerms(const Terms& terms) const;
  bool isBefore(const TrigKey& a, const TrigKey& b) const;

  RingPointer ring_;
  const SymbolTable& symbols_;
  std::map<Terms, Formula> written_;
};

/// The greatest monomial (coefficient positive unless all terms are negative) that divides all terms; they are divided
/// by it. Works with keys whose sines have powers too.
std::pair<TrigKey, Rational> takeCommonFactor(const TrigRing& ring, TrigPolynomial::Terms& terms);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_READABLE_H
