#include "ginac_bridge.h"

#include <string>

namespace screwline {
namespace {

std::int64_t integerOf(const GiNaC::numeric& number) {
  static const GiNaC::numeric kBound = GiNaC::pow(GiNaC::numeric(2), GiNaC::numeric(62));
  if (!number.is_integer() || GiNaC::abs(number) > kBound)
    throw DerivationStopped("the coefficients of the expressions grow beyond 64 bits");
  return number.to_long();
}

}  // namespace

std::timed_mutex& ginacMutex() {
  static std::timed_mutex mutex;
  return mutex;
}

GinacBridge::GinacBridge(int entries) {
  for (int i = 0; i < entries; ++i) symbols_.emplace_back("x" + std::to_string(i));
}

GiNaC::ex GinacBridge::expression(const TrigPolynomial::Terms& terms) const {
  GiNaC::exvector sum;
  for (const auto& [key, coefficient] : terms) {
    GiNaC::exvector product = {
        GiNaC::numeric(static_cast<long>(coefficient.numerator()), static_cast<long>(coefficient.denominator()))};
    for (std::size_t i = 0; i < symbols_.size(); ++i) {
      if (key[i] != 0) product.push_back(GiNaC::pow(symbols_[i], static_cast<int>(key[i])));
    }
    sum.push_back(GiNaC::mul(product));
  }
  return GiNaC::add(sum);
}

void GinacBridge::readFactor(const GiNaC::ex& factor, TrigKey& key, Rational& coefficient) const {
  if (GiNaC::is_a<GiNaC::mul>(factor)) {
    for (const GiNaC::ex& part : factor) readFactor(part, key, coefficient);
    return;
  }
  if (GiNaC::is_a<GiNaC::numeric>(factor)) {
    const GiNaC::numeric& number = GiNaC::ex_to<GiNaC::numeric>(factor);
    coefficient = coefficient * Rational(integerOf(number.numer()), integerOf(number.denom()));
    return;
  }
  const bool power = GiNaC::is_a<GiNaC::power>(factor);
  const GiNaC::ex base = power ? factor.op(0) : factor;
  const std::int64_t exponent = power ? integerOf(GiNaC::ex_to<GiNaC::numeric>(factor.op(1))) : 1;
  for (std::size_t i = 0; i < symbols_.size(); ++i) {
    if (base.is_equal(symbols_[i])) key[i] = static_cast<std::int8_t>(key[i] + exponent);
  }
}

TrigPolynomial::Terms GinacBridge::terms(const GiNaC::ex& expression) const {
  const GiNaC::ex expanded = expression.expand();
  TrigPolynomial::Terms result;
  const auto take = [&](const GiNaC::ex& term) {
    TrigKey key{};
    Rational coefficient = 1;
    readFactor(term, key, coefficient);
    if (!coefficient.isZero()) result.emplace(key, coefficient);
  };
  if (GiNaC::is_a<GiNaC::add>(expanded)) {
    for (const GiNaC::ex& term : expanded) take(term);
  } else {
    take(expanded);
  }
  return result;
}

std::vector<std::pair<GiNaC::ex, int>> ginacFactors(const GiNaC::ex& polynomial) {
  const GiNaC::ex product = GiNaC::factor(polynomial);
  std::vector<std::pair<GiNaC::ex, int>> factors;
  const auto take = [&factors](const GiNaC::ex& factor) {
    if (GiNaC::is_a<GiNaC::numeric>(factor)) return;
    if (GiNaC::is_a<GiNaC::power>(factor)) {
      factors.emplace_back(factor.op(0), GiNaC::ex_to<GiNaC::numeric>(factor.op(1)).to_int());
    } else {
      factors.emplace_back(factor, 1);
    }
  };
  if (GiNaC::is_a<GiNaC::mul>(product)) {
    for (const GiNaC::ex& factor : product) take(factor);
  } else {
    take(product);
  }
  return factors;
}

}  // namespace screwline
