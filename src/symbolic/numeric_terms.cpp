#include "numeric_terms.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace screwline {
namespace {

constexpr double kCancelled = 1e-15;  ///< Of the largest coefficient.

/// cos (or sin) of joint angles times `turns` plus a phase.
struct Wave {
  double coefficient = 1.0;
  bool sine = false;
  std::vector<double> turns;
  double phase = 0.0;
};

std::size_t at(int entry) {
  return static_cast<std::size_t>(entry);
}

Wave combined(const Wave& a, const Wave& b, int sign) {
  Wave result = a;
  result.coefficient *= 0.5 * b.coefficient;
  result.sine = a.sine != b.sine;
  for (std::size_t i = 0; i < a.turns.size(); ++i) result.turns[i] += sign * b.turns[i];
  result.phase += sign * b.phase;
  if ((a.sine && b.sine && sign > 0) || (!a.sine && b.sine && sign < 0)) result.coefficient *= -1.0;
  return result;
}

void multiply(std::vector<Wave>& waves, const Wave& factor) {
  std::vector<Wave> product;
  for (const Wave& wave : waves) {
    for (const int sign : {-1, 1}) product.push_back(combined(wave, factor, sign));
  }
  waves = std::move(product);
}

/// The first turn positive; without turns a number.
void normalise(Wave& wave) {
  const auto first = std::find_if(wave.turns.begin(), wave.turns.end(), [](double turn) { return turn != 0.0; });
  if (first == wave.turns.end()) {
    wave.coefficient *= wave.sine ? std::sin(wave.phase) : std::cos(wave.phase);
    wave.sine = false;
    wave.phase = 0.0;
  } else if (*first < 0.0) {
    for (double& turn : wave.turns) turn = turn != 0.0 ? -turn : 0.0;
    wave.phase = wave.phase != 0.0 ? -wave.phase : 0.0;
    if (wave.sine) wave.coefficient *= -1.0;
  }
}

class TermMaker {
 public:
  TermMaker(const ExactChain& exact, const std::vector<int>& joints) : exact_(exact), joints_(joints) {}

  std::vector<FactorTerm> make(const TrigPolynomial& polynomial) {
    for (const auto& [key, coefficient] : polynomial.terms()) addTerm(key, coefficient.value());
    double largest = 0.0;
    for (const auto& entry : sums_) largest = std::max(largest, std::abs(entry.second));
    std::vector<FactorTerm> terms;
    for (const auto& [kind, coefficient] : sums_) {
      if (std::abs(coefficient) <= kCancelled * largest) continue;
      FactorTerm term;
      term.coefficient = coefficient;
      bool sine = false;
      std::tie(term.powers, sine, term.turns, term.phase) = kind;
      const bool turns = std::any_of(term.turns.begin(), term.turns.end(), [](double turn) { return turn != 0.0; });
      if (turns) term.function = sine ? FactorTerm::Function::kSine : FactorTerm::Function::kCosine;
      terms.push_back(term);
    }
    std::stable_sort(terms.begin(), terms.end(), [](const FactorTerm& a, const FactorTerm& b) {
      return std::accumulate(a.powers.begin(), a.powers.end(), 0) >
             std::accumulate(b.powers.begin(), b.powers.end(), 0);
    });
    return terms;
  }

 private:
  using Kind = std::tuple<std::vector<int>, bool, std::vector<double>, double>;

  void addTerm(const TrigKey& key, double coefficient) {
    const TrigRing& ring = *exact_.ring;
    coefficient *= (key[0] != 0 ? std::sqrt(2.0) : 1.0) * (key[1] != 0 ? std::sqrt(3.0) : 1.0);
    std::vector<int> powers(joints_.size(), 0);
    for (std::size_t i = 0; i < ring.scalars().size(); ++i) {
      const int exponent = key[at(ring.scalarOffset(i))];
      const int id = ring.scalars()[i];
      const auto joint = std::find(joints_.begin(), joints_.end(), id);
      if (joint != joints_.end()) powers[at(static_cast<int>(joint - joints_.begin()))] = exponent;
      for (int k = 0; joint == joints_.end() && k < exponent; ++k) coefficient *= exact_.table.symbols[id].value;
    }
    Wave start;
    start.coefficient = coefficient;
    start.turns.assign(joints_.size(), 0.0);
    std::vector<Wave> waves = {start};
    for (const AngleGroup& group : ring.groups()) multiplyGroup(group, key, waves);
    for (Wave& wave : waves) {
      normalise(wave);
      sums_[{powers, wave.sine, wave.turns, wave.phase}] += wave.coefficient;
    }
  }

  void turnBy(Wave& wave, int id, int times) const {
    const auto joint = std::find(joints_.begin(), joints_.end(), id);
    if (joint != joints_.end()) {
      wave.turns[at(static_cast<int>(joint - joints_.begin()))] += times;
    } else {
      wave.phase += times * exact_.table.symbols[id].value;
    }
  }

  void multiplyGroup(const AngleGroup& group, const TrigKey& key, std::vector<Wave>& waves) const {
    Wave factor;
    factor.turns.assign(joints_.size(), 0.0);
    if (group.isSingle()) {
      turnBy(factor, group.angles.front(), 1);
      for (int k = 0; k < key[at(group.offset)]; ++k) multiply(waves, factor);
      factor.sine = true;
      for (int k = 0; k < key[at(group.offset + 1)]; ++k) multiply(waves, factor);
      return;
    }
    bool any = false;
    for (std::size_t k = 0; k < group.angles.size(); ++k) {
      const int times = key[at(group.offset + 1) + k];
      if (times != 0) turnBy(factor, group.angles[k], times);
      any = any || times != 0;
    }
    factor.sine = key[at(group.offset)] != 0;
    if (any) multiply(waves, factor);
  }

  const ExactChain& exact_;
  const std::vector<int>& joints_;
  std::map<Kind, double> sums_;
};

}  // namespace

std::vector<FactorTerm> numericTerms(const ExactChain& exact, const TrigPolynomial& polynomial,
                                     const std::vector<int>& joints) {
  return TermMaker(exact, joints).make(polynomial);
}

}  // namespace screwline
