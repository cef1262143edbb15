#include "factoring.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include "ginac_bridge.h"
#include "half_angle.h"
#include "irreducible.h"
#include "readable.h"

namespace screwline {
namespace {

using GiNaC::ex;
using Terms = TrigPolynomial::Terms;

constexpr std::chrono::milliseconds kLockPoll{10};
constexpr std::size_t kLargestFactored = 600;  ///< Terms that factor() is given; its time has no bound.

std::size_t at(int entry) {
  return static_cast<std::size_t>(entry);
}

/// A factor over half angles of one angle: in u, of homogeneous degree `degree`.
struct HalfAnglePiece {
  ex polynomial;
  int degree = 0;
  int multiplicity = 1;
};

class Factoring {
 public:
  Factoring(const TrigPolynomial& polynomial, const SymbolTable& symbols)
      : ring_(polynomial.ring()),
        symbols_(symbols),
        whole_(polynomial),
        bridge_(std::min(kMaxExponents, ring_->scalarOffset(ring_->scalars().size()) + angleCount())) {}

  FactoredPolynomial run() {
    Terms rest = whole_.terms();
    TrigKey common = takeCommonFactor(*ring_, rest).first;
    addMonomial(common);
    rest_ = toHalfAngles(polynomialOf(rest));
    for (std::size_t k = 0; k < rest_.angles.size(); ++k) splitAngle(k);
    for (std::size_t i = 0; i < ring_->scalars().size(); ++i) {
      if (kindOf(i) == SymbolKind::kSlide) splitScalars([i](std::size_t scalar) { return scalar == i; });
    }
    splitScalars([](std::size_t) { return false; });
    splitRest();
    return assembled(common);
  }

 private:
  SymbolKind kindOf(std::size_t scalar) const { return symbols_[ring_->scalars()[scalar]].kind; }
  int angleCount() const {
    std::size_t count = 0;
    for (const AngleGroup& group : ring_->groups()) count += group.angles.size();
    return static_cast<int>(count);
  }
  std::size_t scalarEntries() const { return at(ring_->scalarOffset(ring_->scalars().size())); }

  TrigPolynomial polynomialOf(const Terms& terms) const {
    TrigPolynomial result(ring_);
    for (const auto& [key, coefficient] : terms) {
      TrigPolynomial part = TrigPolynomial::number(ring_, coefficient);
      TrigKey plain = key;
      for (const std::size_t radical : {0, 1}) {
        plain[radical] = static_cast<std::int8_t>(key[radical] % 2);
        for (int i = 0; i < key[radical] / 2; ++i) part = part.scaled(radical == 0 ? 2 : 3);
      }
      result += TrigPolynomial::term(ring_, plain, 1) * part;
    }
    return result;
  }

  /// The polynomial divided by its numbers, most terms positive.
  static TrigPolynomial primitive(const TrigPolynomial& polynomial) {
    std::int64_t top = 0;
    std::int64_t bottom = 1;
    int positive = 0;
    for (const auto& term : polynomial.terms()) {
      top = std::gcd(top, term.second.numerator());
      bottom = std::lcm(bottom, term.second.denominator());
      positive += term.second.numerator() > 0 ? 1 : -1;
    }
    const bool flip = positive < 0 || (positive == 0 && polynomial.terms().rbegin()->second < Rational(0));
    return polynomial.scaled(Rational(flip ? -bottom : bottom, top));
  }

  void add(const TrigPolynomial& base, int multiplicity) {
    if (base.isNumber()) return;
    const TrigPolynomial clean = primitive(base);
    const auto same = std::find_if(factors_.begin(), factors_.end(),
                                   [&clean](const PolynomialFactor& factor) { return factor.base == clean; });
    if (same != factors_.end()) {
      same->multiplicity += multiplicity;
    } else {
      factors_.push_back({clean, multiplicity});
    }
  }

  void addMonomial(const TrigKey& key) {
    for (std::size_t i = 0; i < ring_->scalars().size(); ++i) {
      const int power = key[at(ring_->scalarOffset(i))];
      if (power > 0) add(TrigPolynomial::scalar(ring_, ring_->scalars()[i]), power);
    }
    for (const AngleGroup& group : ring_->groups()) {
      TrigKey part{};
      if (!group.isSingle()) {
        std::copy_n(key.begin() + group.offset, group.entries(), part.begin() + group.offset);
        if (part != TrigKey{}) add(TrigPolynomial::term(ring_, part, 1), 1);
        continue;
      }
      for (const int entry : {group.offset, group.offset + 1}) {
        part = {};
        part[at(entry)] = 1;
        if (key[at(entry)] > 0) add(TrigPolynomial::term(ring_, part, 1), key[at(entry)]);
      }
    }
  }

  /// rest_ as a polynomial in the entries for which `inside` is false, its coefficients those in the others.
  std::map<TrigKey, ex> coefficients(const std::function<bool(std::size_t)>& inside) const {
    std::map<TrigKey, Terms> by_outside;
    for (const auto& [key, coefficient] : rest_.terms) {
      TrigKey in{};
      TrigKey out{};
      for (std::size_t i = 0; i < key.size(); ++i) (inside(i) ? in : out)[i] = key[i];
      by_outside[out].emplace(in, coefficient);
    }
    std::map<TrigKey, ex> result;
    for (const auto& [out, terms] : by_outside) result.emplace(out, bridge_.expression(terms));
    return result;
  }

  /// Greatest common divisor of the coefficients; 1 as soon as it does not contain `needed`.
  ex commonDivisor(const std::map<TrigKey, ex>& coefficients, const std::optional<GiNaC::symbol>& needed) const {
    std::vector<ex> sorted;
    for (const auto& coefficient : coefficients) sorted.push_back(coefficient.second);
    std::stable_sort(sorted.begin(), sorted.end(), [](const ex& a, const ex& b) { return a.nops() < b.nops(); });
    ex divisor = sorted.front();
    for (const ex& coefficient : sorted) {
      divisor = GiNaC::gcd(divisor, coefficient);
      ring_->poll();
      if (needed ? !divisor.has(*needed) : GiNaC::is_a<GiNaC::numeric>(divisor)) return 1;
    }
    return divisor;
  }

  void divideBy(const std::map<TrigKey, ex>& coefficients, const ex& divisor) {
    Terms result;
    for (const auto& [out, coefficient] : coefficients) {
      ex quotient;
      if (!GiNaC::divide(coefficient, divisor, quotient)) throw Exception("a common divisor does not divide");
      for (const auto& [in, number] : bridge_.terms(quotient)) {
        TrigKey key = out;
        for (std::size_t i = 0; i < key.size(); ++i) key[i] = static_cast<std::int8_t>(key[i] + in[i]);
        result.emplace(key, number);
      }
    }
    rest_.terms = std::move(result);
  }

  /// Splits off what depends on angle k (and lengths) alone.
  void splitAngle(std::size_t k) {
    const std::size_t entry = rest_.entry(*ring_, k);
    const GiNaC::symbol u = bridge_.symbol(entry);
    const auto inside = coefficients([&](std::size_t i) {
      return i == entry || i < at(TrigRing::kRadicals) || (i < scalarEntries() && !isSlideEntry(i));
    });
    ex divisor = commonDivisor(inside, u);
    if (divisor.has(u)) divisor = divisor.primpart(u);
    int top = 0;
    for (const auto& term : rest_.terms) top = std::max(top, static_cast<int>(term.first[entry]));
    std::vector<HalfAnglePiece> pieces;
    if (rest_.degrees[k] > top) pieces.push_back({ex(1), 1, rest_.degrees[k] - top});  // v
    if (divisor.has(u)) {
      for (const auto& [factor, multiplicity] : ginacFactors(divisor)) {
        if (factor.has(u)) pieces.push_back({factor, factor.degree(u), multiplicity});
      }
    }
    ex used = 1;
    for (const HalfAnglePiece& piece : paired(pieces, u)) {
      used *= GiNaC::pow(piece.polynomial, piece.multiplicity);
      rest_.degrees[k] -= piece.degree * piece.multiplicity;
      add(angleFactor(piece, k), piece.multiplicity);
    }
    divideBy(inside, used.expand());
  }

  std::vector<bool> jointEntries() const {
    std::vector<bool> result(scalarEntries() + rest_.angles.size(), true);
    for (std::size_t i = 0; i < scalarEntries(); ++i) result[i] = i >= at(TrigRing::kRadicals) && isSlideEntry(i);
    return result;
  }

  bool isSlideEntry(std::size_t entry) const { return kindOf(entry - at(TrigRing::kRadicals)) == SymbolKind::kSlide; }

  TrigPolynomial angleFactor(const HalfAnglePiece& piece, std::size_t k) const {
    HalfAnglePolynomial half{{rest_.angles[k]}, {piece.degree}, {}};
    const std::size_t from = rest_.entry(*ring_, k);
    const std::size_t to = half.entry(*ring_, 0);
    for (const auto& [source, coefficient] : bridge_.terms(piece.polynomial)) {
      TrigKey key = source;
      std::swap(key[from], key[to]);
      half.terms.emplace(key, coefficient);
    }
    return polynomialOf(fromHalfAngles(ring_, half).terms());
  }

  /// Pieces of even degree: u with v is the sine, u - v with u + v the cosine, equal ones 1 - cos and the like, others
  /// in turn. One of odd degree may be left over: it is left in the rest.
  static std::vector<HalfAnglePiece> paired(std::vector<HalfAnglePiece> pieces, const ex& u) {
    std::vector<HalfAnglePiece> result;
    const auto pair = [&](HalfAnglePiece& a, HalfAnglePiece& b, int times) {
      if (times == 0) return;
      result.push_back({(a.polynomial * b.polynomial).expand(), a.degree + b.degree, times});
      a.multiplicity -= times;
      b.multiplicity -= times;
    };
    std::vector<HalfAnglePiece> odd;
    for (const HalfAnglePiece& piece : pieces) (piece.degree % 2 != 0 ? odd : result).push_back(piece);
    const std::vector<std::pair<ex, ex>> partners = {{u, ex(1)}, {u - 1, u + 1}};
    for (const auto& [first, second] : partners) {
      const auto isLike = [](const ex& wanted) {
        return [wanted](const HalfAnglePiece& p) {
          return (p.polynomial - wanted).expand().is_zero() || (p.polynomial + wanted).expand().is_zero();
        };
      };
      const auto a = std::find_if(odd.begin(), odd.end(), isLike(first));
      const auto b = std::find_if(odd.begin(), odd.end(), isLike(second));
      if (a != odd.end() && b != odd.end()) pair(*a, *b, std::min(a->multiplicity, b->multiplicity));
    }
    for (HalfAnglePiece& piece : odd) {
      const int twice = piece.multiplicity / 2;
      if (twice == 0) continue;
      result.push_back({GiNaC::pow(piece.polynomial, 2).expand(), 2 * piece.degree, twice});
      piece.multiplicity -= 2 * twice;
    }
    odd.erase(std::remove_if(odd.begin(), odd.end(), [](const HalfAnglePiece& p) { return p.multiplicity == 0; }),
              odd.end());
    for (std::size_t i = 0; i + 1 < odd.size(); i += 2) pair(odd[i], odd[i + 1], 1);
    return result;
  }

  /// Splits off what depends on the given scalars, and lengths, alone.
  void splitScalars(const std::function<bool(std::size_t)>& given) {
    std::optional<GiNaC::symbol> needed;
    for (std::size_t i = 0; i < ring_->scalars().size(); ++i) {
      if (given(i)) needed = bridge_.symbol(at(ring_->scalarOffset(i)));
    }
    const auto inside = coefficients([&](std::size_t i) {
      if (i >= scalarEntries()) return false;
      return i < at(TrigRing::kRadicals) || !isSlideEntry(i) || given(i - at(TrigRing::kRadicals));
    });
    ex divisor = commonDivisor(inside, needed);
    if (GiNaC::is_a<GiNaC::numeric>(divisor)) return;
    if (needed) divisor = divisor.primpart(*needed);
    for (const auto& [factor, multiplicity] : ginacFactors(divisor))
      add(polynomialOf(bridge_.terms(factor)), multiplicity);
    divideBy(inside, divisor);
  }

  /// What is left, in joint factors of several angles; those of odd degree in an angle stay together.
  void splitRest() {
    if (rest_.terms.size() == 1 && rest_.angles.empty()) return;
    HalfAnglePolynomial together = rest_;
    together.terms = {{TrigKey{}, Rational(1)}};
    std::fill(together.degrees.begin(), together.degrees.end(), 0);
    bool merged = false;
    ex product = 1;
    std::vector<std::pair<ex, int>> pieces = {{bridge_.expression(rest_.terms), 1}};
    if (rest_.terms.size() <= kLargestFactored && !isProvedIrreducible(*ring_, rest_.terms, jointEntries()))
      pieces = ginacFactors(pieces.front().first);
    for (const auto& [factor, multiplicity] : pieces) {
      HalfAnglePolynomial part = rest_;
      part.terms = bridge_.terms(factor);
      bool even = true;
      for (std::size_t k = 0; k < part.angles.size(); ++k) {
        part.degrees[k] = factor.degree(bridge_.symbol(rest_.entry(*ring_, k)));
        even = even && part.degrees[k] % 2 == 0;
      }
      if (even) {
        add(polynomialOf(fromHalfAngles(ring_, part).terms()), multiplicity);
        continue;
      }
      merged = true;
      product *= GiNaC::pow(factor, multiplicity);
      for (std::size_t k = 0; k < part.angles.size(); ++k) together.degrees[k] += part.degrees[k] * multiplicity;
    }
    if (!merged) return;
    together.terms = bridge_.terms(product);
    add(polynomialOf(fromHalfAngles(ring_, together).terms()), 1);
  }

  FactoredPolynomial assembled(const TrigKey& common) const {
    TrigKey radicals{};
    std::copy_n(common.begin(), TrigRing::kRadicals, radicals.begin());
    const TrigPolynomial root = TrigPolynomial::term(ring_, radicals, 1);
    TrigPolynomial product = root;
    for (const PolynomialFactor& factor : factors_) {
      for (int i = 0; i < factor.multiplicity; ++i) product = product * factor.base;
    }
    const auto& [key, number] = *product.terms().begin();
    const auto original = whole_.terms().find(key);
    if (original != whole_.terms().end()) {
      const Rational share = original->second / number;
      if (product.scaled(share) == whole_) return {root.scaled(share), sorted(factors_)};
    }
    const TrigPolynomial whole = primitive(whole_);
    const Rational share = whole_.terms().begin()->second / whole.terms().begin()->second;
    return {TrigPolynomial::number(ring_, share), {{whole, 1}}};
  }

  /// Lengths, then slides, then single joints, then several; by symbol within each.
  std::vector<PolynomialFactor> sorted(std::vector<PolynomialFactor> factors) const {
    const auto rank = [this](const PolynomialFactor& factor) {
      std::vector<int> joints;
      bool slides = false;
      for (const int id : factor.base.symbols()) {
        const SymbolKind kind = symbols_[id].kind;
        if (kind == SymbolKind::kAngle || kind == SymbolKind::kSlide) joints.push_back(id);
        if (kind == SymbolKind::kSlide) slides = true;
      }
      const int group = joints.empty() ? 0 : joints.size() > 1 ? 3 : slides ? 1 : 2;
      joints.insert(joints.begin(), group);
      return joints;
    };
    std::stable_sort(factors.begin(), factors.end(), [&](const PolynomialFactor& a, const PolynomialFactor& b) {
      const auto rank_a = rank(a);
      const auto rank_b = rank(b);
      return rank_a != rank_b ? rank_a < rank_b : b.base.terms() < a.base.terms();
    });
    return factors;
  }

  RingPointer ring_;
  const SymbolTable& symbols_;
  const TrigPolynomial& whole_;
  GinacBridge bridge_;
  HalfAnglePolynomial rest_;
  std::vector<PolynomialFactor> factors_;
};

}  // namespace

FactoredPolynomial factored(const TrigPolynomial& polynomial, const SymbolTable& symbols) {
  std::unique_lock<std::timed_mutex> lock(ginacMutex(), std::defer_lock);
  while (!lock.try_lock_for(kLockPoll)) polynomial.ring()->poll();  // Who waits can be cancelled.
  return Factoring(polynomial, symbols).run();
}

}  // namespace screwline
