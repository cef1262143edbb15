#include "readable.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace screwline {
namespace {

using Terms = TrigPolynomial::Terms;

constexpr std::size_t kManyTerms = 80;  ///< Beyond it one way of collecting is tried, not all.

std::size_t at(int entry) {
  return static_cast<std::size_t>(entry);
}

void addTo(Terms& terms, const TrigKey& key, const Rational& coefficient) {
  const auto [entry, fresh] = terms.try_emplace(key, coefficient);
  if (fresh) return;
  entry->second = entry->second + coefficient;
  if (entry->second.isZero()) terms.erase(entry);
}

/// sin^2 -> 1 - cos^2 (or the other way round) in the powers of one angle.
Terms exchanged(const Terms& terms, const AngleGroup& group, bool to_sines) {
  const std::size_t from = at(group.offset + (to_sines ? 0 : 1));
  const std::size_t to = at(group.offset + (to_sines ? 1 : 0));
  Terms open = terms;
  Terms done;
  while (!open.empty()) {
    const auto [key, coefficient] = *open.begin();
    open.erase(open.begin());
    if (key[from] < 2) {
      addTo(done, key, coefficient);
      continue;
    }
    TrigKey lower = key;
    lower[from] = static_cast<std::int8_t>(lower[from] - 2);
    addTo(open, lower, coefficient);
    lower[to] = static_cast<std::int8_t>(lower[to] + 2);
    addTo(open, lower, -coefficient);
  }
  return done;
}

/// Whether the entries [first, first + count) of a key are zero.
bool isEmptyAt(const TrigKey& key, int first, int count) {
  return std::all_of(key.begin() + first, key.begin() + first + count, [](std::int8_t entry) { return entry == 0; });
}

void takeCommonExponents(const Terms& terms, int first, int count, bool powers, TrigKey& common) {
  for (int entry = first; entry < first + count; ++entry) {
    common[at(entry)] = terms.begin()->first[at(entry)];
    for (const auto& term : terms) {
      const std::int8_t exponent = term.first[at(entry)];
      if (powers) {
        common[at(entry)] = std::min(common[at(entry)], exponent);
      } else if (exponent != common[at(entry)]) {
        std::fill_n(common.begin() + first, count, std::int8_t{0});
        return;
      }
    }
  }
}

Rational commonNumber(const Terms& terms) {
  std::int64_t top = 0;
  std::int64_t bottom = 1;
  for (const auto& term : terms) {
    top = std::gcd(top, term.second.numerator());
    bottom = std::lcm(bottom, term.second.denominator());
  }
  const bool negative =
      std::all_of(terms.begin(), terms.end(), [](const auto& term) { return term.second.numerator() < 0; });
  return Rational(negative ? -top : top, bottom);
}

Formula angleFormula(const AngleGroup& group, const TrigKey& key) {
  if (group.isSingle()) return Formula::symbol(group.angles.front());
  std::vector<Formula> shares;
  for (std::size_t k = 0; k < group.angles.size(); ++k) {
    const int times = key[at(group.offset + 1) + k];
    if (times != 0) shares.push_back(Formula::number(times) * Formula::symbol(group.angles[k]));
  }
  return Formula::sum(shares);
}

}  // namespace

std::pair<TrigKey, Rational> takeCommonFactor(const TrigRing& ring, Terms& terms) {
  TrigKey common{};
  takeCommonExponents(terms, 0, TrigRing::kRadicals + static_cast<int>(ring.scalars().size()), true, common);
  for (const AngleGroup& group : ring.groups())
    takeCommonExponents(terms, group.offset, group.entries(), group.isSingle(), common);
  const Rational number = commonNumber(terms);
  Terms divided;
  for (const auto& [key, coefficient] : terms) {
    TrigKey rest = key;
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = static_cast<std::int8_t>(rest[i] - common[i]);
    divided.emplace(rest, coefficient / number);
  }
  terms = std::move(divided);
  return {common, number};
}

std::size_t Reader::length(const Formula& formula) const {
  return screwline::write(formula, symbols_, FormulaStyle::kText).size();
}

Formula Reader::formula(const TrigPolynomial& polynomial) {
  return write(polynomial.terms());
}

Terms Reader::withFewestTerms(const Terms& terms) const {
  Terms best = terms;
  for (const AngleGroup& group : ring_->groups()) {
    if (!group.isSingle()) continue;
    for (const bool to_sines : {true, false}) {
      Terms other = exchanged(best, group, to_sines);
      if (other.size() < best.size()) best = std::move(other);
    }
  }
  return best;
}

Formula Reader::write(const Terms& terms) {
  if (terms.empty()) return Formula::number(0);
  const auto known = written_.find(terms);
  if (known != written_.end()) return known->second;
  ring_->poll();
  Terms rest = withFewestTerms(terms);
  const Terms whole = rest;
  auto [key, number] = takeCommonFactor(*ring_, rest);
  Formula result;
  if (key == TrigKey{} && (number == Rational(1) || number == Rational(-1))) {
    result = bracket(whole);  // "-a - b" rather than "-(a + b)"
  } else {
    const Formula in_front = monomial(key, number);
    result = rest.size() == 1 ? in_front : in_front * bracket(rest);
  }
  written_.emplace(terms, result);
  return result;
}

Formula Reader::bracket(const Terms& terms) {
  Formula best = flat(terms);
  if (terms.size() < 3) return best;
  const bool many = terms.size() > kManyTerms;
  std::optional<std::size_t> shortest;
  if (!many) shortest = length(best);
  const auto offer = [&](int first, int count) {
    const bool splits =
        std::any_of(terms.begin(), terms.end(), [&](const auto& term) { return !isEmptyAt(term.first, first, count); });
    if (!splits || (many && shortest)) return;
    const Formula candidate = collected(terms, first, count);
    const std::size_t size = length(candidate);
    if (shortest && size >= *shortest) return;
    shortest = size;
    best = candidate;
  };
  for (const AngleGroup& group : ring_->groups()) offer(group.offset, group.entries());
  offer(TrigRing::kRadicals, static_cast<int>(ring_->scalars().size()));
  return best;
}

bool Reader::isBefore(const TrigKey& a, const TrigKey& b) const {
  const int scalars = static_cast<int>(ring_->scalars().size());
  for (int i = TrigRing::kRadicals; i < TrigRing::kRadicals + scalars; ++i) {
    if (a[at(i)] != b[at(i)]) return a[at(i)] > b[at(i)];
  }
  for (const AngleGroup& group : ring_->groups()) {
    for (int i = group.offset; i < group.offset + group.entries(); ++i) {
      if (a[at(i)] == b[at(i)]) continue;
      const bool is_sine_flag = !group.isSingle() && i == group.offset;
      return is_sine_flag || !group.isSingle() ? a[at(i)] < b[at(i)] : a[at(i)] > b[at(i)];
    }
  }
  return b < a;
}

Formula Reader::flat(const Terms& terms) const {
  std::vector<TrigKey> keys;
  for (const auto& term : terms) keys.push_back(term.first);
  std::sort(keys.begin(), keys.end(), [this](const TrigKey& a, const TrigKey& b) { return isBefore(a, b); });
  std::vector<Formula> sum;
  for (const TrigKey& key : keys) sum.push_back(monomial(key, terms.at(key)));
  const auto positive =
      std::find_if(keys.begin(), keys.end(), [&](const TrigKey& key) { return Rational(0) < terms.at(key); });
  if (positive != keys.end()) {
    const auto place = sum.begin() + (positive - keys.begin());
    std::rotate(sum.begin(), place, place + 1);
  }
  return Formula::sum(sum);
}

/// Sum over what stands in the entries [first, first + count), times what it is multiplied with; where that is the same
/// but for a monomial, the two are one bracket times another.
Formula Reader::collected(const Terms& terms, int first, int count) {
  std::map<TrigKey, Terms> by_entry;
  for (const auto& [key, coefficient] : terms) {
    TrigKey entry{};
    TrigKey rest = key;
    std::copy_n(key.begin() + first, count, entry.begin() + first);
    std::fill_n(rest.begin() + first, count, std::int8_t{0});
    by_entry[entry].emplace(rest, coefficient);
  }
  std::vector<std::pair<Terms, Terms>> products;
  for (auto& [entry, factor] : by_entry) {
    auto [key, number] = takeCommonFactor(*ring_, factor);
    if (Rational(0) < number && factor.begin()->second < Rational(0)) {  // so that P and -P are one bracket
      number = -number;
      for (auto& term : factor) term.second = -term.second;
    }
    for (std::size_t i = 0; i < key.size(); ++i) key[i] = static_cast<std::int8_t>(key[i] + entry[i]);
    const auto same = std::find_if(products.begin(), products.end(),
                                   [&factor = factor](const auto& product) { return product.second == factor; });
    if (same != products.end()) {
      addTo(same->first, key, number);
    } else {
      products.push_back({{{key, number}}, factor});
    }
  }
  const bool apart = products.size() == 1 && products.front().first.size() == terms.size();
  if (apart) return flat(terms);  // Nothing but monomials: no bracket came together.
  std::sort(products.begin(), products.end(),
            [this](const auto& a, const auto& b) { return isBefore(a.first.begin()->first, b.first.begin()->first); });
  std::vector<Formula> sum;
  for (auto& [left, right] : products) {
    const bool negative = std::all_of(left.begin(), left.end(), [](const auto& t) { return t.second < Rational(0); });
    const bool mixed = std::any_of(right.begin(), right.end(), [](const auto& t) { return t.second < Rational(0); });
    if (negative && mixed) {  // -(a - b) c is better (b - a) c
      for (auto& term : left) term.second = -term.second;
      for (auto& term : right) term.second = -term.second;
    }
    sum.push_back(write(left) * write(right));
  }
  return Formula::sum(sum);
}

Formula Reader::circular(const AngleGroup& group, const TrigKey& key) const {
  const int first = key[at(group.offset)];
  if (group.isSingle()) {
    const Formula angle = angleFormula(group, key);
    return Formula::power(Formula::cos(angle), first) * Formula::power(Formula::sin(angle), key[at(group.offset + 1)]);
  }
  if (isEmptyAt(key, group.offset, group.entries())) return Formula::number(1);
  const Formula angle = angleFormula(group, key);
  return first != 0 ? Formula::sin(angle) : Formula::cos(angle);
}

Formula Reader::monomial(const TrigKey& key, const Rational& coefficient) const {
  std::vector<Formula> factors = {Formula::number(coefficient.numerator(), coefficient.denominator())};
  const int radicand = (key[0] != 0 ? 2 : 1) * (key[1] != 0 ? 3 : 1);
  if (radicand > 1) factors.push_back(Formula::sqrt(Formula::number(radicand)));
  for (std::size_t i = 0; i < ring_->scalars().size(); ++i)
    factors.push_back(Formula::power(Formula::symbol(ring_->scalars()[i]), key[at(ring_->scalarOffset(i))]));
  for (const AngleGroup& group : ring_->groups()) factors.push_back(circular(group, key));
  return Formula::product(factors);
}

}  // namespace screwline
