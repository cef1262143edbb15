#include "trig_polynomial.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace screwline {
namespace {

constexpr int kQuarter = 6;  ///< Steps of 15 degrees in a right angle.
constexpr std::size_t kTermsPerPoll = 512;

std::size_t at(int entry) {
  return static_cast<std::size_t>(entry);
}

std::int8_t exponentSum(int a, int b) {
  const int sum = a + b;
  if (sum > 127 || sum < -127) throw DerivationStopped("the exponents of the expressions grow beyond 127");
  return static_cast<std::int8_t>(sum);
}

/// Part of a product of two terms: what is multiplied out so far.
struct Partial {
  TrigKey key;
  Rational coefficient;
};

/// sin (1) or cos (0) of multiples, the first of which is to be positive; false where it is the sine of 0.
bool normaliseAngle(const AngleGroup& group, TrigKey& key, Rational& coefficient) {
  const auto first = key.begin() + group.offset + 1;
  const auto last = first + static_cast<std::ptrdiff_t>(group.angles.size());
  const auto leading = std::find_if(first, last, [](std::int8_t multiple) { return multiple != 0; });
  std::int8_t& sine = key[at(group.offset)];
  if (leading == last) return sine == 0;
  if (*leading > 0) return true;
  std::for_each(leading, last, [](std::int8_t& multiple) { multiple = static_cast<std::int8_t>(-multiple); });
  if (sine != 0) coefficient = -coefficient;
  return true;
}

bool isIdentity(const AngleGroup& group, const TrigKey& key) {
  const auto first = key.begin() + group.offset;
  return std::all_of(first, first + group.entries(), [](std::int8_t entry) { return entry == 0; });
}

void multiplySingle(const AngleGroup& group, const TrigKey& a, const TrigKey& b, std::vector<Partial>& parts) {
  const std::size_t cosine = at(group.offset);
  const std::size_t sine = cosine + 1;
  const std::int8_t power = exponentSum(a[cosine], b[cosine]);
  const int sines = a[sine] + b[sine];
  const std::size_t count = parts.size();
  for (std::size_t i = 0; i < count; ++i) {
    parts[i].key[cosine] = power;
    parts[i].key[sine] = static_cast<std::int8_t>(sines % 2);
    if (sines < 2) continue;
    Partial other = parts[i];  // sin^2 = 1 - cos^2
    other.key[cosine] = exponentSum(power, 2);
    other.coefficient = -other.coefficient;
    parts.push_back(other);
  }
}

/// Product of two circular functions as half a sum and half a difference.
void multiplySums(const AngleGroup& group, const TrigKey& a, const TrigKey& b, std::vector<Partial>& parts) {
  const bool sine_a = a[at(group.offset)] != 0;
  const bool sine_b = b[at(group.offset)] != 0;
  std::vector<Partial> result;
  for (const Partial& part : parts) {
    for (const int sign : {-1, 1}) {
      Partial next = part;
      next.coefficient = next.coefficient * Rational(1, 2);
      next.key[at(group.offset)] = sine_a != sine_b ? 1 : 0;
      for (int k = 1; k < group.entries(); ++k)
        next.key[at(group.offset + k)] = exponentSum(a[at(group.offset + k)], sign * b[at(group.offset + k)]);
      if ((sine_a && sine_b && sign == 1) || (!sine_a && sine_b && sign == -1)) next.coefficient = -next.coefficient;
      if (normaliseAngle(group, next.key, next.coefficient)) result.push_back(next);
    }
  }
  parts = std::move(result);
}

void multiplyGroup(const AngleGroup& group, const TrigKey& a, const TrigKey& b, std::vector<Partial>& parts) {
  const bool only_a = isIdentity(group, b);
  if (only_a || isIdentity(group, a)) {
    const TrigKey& source = only_a ? a : b;
    for (Partial& part : parts)
      std::copy_n(source.begin() + group.offset, group.entries(), part.key.begin() + group.offset);
  } else if (group.isSingle()) {
    multiplySingle(group, a, b, parts);
  } else {
    multiplySums(group, a, b, parts);
  }
}

void multiplyTerms(const TrigRing& ring, const TrigPolynomial::Terms::value_type& a,
                   const TrigPolynomial::Terms::value_type& b, std::vector<Partial>& parts, TrigPolynomial& result) {
  parts.assign(1, {TrigKey{}, a.second * b.second});
  Partial& first = parts.front();
  for (std::size_t radical = 0; radical < TrigRing::kRadicals; ++radical) {
    const int power = a.first[radical] + b.first[radical];
    first.key[radical] = static_cast<std::int8_t>(power % 2);
    if (power == 2) first.coefficient = first.coefficient * Rational(radical == 0 ? 2 : 3);
  }
  for (std::size_t i = 0; i < ring.scalars().size(); ++i) {
    const std::size_t entry = at(ring.scalarOffset(i));
    first.key[entry] = exponentSum(a.first[entry], b.first[entry]);
  }
  for (const AngleGroup& group : ring.groups()) multiplyGroup(group, a.first, b.first, parts);
  for (const Partial& part : parts) result.add(part.key, part.coefficient);
}

/// cos(steps * 15 degrees).
TrigPolynomial exactCosine(const RingPointer& ring, int steps) {
  const int turned = ((steps % 24) + 24) % 24;
  const int folded = turned > 12 ? 24 - turned : turned;
  if (folded > kQuarter) return -exactCosine(ring, 12 - folded);
  TrigKey key{};
  TrigPolynomial result(ring);
  switch (folded) {
    case 0:
      result.add(key, 1);
      break;
    case 1:  // (sqrt6 + sqrt2) / 4
    case 5:
      key = {1, 1};
      result.add(key, Rational(1, 4));
      key = {1, 0};
      result.add(key, Rational(folded == 1 ? 1 : -1, 4));
      break;
    case 2:
      key = {0, 1};
      result.add(key, Rational(1, 2));
      break;
    case 3:
      key = {1, 0};
      result.add(key, Rational(1, 2));
      break;
    case 4:
      result.add(key, Rational(1, 2));
      break;
    default:
      break;
  }
  return result;
}

TrigPolynomial circular(const RingPointer& ring, const std::vector<std::pair<int, int>>& angle, bool sine) {
  TrigKey key{};
  if (angle.empty()) return sine ? TrigPolynomial(ring) : TrigPolynomial::number(ring, 1);
  const AngleGroup& group = ring->groups()[ring->place(angle.front().first).first];
  if (group.isSingle()) {
    const int times = angle.front().second;
    key[at(group.offset + 1)] = 1;
    const TrigPolynomial s = TrigPolynomial::term(ring, key, times < 0 ? -1 : 1);
    key = {};
    key[at(group.offset)] = 1;
    const TrigPolynomial c = TrigPolynomial::term(ring, key, 1);
    TrigPolynomial sum_s(ring);
    TrigPolynomial sum_c = TrigPolynomial::number(ring, 1);
    for (int k = 0; k < std::abs(times); ++k) {
      const TrigPolynomial next = sum_s * c + sum_c * s;
      sum_c = sum_c * c - sum_s * s;
      sum_s = next;
    }
    return sine ? sum_s : sum_c;
  }
  key[at(group.offset)] = sine ? 1 : 0;
  for (const auto& [symbol, times] : angle) {
    const std::size_t entry = at(group.offset + 1) + ring->place(symbol).second;
    key[entry] = exponentSum(key[entry], times);
  }
  Rational coefficient = 1;
  if (!normaliseAngle(group, key, coefficient)) return TrigPolynomial(ring);
  return TrigPolynomial::term(ring, key, coefficient);
}

double powerOf(double base, int exponent) {
  double result = 1.0;
  for (int i = 0; i < exponent; ++i) result *= base;
  return result;
}

}  // namespace

TrigRing::TrigRing(std::vector<int> scalars, const std::vector<std::vector<int>>& angle_groups, ProgressWatch watch)
    : scalars_(std::move(scalars)), watch_(std::move(watch)) {
  size_ = kRadicals + static_cast<int>(scalars_.size());
  for (const std::vector<int>& angles : angle_groups) {
    groups_.push_back({angles, size_});
    size_ += groups_.back().entries();
  }
  if (size_ > kMaxExponents) throw DerivationStopped("the chain has more lengths and joints than a derivation handles");
}

std::pair<std::size_t, std::size_t> TrigRing::place(int angle) const {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    for (std::size_t k = 0; k < groups_[g].angles.size(); ++k) {
      if (groups_[g].angles[k] == angle) return {g, k};
    }
  }
  throw Exception("an angle that is not one of the expression's");
}

TrigPolynomial TrigPolynomial::term(const RingPointer& ring, const TrigKey& key, const Rational& coefficient) {
  TrigPolynomial result(ring);
  result.add(key, coefficient);
  return result;
}

TrigPolynomial TrigPolynomial::number(const RingPointer& ring, const Rational& value) {
  return term(ring, TrigKey{}, value);
}

TrigPolynomial TrigPolynomial::scalar(const RingPointer& ring, int symbol) {
  const auto& scalars = ring->scalars();
  const auto found = std::find(scalars.begin(), scalars.end(), symbol);
  TrigKey key{};
  key.at(at(ring->scalarOffset(static_cast<std::size_t>(found - scalars.begin())))) = 1;
  return term(ring, key, 1);
}

TrigPolynomial TrigPolynomial::cosine(const RingPointer& ring, const std::vector<std::pair<int, int>>& angle,
                                      int steps) {
  const TrigPolynomial c = circular(ring, angle, false);
  if (steps % 24 == 0) return c;
  return c * exactCosine(ring, steps) - circular(ring, angle, true) * exactCosine(ring, kQuarter - steps);
}

TrigPolynomial TrigPolynomial::sine(const RingPointer& ring, const std::vector<std::pair<int, int>>& angle, int steps) {
  return cosine(ring, angle, steps - kQuarter);
}

void TrigPolynomial::add(const TrigKey& key, const Rational& coefficient) {
  if (coefficient.isZero()) return;
  const auto [entry, fresh] = terms_.try_emplace(key, coefficient);
  if (fresh) return;
  entry->second = entry->second + coefficient;
  if (entry->second.isZero()) terms_.erase(entry);
}

TrigPolynomial& TrigPolynomial::operator+=(const TrigPolynomial& other) {
  for (const auto& [key, coefficient] : other.terms_) add(key, coefficient);
  return *this;
}

TrigPolynomial& TrigPolynomial::operator-=(const TrigPolynomial& other) {
  for (const auto& [key, coefficient] : other.terms_) add(key, -coefficient);
  return *this;
}

TrigPolynomial TrigPolynomial::operator-() const {
  return scaled(-1);
}

TrigPolynomial TrigPolynomial::scaled(const Rational& share) const {
  TrigPolynomial result(ring_);
  for (const auto& [key, coefficient] : terms_) result.add(key, coefficient * share);
  return result;
}

TrigPolynomial operator+(TrigPolynomial a, const TrigPolynomial& b) {
  return a += b;
}

TrigPolynomial operator-(TrigPolynomial a, const TrigPolynomial& b) {
  return a -= b;
}

TrigPolynomial operator*(const TrigPolynomial& a, const TrigPolynomial& b) {
  TrigPolynomial result(a.ring());
  std::vector<Partial> parts;
  std::size_t count = 0;
  for (const auto& term_a : a.terms()) {
    for (const auto& term_b : b.terms()) {
      if (++count % kTermsPerPoll == 0) a.ring()->poll();
      multiplyTerms(*a.ring(), term_a, term_b, parts, result);
    }
  }
  return result;
}

double TrigPolynomial::evaluate(const std::vector<double>& values) const {
  double sum = 0.0;
  for (const auto& [key, coefficient] : terms_) {
    double product = coefficient.value() * (key[0] != 0 ? std::sqrt(2.0) : 1.0) * (key[1] != 0 ? std::sqrt(3.0) : 1.0);
    for (std::size_t i = 0; i < ring_->scalars().size(); ++i)
      product *= powerOf(values[at(ring_->scalars()[i])], key[at(ring_->scalarOffset(i))]);
    for (const AngleGroup& group : ring_->groups()) {
      if (isIdentity(group, key)) continue;
      if (group.isSingle()) {
        const double angle = values[at(group.angles.front())];
        product *=
            powerOf(std::cos(angle), key[at(group.offset)]) * powerOf(std::sin(angle), key[at(group.offset + 1)]);
        continue;
      }
      double angle = 0.0;
      for (std::size_t k = 0; k < group.angles.size(); ++k)
        angle += key[at(group.offset + 1) + k] * values[at(group.angles[k])];
      product *= key[at(group.offset)] != 0 ? std::sin(angle) : std::cos(angle);
    }
    sum += product;
  }
  return sum;
}

TrigPolynomial TrigPolynomial::atAngle(int angle, int steps) const {
  const auto [index, place] = ring_->place(angle);
  const AngleGroup& group = ring_->groups()[index];
  TrigPolynomial result(ring_);
  for (const auto& [key, coefficient] : terms_) {
    TrigKey rest = key;
    std::fill_n(rest.begin() + group.offset, group.entries(), std::int8_t{0});
    TrigPolynomial part = TrigPolynomial::term(ring_, rest, coefficient);
    if (group.isSingle()) {
      for (int k = 0; k < key[at(group.offset)]; ++k) part = part * exactCosine(ring_, steps);
      if (key[at(group.offset + 1)] != 0) part = part * exactCosine(ring_, kQuarter - steps);
    } else {
      std::vector<std::pair<int, int>> others;
      for (std::size_t k = 0; k < group.angles.size(); ++k) {
        const int times = key[at(group.offset + 1) + k];
        if (k != place && times != 0) others.emplace_back(group.angles[k], times);
      }
      const int phase = steps * key[at(group.offset + 1) + place];
      part = part * (key[at(group.offset)] != 0 ? sine(ring_, others, phase) : cosine(ring_, others, phase));
    }
    result += part;
  }
  return result;
}

TrigPolynomial TrigPolynomial::atScalar(int scalar, const TrigPolynomial& value) const {
  const auto& scalars = ring_->scalars();
  const auto index = std::find(scalars.begin(), scalars.end(), scalar) - scalars.begin();
  const std::size_t entry = at(ring_->scalarOffset(static_cast<std::size_t>(index)));
  TrigPolynomial result(ring_);
  for (const auto& [key, coefficient] : terms_) {
    TrigKey rest = key;
    rest[entry] = 0;
    TrigPolynomial part = TrigPolynomial::term(ring_, rest, coefficient);
    for (int k = 0; k < key[entry]; ++k) part = part * value;
    result += part;
  }
  return result;
}

bool TrigPolynomial::dependsOn(int symbol) const {
  const std::vector<int> all = symbols();
  return std::find(all.begin(), all.end(), symbol) != all.end();
}

std::vector<int> TrigPolynomial::symbols() const {
  std::set<int> found;
  for (const auto& [key, coefficient] : terms_) {
    for (std::size_t i = 0; i < ring_->scalars().size(); ++i) {
      if (key[at(ring_->scalarOffset(i))] != 0) found.insert(ring_->scalars()[i]);
    }
    for (const AngleGroup& group : ring_->groups()) {
      if (group.isSingle() && !isIdentity(group, key)) found.insert(group.angles.front());
      for (std::size_t k = 0; !group.isSingle() && k < group.angles.size(); ++k) {
        if (key[at(group.offset + 1) + k] != 0) found.insert(group.angles[k]);
      }
    }
  }
  return {found.begin(), found.end()};
}

}  // namespace screwline
