#ifndef SCREWLINE_SRC_SYMBOLIC_GINAC_BRIDGE_H
#define SCREWLINE_SRC_SYMBOLIC_GINAC_BRIDGE_H

#include <mutex>
#include <utility>
#include <vector>

#include <ginac/ginac.h>

#include "trig_polynomial.h"

namespace screwline {

/// GiNaC keeps tables without locks: whoever calls it, or holds one of its objects, holds this mutex.
std::timed_mutex& ginacMutex();

/// Polynomials as GiNaC's expressions and back, one GiNaC symbol for each entry of a key.
class GinacBridge {
 public:
  explicit GinacBridge(int entries);

  const GiNaC::symbol& symbol(std::size_t entry) const { return symbols_[entry]; }
  GiNaC::ex expression(const TrigPolynomial::Terms& terms) const;
  /// @throws DerivationStopped where a coefficient does not fit 64 bits.
  TrigPolynomial::Terms terms(const GiNaC::ex& expression) const;

 private:
  void readFactor(const GiNaC::ex& factor, TrigKey& key, Rational& coefficient) const;

  std::vector<GiNaC::symbol> symbols_;
};

/// The factors of a polynomial with rational coefficients, those that are numbers left out.
std::vector<std::pair<GiNaC::ex, int>> ginacFactors(const GiNaC::ex& polynomial);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_GINAC_BRIDGE_H
