#include "half_angle.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>

namespace screwline {
namespace {

using Terms = TrigPolynomial::Terms;

std::size_t at(int entry) {
  return static_cast<std::size_t>(entry);
}

void addTo(Terms& terms, const TrigKey& key, const Rational& coefficient) {
  if (coefficient.isZero()) return;
  const auto [entry, fresh] = terms.try_emplace(key, coefficient);
  if (fresh) return;
  entry->second = entry->second + coefficient;
  if (entry->second.isZero()) terms.erase(entry);
}

/// A polynomial in u with v = 1: coefficients by exponent.
using Univariate = std::vector<Rational>;

Univariate times(const Univariate& a, const Univariate& b) {
  Univariate result(a.size() + b.size() - 1, Rational(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] = result[i + j] + a[i] * b[j];
  }
  return result;
}

Univariate powerOf(const Univariate& base, int exponent) {
  Univariate result = {1};
  for (int i = 0; i < exponent; ++i) result = times(result, base);
  return result;
}

const Univariate kSine = {0, 2};
const Univariate kCosine = {1, 0, -1};
const Univariate kOne = {1, 0, 1};

/// Real and imaginary part of (1 + i u)^(2 |multiple|), conjugate where the multiple is negative: cos and sin of it.
std::pair<Univariate, Univariate> circularOf(int multiple) {
  Univariate c = {1};
  Univariate s = {0};
  for (int k = 0; k < std::abs(multiple); ++k) {
    const Univariate cc = times(c, kCosine);
    const Univariate ss = times(s, kSine);
    const Univariate cs = times(c, kSine);
    const Univariate sc = times(s, kCosine);
    c.assign(std::max(cc.size(), ss.size()), Rational(0));
    s.assign(std::max(cs.size(), sc.size()), Rational(0));
    for (std::size_t i = 0; i < cc.size(); ++i) c[i] = c[i] + cc[i];
    for (std::size_t i = 0; i < ss.size(); ++i) c[i] = c[i] - ss[i];
    for (std::size_t i = 0; i < cs.size(); ++i) s[i] = s[i] + cs[i];
    for (std::size_t i = 0; i < sc.size(); ++i) s[i] = s[i] + sc[i];
  }
  if (multiple < 0) {
    for (Rational& coefficient : s) coefficient = -coefficient;
  }
  return {c, s};
}

/// Terms of the angles of one group, by the u of those angles.
using Factor = std::map<TrigKey, Rational>;

void multiplyBy(Factor& factor, std::size_t entry, const Univariate& polynomial) {
  Factor result;
  for (const auto& [key, coefficient] : factor) {
    for (std::size_t i = 0; i < polynomial.size(); ++i) {
      TrigKey next = key;
      next[entry] = static_cast<std::int8_t>(next[entry] + static_cast<int>(i));
      addTo(result, next, coefficient * polynomial[i]);
    }
  }
  factor = std::move(result);
}

class Converter {
 public:
  explicit Converter(const TrigPolynomial& polynomial) : ring_(*polynomial.ring()), source_(polynomial) {
    for (const AngleGroup& group : ring_.groups()) {
      for (std::size_t k = 0; k < group.angles.size(); ++k) addAngle(group, k);
    }
    if (at(ring_.scalarOffset(ring_.scalars().size())) + result_.angles.size() > kMaxExponents)
      throw DerivationStopped("the chain has more lengths and joints than a derivation handles");
  }

  /// None as soon as there are more than `most_terms`.
  std::optional<HalfAnglePolynomial> convert(std::size_t most_terms) {
    const std::size_t scalars = at(ring_.scalarOffset(ring_.scalars().size()));
    for (const auto& [key, coefficient] : source_.terms()) {
      TrigKey start{};
      std::copy_n(key.begin(), scalars, start.begin());
      Factor product = {{start, coefficient}};
      for (const AngleGroup& group : ring_.groups()) {
        multiplyGroup(group, key, product);
        if (product.size() > most_terms) return std::nullopt;
      }
      for (const auto& [u_key, u_coefficient] : product) addTo(result_.terms, u_key, u_coefficient);
      if (result_.terms.size() > most_terms) return std::nullopt;
      ring_.poll();
    }
    return std::move(result_);
  }

 private:
  void addAngle(const AngleGroup& group, std::size_t k) {
    int degree = 0;
    for (const auto& term : source_.terms()) degree = std::max(degree, degreeOf(group, k, term.first));
    if (degree == 0) return;
    result_.angles.push_back(group.angles[k]);
    result_.degrees.push_back(2 * degree);
  }

  static int degreeOf(const AngleGroup& group, std::size_t k, const TrigKey& key) {
    if (group.isSingle()) return key[at(group.offset)] + key[at(group.offset + 1)];
    return std::abs(static_cast<int>(key[at(group.offset + 1) + k]));
  }

  void multiplyGroup(const AngleGroup& group, const TrigKey& key, Factor& product) const {
    if (group.isSingle()) {
      const auto index = find(group.angles.front());
      if (index < 0) return;
      const std::size_t entry = result_.entry(ring_, at(index));
      const int missing = result_.degrees[at(index)] / 2 - degreeOf(group, 0, key);
      multiplyBy(product, entry, times(powerOf(kCosine, key[at(group.offset)]), powerOf(kOne, missing)));
      if (key[at(group.offset + 1)] != 0) multiplyBy(product, entry, kSine);
      return;
    }
    // cos and sin of the sum of the angles so far, each a polynomial in the u.
    Factor cosine = {{TrigKey{}, Rational(1)}};
    Factor sine;
    for (std::size_t k = 0; k < group.angles.size(); ++k) {
      const auto index = find(group.angles[k]);
      if (index < 0) continue;
      addToAngle(result_.entry(ring_, at(index)), key[at(group.offset + 1) + k], result_.degrees[at(index)] / 2, cosine,
                 sine);
    }
    const Factor& wanted = key[at(group.offset)] != 0 ? sine : cosine;
    Factor result;
    for (const auto& [key_a, a] : product) {
      for (const auto& [key_b, b] : wanted) {
        TrigKey sum = key_a;
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = static_cast<std::int8_t>(sum[i] + key_b[i]);
        addTo(result, sum, a * b);
      }
    }
    product = std::move(result);
  }

  static void addToAngle(std::size_t entry, int multiple, int degree, Factor& cosine, Factor& sine) {
    const auto [c, s] = circularOf(multiple);
    const Univariate one = powerOf(kOne, degree - std::abs(multiple));
    const auto part = [entry, &one](const Factor& factor, const Univariate& polynomial) {
      Factor result = factor;
      multiplyBy(result, entry, times(polynomial, one));
      return result;
    };
    Factor next_cosine = part(cosine, c);
    for (const auto& [key, coefficient] : part(sine, s)) addTo(next_cosine, key, -coefficient);
    Factor next_sine = part(cosine, s);
    for (const auto& [key, coefficient] : part(sine, c)) addTo(next_sine, key, coefficient);
    cosine = std::move(next_cosine);
    sine = std::move(next_sine);
  }

  int find(int angle) const {
    const auto found = std::find(result_.angles.begin(), result_.angles.end(), angle);
    return found == result_.angles.end() ? -1 : static_cast<int>(found - result_.angles.begin());
  }

  const TrigRing& ring_;
  const TrigPolynomial& source_;
  HalfAnglePolynomial result_;
};

}  // namespace

HalfAnglePolynomial toHalfAngles(const TrigPolynomial& polynomial) {
  return *Converter(polynomial).convert(std::numeric_limits<std::size_t>::max());
}

bool isShortInHalfAngles(const TrigPolynomial& polynomial, std::size_t most_terms) {
  return Converter(polynomial).convert(most_terms).has_value();
}

TrigPolynomial fromHalfAngles(const RingPointer& ring, const HalfAnglePolynomial& polynomial) {
  // u^e v^(d - e) of each angle in sines and cosines: u^2 = (1 - cos) / 2, v^2 = (1 + cos) / 2, u v = sin / 2.
  std::vector<std::vector<TrigPolynomial>> powers;
  const TrigPolynomial one = TrigPolynomial::number(ring, 1);
  for (std::size_t k = 0; k < polynomial.angles.size(); ++k) {
    const std::vector<std::pair<int, int>> angle = {{polynomial.angles[k], 1}};
    const TrigPolynomial c = TrigPolynomial::cosine(ring, angle);
    const TrigPolynomial half_s = TrigPolynomial::sine(ring, angle).scaled(Rational(1, 2));
    const TrigPolynomial uu = (one - c).scaled(Rational(1, 2));
    const TrigPolynomial vv = (one + c).scaled(Rational(1, 2));
    powers.emplace_back();
    for (int e = 0; e <= polynomial.degrees[k]; ++e) {
      TrigPolynomial power = e % 2 != 0 ? half_s : one;
      for (int i = 0; i < e / 2; ++i) power = power * uu;
      for (int i = 0; i < (polynomial.degrees[k] - e) / 2; ++i) power = power * vv;
      powers.back().push_back(power);
    }
  }
  TrigPolynomial result(ring);
  for (const auto& [key, coefficient] : polynomial.terms) {
    TrigKey scalars = key;
    for (std::size_t k = 0; k < polynomial.angles.size(); ++k) scalars[polynomial.entry(*ring, k)] = 0;
    TrigPolynomial product = TrigPolynomial::term(ring, scalars, coefficient);
    for (std::size_t k = 0; k < polynomial.angles.size(); ++k)
      product = product * powers[k][at(key[polynomial.entry(*ring, k)])];
    result += product;
  }
  return result;
}

}  // namespace screwline
