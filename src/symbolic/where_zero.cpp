#include "where_zero.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace screwline {
namespace {

/// Coefficients of the powers of a scalar.
std::vector<TrigPolynomial> powersOf(const TrigPolynomial& polynomial, std::size_t entry) {
  std::vector<TrigPolynomial> powers;
  for (const auto& [key, coefficient] : polynomial.terms()) {
    const auto power = static_cast<std::size_t>(key[entry]);
    while (powers.size() <= power) powers.emplace_back(polynomial.ring());
    TrigKey rest = key;
    rest[entry] = 0;
    powers[power].add(rest, coefficient);
  }
  return powers;
}

/// A scalar L and what it is where g L + h is zero.
struct Solved {
  std::size_t entry;
  TrigPolynomial g;
  TrigPolynomial h;
};

/// For the scalar of which g is shortest.
std::optional<Solved> solved(const TrigPolynomial& condition) {
  std::optional<Solved> best;
  const TrigRing& ring = *condition.ring();
  for (std::size_t i = 0; i < ring.scalars().size(); ++i) {
    const auto entry = static_cast<std::size_t>(ring.scalarOffset(i));
    const std::vector<TrigPolynomial> powers = powersOf(condition, entry);
    if (powers.size() != 2) continue;
    const auto size = [](const TrigPolynomial& g) { return g.isNumber() ? std::size_t{0} : g.terms().size(); };
    if (!best || size(powers[1]) < size(best->g)) best = Solved{entry, powers[1], powers[0]};
  }
  return best;
}

std::optional<TrigPolynomial> replaced(const Solved& L, const TrigPolynomial& polynomial, std::size_t most_terms) {
  const std::vector<TrigPolynomial> powers = powersOf(polynomial, L.entry);
  TrigPolynomial result(polynomial.ring());
  TrigPolynomial g_power = TrigPolynomial::number(polynomial.ring(), 1);
  for (std::size_t k = powers.size(); k-- > 0;) {  // Horner: result = result (-h) + powers[k] g^(n - k)
    result = powers[k] * g_power - result * L.h;
    g_power = g_power * L.g;
    if (result.terms().size() > most_terms) return std::nullopt;
  }
  return result;
}

}  // namespace

TrigPolynomial whereZero(std::vector<TrigPolynomial> conditions, const TrigPolynomial& polynomial,
                         std::size_t most_terms) {
  TrigPolynomial rest = polynomial;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const std::optional<Solved> L = solved(conditions[i]);
    if (!L) continue;
    std::optional<TrigPolynomial> next = replaced(*L, rest, most_terms);
    if (!next) return polynomial;
    rest = std::move(*next);
    for (std::size_t j = i + 1; j < conditions.size(); ++j) {
      next = replaced(*L, conditions[j], most_terms);
      if (!next) return polynomial;
      conditions[j] = std::move(*next);
    }
  }
  return rest;
}

}  // namespace screwline
