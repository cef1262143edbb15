#ifndef SCREWLINE_SRC_SYMBOLIC_RATIONAL_H
#define SCREWLINE_SRC_SYMBOLIC_RATIONAL_H

#include <cstdint>
#include <numeric>

#include "screwline/symbolic/progress.h"

namespace screwline {

/// An exact fraction of 64-bit integers, lowest terms, denominator positive. Coefficients of kinematics are small; one
/// that does not fit ends the derivation (DerivationStopped) instead of becoming wrong.
class Rational {
 public:
  constexpr Rational(std::int64_t numerator = 0) : numerator_(numerator) {}  // NOLINT: numbers are fractions
  Rational(std::int64_t numerator, std::int64_t denominator) : numerator_(numerator), denominator_(denominator) {
    reduce();
  }

  std::int64_t numerator() const { return numerator_; }
  std::int64_t denominator() const { return denominator_; }
  bool isZero() const { return numerator_ == 0; }
  double value() const { return static_cast<double>(numerator_) / static_cast<double>(denominator_); }

  Rational operator-() const {
    Rational result = *this;
    result.numerator_ = times(numerator_, -1);
    return result;
  }
  friend Rational operator*(const Rational& a, const Rational& b) {
    if (a.denominator_ == 1 && b.denominator_ == 1) return Rational(times(a.numerator_, b.numerator_));
    const Rational cross1(a.numerator_, b.denominator_);
    const Rational cross2(b.numerator_, a.denominator_);
    Rational result;
    result.numerator_ = times(cross1.numerator_, cross2.numerator_);
    result.denominator_ = times(cross1.denominator_, cross2.denominator_);
    return result;
  }
  /// @pre b is not zero.
  friend Rational operator/(const Rational& a, const Rational& b) { return a * Rational(b.denominator_, b.numerator_); }
  friend Rational operator+(const Rational& a, const Rational& b) {
    if (a.denominator_ == b.denominator_) return Rational(plus(a.numerator_, b.numerator_), a.denominator_);
    return Rational(plus(times(a.numerator_, b.denominator_), times(b.numerator_, a.denominator_)),
                    times(a.denominator_, b.denominator_));
  }
  friend Rational operator-(const Rational& a, const Rational& b) { return a + (-b); }
  friend bool operator==(const Rational& a, const Rational& b) {
    return a.numerator_ == b.numerator_ && a.denominator_ == b.denominator_;
  }
  friend bool operator!=(const Rational& a, const Rational& b) { return !(a == b); }
  friend bool operator<(const Rational& a, const Rational& b) {
    return times(a.numerator_, b.denominator_) < times(b.numerator_, a.denominator_);
  }

 private:
  static std::int64_t times(std::int64_t a, std::int64_t b) {
    std::int64_t result = 0;
    if (__builtin_mul_overflow(a, b, &result)) overflow();
    return result;
  }
  static std::int64_t plus(std::int64_t a, std::int64_t b) {
    std::int64_t result = 0;
    if (__builtin_add_overflow(a, b, &result)) overflow();
    return result;
  }
  [[noreturn]] static void overflow() {
    throw DerivationStopped("the coefficients of the expressions grow beyond 64 bits");
  }
  void reduce() {
    if (denominator_ == 1) return;
    const std::int64_t divisor = std::gcd(numerator_, denominator_);
    const std::int64_t sign = denominator_ < 0 ? -1 : 1;
    numerator_ = times(numerator_ / divisor, sign);
    denominator_ = times(denominator_ / divisor, sign);
  }

  std::int64_t numerator_ = 0;
  std::int64_t denominator_ = 1;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_RATIONAL_H
