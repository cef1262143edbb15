#include "irreducible.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "ginac_bridge.h"

namespace screwline {
namespace {

using Terms = TrigPolynomial::Terms;
using GiNaC::numeric;

constexpr int kLines = 2;
constexpr std::uint32_t kLargestNumber = 29;
constexpr int kTermsPerPoll = 32;

/// Coefficients of the powers of t.
using OnLine = std::vector<numeric>;

OnLine product(const OnLine& a, const OnLine& b) {
  OnLine result(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] += a[i] * b[j];
  }
  return result;
}

/// Numbers from 1 to kLargestNumber, the same ones each time (a linear congruential generator).
class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : state_(seed) {}
  numeric next() {
    state_ = state_ * 1664525u + 1013904223u;
    return numeric(static_cast<long>(1 + (state_ >> 16) % kLargestNumber));
  }

 private:
  std::uint32_t state_;
};

int degreeOf(const TrigKey& key, const std::vector<bool>& variable) {
  int degree = 0;
  for (std::size_t i = 0; i < variable.size(); ++i) degree += variable[i] ? key[i] : 0;
  return degree;
}

/// powers[i][k]: entry i to the power k on the line.
std::vector<std::vector<OnLine>> powersOf(const Terms& terms, const std::vector<bool>& variable, Numbers numbers) {
  std::vector<std::vector<OnLine>> powers;
  for (std::size_t i = 0; i < variable.size(); ++i) {
    int highest = 0;
    for (const auto& term : terms) highest = std::max(highest, static_cast<int>(term.first[i]));
    const numeric constant = numbers.next();
    const OnLine entry = variable[i] ? OnLine{constant, numbers.next()} : OnLine{constant};
    powers.push_back({{numeric(1)}});
    for (int k = 1; k <= highest; ++k) powers.back().push_back(product(powers.back().back(), entry));
  }
  return powers;
}

OnLine onLine(const TrigRing& ring, const Terms& terms, const std::vector<bool>& variable, std::uint32_t seed) {
  const std::vector<std::vector<OnLine>> powers = powersOf(terms, variable, Numbers(seed));
  OnLine sum;
  int count = 0;
  for (const auto& [key, coefficient] : terms) {
    if (++count % kTermsPerPoll == 0) ring.poll();
    OnLine term = {numeric(static_cast<long>(coefficient.numerator()), static_cast<long>(coefficient.denominator()))};
    for (std::size_t i = 0; i < variable.size(); ++i) {
      if (key[i] > 0) term = product(term, powers[i][static_cast<std::size_t>(key[i])]);
    }
    if (term.size() > sum.size()) sum.resize(term.size());
    for (std::size_t k = 0; k < term.size(); ++k) sum[k] += term[k];
  }
  return sum;
}

bool isIrreducible(const OnLine& polynomial) {
  const GiNaC::symbol t("t");
  GiNaC::exvector terms;
  for (std::size_t k = 0; k < polynomial.size(); ++k)
    terms.push_back(polynomial[k] * GiNaC::pow(t, static_cast<int>(k)));
  const auto factors = ginacFactors(GiNaC::add(terms));
  return factors.size() == 1 && factors.front().second == 1;
}

}  // namespace

bool isProvedIrreducible(const TrigRing& ring, const Terms& terms, const std::vector<bool>& variable) {
  int degree = 0;
  for (const auto& term : terms) degree = std::max(degree, degreeOf(term.first, variable));
  if (degree == 0) return false;
  for (int line = 0; line < kLines; ++line) {
    const OnLine polynomial = onLine(ring, terms, variable, static_cast<std::uint32_t>(line + 1));
    const bool same_degree = static_cast<int>(polynomial.size()) == degree + 1 && !polynomial.back().is_zero();
    if (same_degree && isIrreducible(polynomial)) return true;
    ring.poll();
  }
  return false;
}

}  // namespace screwline
