#include "common_content.h"

#include <algorithm>
#include <numeric>

namespace screwline {
namespace {

/// The multiplicity of a base among factors.
int countOf(const FactoredPolynomial& polynomial, const TrigPolynomial& base) {
  for (const PolynomialFactor& factor : polynomial.factors) {
    if (factor.base == base || factor.base == -base) return factor.multiplicity;
  }
  return 0;
}

TrigPolynomial power(const TrigPolynomial& base, int exponent) {
  TrigPolynomial result = TrigPolynomial::number(base.ring(), 1);
  for (int i = 0; i < exponent; ++i) result = result * base;
  return result;
}

/// `count` of `base` less than the polynomial has; -base where it is written so changes the sign.
void takeOut(FactoredPolynomial& polynomial, const TrigPolynomial& base, int count) {
  for (PolynomialFactor& factor : polynomial.factors) {
    const bool same = factor.base == base;
    if (!same && !(factor.base == -base)) continue;
    factor.multiplicity -= count;
    if (!same && count % 2 != 0) polynomial.coefficient = -polynomial.coefficient;
    return;
  }
}

void divideByNumber(std::vector<TrigPolynomial>& entries) {
  std::int64_t top = 0;
  std::int64_t bottom = 1;
  std::int64_t minuses = 0;
  std::int64_t terms = 0;
  TrigKey radicals{1, 1};
  for (const TrigPolynomial& entry : entries) {
    for (const auto& [key, coefficient] : entry.terms()) {
      top = std::gcd(top, coefficient.numerator());
      bottom = std::lcm(bottom, coefficient.denominator());
      minuses += coefficient.numerator() < 0 ? 1 : 0;
      ++terms;
      for (std::size_t i = 0; i < TrigRing::kRadicals; ++i) radicals[i] = std::min(radicals[i], key[i]);
    }
  }
  if (terms == 0) return;
  const Rational share(2 * minuses > terms ? -bottom : bottom, top);
  for (TrigPolynomial& entry : entries) {
    TrigPolynomial divided(entry.ring());
    for (const auto& [key, coefficient] : entry.terms()) {
      TrigKey rest = key;
      for (std::size_t i = 0; i < TrigRing::kRadicals; ++i) rest[i] = static_cast<std::int8_t>(rest[i] - radicals[i]);
      divided.add(rest, coefficient * share);
    }
    entry = divided;
  }
}

}  // namespace

void reduceDirection(std::vector<TrigPolynomial>& entries, const std::vector<TrigPolynomial>& zeros,
                     const SymbolTable& symbols) {
  const auto is_not_zero = [](const TrigPolynomial& entry) { return !entry.isZero(); };
  if (std::count_if(entries.begin(), entries.end(), is_not_zero) == 1) {  // A coordinate axis.
    TrigPolynomial& only = *std::find_if(entries.begin(), entries.end(), is_not_zero);
    only = TrigPolynomial::number(only.ring(), 1);
    return;
  }
  std::vector<FactoredPolynomial> parts;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].isZero()) continue;
    FactoredPolynomial part = factored(entries[i], symbols);
    if (std::any_of(zeros.begin(), zeros.end(),
                    [&part](const TrigPolynomial& zero) { return countOf(part, zero) > 0; })) {
      entries[i] = TrigPolynomial(entries[i].ring());
      continue;
    }
    parts.push_back(std::move(part));
    places.push_back(i);
  }
  if (parts.empty()) return;
  const std::vector<PolynomialFactor> candidates = parts.front().factors;
  for (const PolynomialFactor& candidate : candidates) {
    int shared = candidate.multiplicity;
    for (const FactoredPolynomial& part : parts) shared = std::min(shared, countOf(part, candidate.base));
    if (shared == 0) continue;
    for (FactoredPolynomial& part : parts) takeOut(part, candidate.base, shared);
  }
  for (std::size_t k = 0; k < parts.size(); ++k) {
    TrigPolynomial product = parts[k].coefficient;
    for (const PolynomialFactor& factor : parts[k].factors) product = product * power(factor.base, factor.multiplicity);
    entries[places[k]] = product;
  }
  divideByNumber(entries);
}

bool areParallel(const std::vector<TrigPolynomial>& a, const std::vector<TrigPolynomial>& b) {
  bool same = a.size() == b.size();
  bool opposite = same;
  for (std::size_t i = 0; i < a.size() && (same || opposite); ++i) {
    same = same && a[i] == b[i];
    opposite = opposite && a[i] == -b[i];
  }
  return same || opposite;
}

}  // namespace screwline
