#include "wrench_writer.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "common_content.h"
#include "half_angle.h"

namespace screwline {
namespace {

constexpr std::size_t kTooLong = 2 * kLongestWrench;
constexpr std::size_t kMostHalfAngleTerms = 300;  ///< Of an entry; GiNaC factors more in many seconds.

}  // namespace

std::size_t termsOf(const std::vector<TrigPolynomial>& entries) {
  std::size_t terms = 0;
  for (const TrigPolynomial& entry : entries) terms += entry.terms().size();
  return terms;
}

bool isFactorable(const std::vector<TrigPolynomial>& entries) {
  return std::all_of(entries.begin(), entries.end(),
                     [](const TrigPolynomial& entry) { return isShortInHalfAngles(entry, kMostHalfAngleTerms); });
}

void WrenchWriter::begin(const std::vector<ExactCondition>& conditions) {
  conditions_ = conditions;
  zeros_.clear();
  for (const ExactCondition& condition : conditions) zeros_.push_back(condition.base);
}

ExactWrench WrenchWriter::shortened(ExactWrench wrench) const {
  reduce(wrench.entries);
  return solved(wrench);
}

void WrenchWriter::reduce(std::vector<TrigPolynomial>& entries) const {
  if (termsOf(entries) <= kMostWrenchTerms) reduceDirection(entries, zeros_, exact_.table.symbols);
}

std::size_t WrenchWriter::lengthOf(const ExactWrench& wrench) const {
  if (termsOf(wrench.entries) > kMostWrenchTerms) return kTooLong;
  std::size_t length = 0;
  for (const TrigPolynomial& entry : wrench.entries) {
    if (!entry.isZero()) length += 4 + exact_.reader.length(formulaOf(entry));
  }
  return length;
}

/// In factors where that is shorter.
Formula WrenchWriter::formulaOf(const TrigPolynomial& entry) const {
  const auto known = formulas_.find(entry.terms());
  if (known != formulas_.end()) return known->second;
  Formula formula = exact_.formula(entry);
  if (entry.terms().size() > 2) {
    const FactoredPolynomial parts = factored(entry, exact_.table.symbols);
    std::vector<Formula> product = {exact_.formula(parts.coefficient)};
    for (const PolynomialFactor& factor : parts.factors)
      product.push_back(Formula::power(exact_.formula(factor.base), factor.multiplicity));
    const Formula in_factors = Formula::product(product);
    if (exact_.reader.length(in_factors) < exact_.reader.length(formula)) formula = in_factors;
  }
  return formulas_.emplace(entry.terms(), formula).first->second;
}

/// The same with the conditions' joints at their values, where these are exact and the direction the same for all.
ExactWrench WrenchWriter::solved(const ExactWrench& wrench) const {
  ExactWrench result = wrench;
  if (lengthOf(wrench) >= kTooLong) return result;
  for (const ExactCondition& condition : conditions_) result = solvedFor(condition, result);
  return result;
}

ExactWrench WrenchWriter::solvedFor(const ExactCondition& condition, const ExactWrench& wrench) const {
  if (condition.numeric.joints.size() != 1 || condition.numeric.roots.empty()) return wrench;
  const int joint = condition.numeric.joints.front();
  if (!chain_.joint(joint).isRevolute()) return withSlide(wrench, condition.base, joint);
  std::optional<ExactWrench> common;
  for (const double root : condition.numeric.roots) {
    const std::optional<int> steps = exactSteps(condition.base, joint, root);
    if (!steps) return wrench;
    ExactWrench at_root = wrench;
    for (TrigPolynomial& entry : at_root.entries) entry = entry.atAngle(joint, *steps);
    reduceDirection(at_root.entries, {}, exact_.table.symbols);
    if (common && !areParallel(common->entries, at_root.entries)) return wrench;
    if (!common) common = at_root;
  }
  return lengthOf(*common) <= lengthOf(wrench) ? *common : wrench;
}

/// The same with the slide at its value, where that is a sum of lengths.
ExactWrench WrenchWriter::withSlide(const ExactWrench& wrench, const TrigPolynomial& f, int joint) const {
  const std::optional<TrigPolynomial> value = exactSlide(f, joint);
  if (!value) return wrench;
  ExactWrench result = wrench;
  for (TrigPolynomial& entry : result.entries) entry = entry.atScalar(joint, *value);
  reduceDirection(result.entries, {}, exact_.table.symbols);
  return lengthOf(result) <= lengthOf(wrench) ? result : wrench;
}

/// Without the number that the entries have in common when they are written in factors.
void WrenchWriter::divideByNumber(std::vector<TrigPolynomial>& entries) const {
  std::int64_t top = 0;
  std::int64_t bottom = 1;
  for (const TrigPolynomial& entry : entries) {
    if (entry.isZero()) continue;
    const FactoredPolynomial parts = factored(entry, exact_.table.symbols);
    for (const auto& term : parts.coefficient.terms()) {
      top = std::gcd(top, term.second.numerator());
      bottom = std::lcm(bottom, term.second.denominator());
    }
  }
  if (top == 0) return;
  for (TrigPolynomial& entry : entries) entry = entry.scaled(Rational(bottom, top));
}

LostDirection WrenchWriter::written(const ExactWrench& given) const {
  ExactWrench wrench = given;
  divideByNumber(wrench.entries);
  const auto formulas = [this](const std::vector<TrigPolynomial>& entries, int first) {
    FormulaMatrix column{3, 1, {}};
    for (int i = 0; i < 3; ++i) column.entries.push_back(formulaOf(entries[static_cast<std::size_t>(first + i)]));
    return column;
  };
  LostDirection direction{wrench.point, wrench.axes, formulas(wrench.entries, 0), formulas(wrench.entries, 3),
                          false,        {}};
  if (!direction.isTranslation() && !direction.isRotation()) return direction;
  const int first = direction.isTranslation() ? 0 : 3;
  TrigMatrix column(exact_.ring, 3, 1);
  for (int i = 0; i < 3; ++i) column(i, 0) = wrench.entries[static_cast<std::size_t>(first + i)];
  const TrigMatrix turned = exact_.pose(0, wrench.axes).R * column;
  ExactWrench in_base{wrench.point, 0, std::vector<TrigPolynomial>(6, TrigPolynomial(exact_.ring))};
  for (int i = 0; i < 3; ++i) in_base.entries[static_cast<std::size_t>(first + i)] = turned(i, 0);
  if (!isFactorable(in_base.entries)) return direction;
  reduce(in_base.entries);
  in_base = solved(in_base);
  if (lengthOf(in_base) <= kLongestWrench) direction.in_base = formulas(in_base.entries, first);
  return direction;
}

}  // namespace screwline
