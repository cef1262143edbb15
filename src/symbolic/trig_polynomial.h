#ifndef SCREWLINE_SRC_SYMBOLIC_TRIG_POLYNOMIAL_H
#define SCREWLINE_SRC_SYMBOLIC_TRIG_POLYNOMIAL_H

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "rational.h"
#include "screwline/symbolic/progress.h"
#include "screwline/symbolic/symbol_table.h"

namespace screwline {

constexpr int kMaxExponents = 128;  ///< Seven joints of any geometry with their inverse formulas take up to 120.

/// Exponents of a term, laid out by its TrigRing.
using TrigKey = std::array<std::int8_t, kMaxExponents>;

/// Angles whose sums occur: the joints about parallel neighbouring axes. One angle alone has its sine and cosine as
/// powers; of several, sin and cos of sums.
struct AngleGroup {
  std::vector<int> angles;  ///< Symbol numbers.
  int offset = 0;           ///< Of its entries in a key.
  bool isSingle() const { return angles.size() == 1; }
  int entries() const { return isSingle() ? 2 : 1 + static_cast<int>(angles.size()); }
};

/// What expressions of one derivation are polynomials in: sqrt 2 and sqrt 3 (entries 0 and 1 of a key), scalars
/// (exponents), sines and cosines of angles in groups. A single angle has the entries [power of cos, 0 or 1 sines]; a
/// group [0 for cos, 1 for sin; multiples of its angles], the first multiple that is not 0 positive.
class TrigRing {
 public:
  /// @throws DerivationStopped where a term would need more than kMaxExponents entries.
  TrigRing(std::vector<int> scalars, const std::vector<std::vector<int>>& angle_groups, ProgressWatch watch);

  static constexpr int kRadicals = 2;
  const std::vector<int>& scalars() const { return scalars_; }
  int scalarOffset(std::size_t i) const { return kRadicals + static_cast<int>(i); }
  const std::vector<AngleGroup>& groups() const { return groups_; }
  int size() const { return size_; }
  /// The group and place in it of an angle. @pre it is one of the ring.
  std::pair<std::size_t, std::size_t> place(int angle) const;
  void poll() const { watch_.poll(); }
  const ProgressWatch& watch() const { return watch_; }

 private:
  std::vector<int> scalars_;
  std::vector<AngleGroup> groups_;
  int size_ = 0;
  ProgressWatch watch_;
};

using RingPointer = std::shared_ptr<const TrigRing>;

/// A polynomial of a TrigRing in its canonical form: two are the same function of the angles, scalars and radicals
/// exactly where their terms are the same. Belongs to one thread.
class TrigPolynomial {
 public:
  using Terms = std::map<TrigKey, Rational>;

  explicit TrigPolynomial(RingPointer ring) : ring_(std::move(ring)) {}
  static TrigPolynomial number(const RingPointer& ring, const Rational& value);
  static TrigPolynomial scalar(const RingPointer& ring, int symbol);
  /// sin or cos of sum times[k] * angle[k] + steps * 15 degrees. @pre the angles belong to one group.
  static TrigPolynomial sine(const RingPointer& ring, const std::vector<std::pair<int, int>>& angle, int steps = 0);
  static TrigPolynomial cosine(const RingPointer& ring, const std::vector<std::pair<int, int>>& angle, int steps = 0);
  static TrigPolynomial term(const RingPointer& ring, const TrigKey& key, const Rational& coefficient);

  const RingPointer& ring() const { return ring_; }
  const Terms& terms() const { return terms_; }
  bool isZero() const { return terms_.empty(); }
  bool isNumber() const { return terms_.empty() || (terms_.size() == 1 && terms_.begin()->first == TrigKey{}); }

  void add(const TrigKey& key, const Rational& coefficient);
  TrigPolynomial& operator+=(const TrigPolynomial& other);
  TrigPolynomial& operator-=(const TrigPolynomial& other);
  TrigPolynomial operator-() const;
  TrigPolynomial scaled(const Rational& share) const;
  bool operator==(const TrigPolynomial& other) const { return terms_ == other.terms_; }

  /// Value with the symbols' values by number.
  double evaluate(const std::vector<double>& values) const;
  /// The same with angle = steps * 15 degrees.
  TrigPolynomial atAngle(int angle, int steps) const;
  /// The same with the scalar replaced by another polynomial.
  TrigPolynomial atScalar(int scalar, const TrigPolynomial& value) const;
  bool dependsOn(int symbol) const;
  /// Symbols that occur, ascending.
  std::vector<int> symbols() const;

 private:
  RingPointer ring_;
  Terms terms_;
};

TrigPolynomial operator+(TrigPolynomial a, const TrigPolynomial& b);
TrigPolynomial operator-(TrigPolynomial a, const TrigPolynomial& b);
TrigPolynomial operator*(const TrigPolynomial& a, const TrigPolynomial& b);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_TRIG_POLYNOMIAL_H
