#include "singular_sets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "choices.h"
#include "condition_points.h"
#include "exact_determinant.h"
#include "where_zero.h"

namespace screwline {
namespace {

constexpr int kStarts = 4;
constexpr std::size_t kMostConditions = 3;
constexpr int kMostNodes = 60;                 ///< Combinations of conditions that are looked at.
constexpr std::size_t kMostGroups = 4;         ///< Combinations of the conditions' values.
constexpr std::size_t kLargestSelection = 90;  ///< Terms of a matrix whose determinant is worked out.
constexpr std::size_t kLargestFactored = 80;   ///< Terms of a minor.
constexpr std::size_t kLargestReduced = 400;   ///< Terms of a minor while conditions are put into it.
constexpr std::size_t kLongestCondition = 10;  ///< Terms of a condition that still says something.
constexpr double kHolds = 1e-9;                ///< Of a condition's typical magnitude.

bool isSame(const TrigPolynomial& a, const TrigPolynomial& b) {
  return a == b || a == -b;
}

bool contains(const std::vector<ExactCondition>& all, const TrigPolynomial& base) {
  return std::any_of(all.begin(), all.end(), [&base](const ExactCondition& one) { return isSame(one.base, base); });
}

bool containsAll(const std::vector<ExactCondition>& all, const std::vector<ExactCondition>& some) {
  return std::all_of(some.begin(), some.end(), [&all](const ExactCondition& one) { return contains(all, one.base); });
}

class SetSearch {
 public:
  SetSearch(const ExactChain& exact, const SerialChain& chain, const Task& task)
      : exact_(exact), chain_(chain), task_(task), determinant_(exactDeterminant(exact, task)) {}

  std::vector<SingularSet> run(const std::vector<ExactCondition>& single) {
    const SingularSet anywhere = setOf({});
    full_ = anywhere.rank;
    std::vector<SingularSet> sets;
    for (const ExactCondition& one : single) sets.push_back(setOf({one}));
    for (std::size_t i = 0; i < single.size(); ++i) {
      for (std::size_t j = i + 1; j < single.size(); ++j) sets.push_back(setOf({single[i], single[j]}));
    }
    for (const SingularSet& set : sets) {
      if (isNew(set.conditions)) take(set);
    }
    for (const SingularSet& set : sets) explore(set);
    // Of a square task's one minor the conditions are all factors; others may share none.
    if (!determinant_.isSquare()) explore(anywhere);
    std::vector<SingularSet> result;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (found_[i].conditions.size() > 1 && isLeast(i)) result.push_back(found_[i]);
    }
    return result;
  }

 private:
  SingularSet setOf(const std::vector<ExactCondition>& conditions) const {
    std::vector<const SingularityFactor*> factors;
    for (const ExactCondition& condition : conditions) factors.push_back(&condition.numeric);
    SingularSet set{conditions, commonZeros(chain_, factors, kStarts), 0};
    const std::vector<int> ranks = ranksAt(chain_, task_, set.points);
    if (ranks.empty()) return set;
    set.rank = ranks.back();
    set.points.erase(std::remove_if(set.points.begin(), set.points.end(),
                                    [&](const VectorX& q) { return rankAt(chain_, task_, q) != set.rank; }),
                     set.points.end());
    return set;
  }

  static bool hold(const std::vector<ExactCondition>& conditions, const std::vector<VectorX>& points) {
    return std::all_of(points.begin(), points.end(), [&](const VectorX& q) {
      return std::all_of(conditions.begin(), conditions.end(), [&q](const ExactCondition& condition) {
        return std::abs(condition.numeric.value(q)) <= kHolds * condition.numeric.scale;
      });
    });
  }

  /// Whether no other conditions hold wherever these do, and say as much; of two that say the same the first.
  bool isLeast(std::size_t number) const {
    const SingularSet& set = found_[number];
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const SingularSet& other = found_[i];
      if (i == number || other.rank > set.rank || !hold(other.conditions, set.points)) continue;
      if (i < number || other.rank < set.rank || !hold(set.conditions, other.points)) return false;
    }
    return true;
  }

  /// Conditions of several joints with the exact values of the others put in: where that leaves factors without
  /// lengths, those take its place. Empty where nothing changes.
  std::vector<std::vector<ExactCondition>> simplified(const std::vector<ExactCondition>& conditions) const {
    std::vector<std::vector<ExactCondition>> result;
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      if (conditions[i].numeric.joints.size() < 2) continue;
      const TrigPolynomial rest = at(conditions, firstSteps(conditions), conditions[i].base);
      if (rest == conditions[i].base || rest.isZero()) continue;
      std::vector<TrigPolynomial> factors;
      for (const PolynomialFactor& factor : factored(rest, exact_.table.symbols).factors) {
        if (!jointsOf(exact_, factor.base).empty()) factors.push_back(factor.base);
      }
      const bool plain = std::all_of(factors.begin(), factors.end(), [this](const TrigPolynomial& factor) {
        return factor.symbols().size() == jointsOf(exact_, factor).size();
      });
      if (!plain) continue;
      for (const ExactCondition& factor : conditionsFrom(exact_, chain_, factors)) {
        result.push_back(conditions);
        result.back()[i] = factor;
      }
      return result;
    }
    return result;
  }

  std::vector<int> firstSteps(const std::vector<ExactCondition>& conditions) const {
    VectorX q = VectorX::Zero(chain_.size());
    for (const ExactCondition& condition : conditions) {
      if (condition.numeric.joints.size() == 1 && !condition.numeric.roots.empty())
        q[condition.numeric.joints.front()] = condition.numeric.roots.front();
    }
    return stepsAt(conditions, q);
  }

  /// Whether they are to be looked at; they are not again.
  bool isNew(const std::vector<ExactCondition>& conditions) {
    const bool known = std::any_of(visited_.begin(), visited_.end(), [&](const std::vector<ExactCondition>& other) {
      return other.size() == conditions.size() && containsAll(other, conditions);
    });
    if (known || static_cast<int>(visited_.size()) >= kMostNodes) return false;
    visited_.push_back(conditions);
    return true;
  }

  /// As found, where it lowers the rank below what is known.
  void take(const SingularSet& set) {
    const bool lower = std::all_of(found_.begin(), found_.end(), [&set](const SingularSet& other) {
      return set.rank < other.rank || !containsAll(set.conditions, other.conditions);
    });
    if (lower && !set.points.empty() && set.rank < full_) found_.push_back(set);
  }

  void visit(const std::vector<ExactCondition>& conditions) {
    if (!isNew(conditions)) return;
    const std::vector<std::vector<ExactCondition>> simpler = simplified(conditions);
    for (const std::vector<ExactCondition>& other : simpler) visit(other);
    if (!simpler.empty()) return;
    const SingularSet set = setOf(conditions);
    take(set);
    if (!set.points.empty()) explore(set);
  }

  void explore(const SingularSet& set) {
    if (set.conditions.size() >= kMostConditions || set.rank == 0) return;
    const std::vector<TrigPolynomial> candidates = set.conditions.empty() ? shortestMinor() : candidatesAt(set);
    for (const ExactCondition& next : conditionsFrom(exact_, chain_, candidates)) {
      std::vector<ExactCondition> conditions = set.conditions;
      conditions.push_back(next);
      visit(conditions);
    }
  }

  /// The joint factors of the shortest of the task's own minors.
  std::vector<TrigPolynomial> shortestMinor() const {
    std::vector<TrigPolynomial> shortest;
    std::size_t least = 0;
    for (const FactoredPolynomial& minor : determinant_.minors) {
      std::size_t terms = 0;
      std::vector<TrigPolynomial> factors;
      for (const PolynomialFactor& factor : minor.factors) {
        if (jointsOf(exact_, factor.base).empty()) continue;
        terms += factor.base.terms().size();
        if (factor.base.terms().size() <= kLongestCondition) factors.push_back(factor.base);
      }
      if (minor.coefficient.isZero() || (least > 0 && terms >= least)) continue;
      least = terms;
      shortest = factors;
    }
    return shortest;
  }

  /// Factors of a minor that is as large as the rank, for each combination of exact values of the conditions' joints.
  std::vector<TrigPolynomial> candidatesAt(const SingularSet& set) const {
    std::map<std::vector<int>, std::vector<VectorX>> groups;
    for (const VectorX& q : set.points) groups[stepsAt(set.conditions, q)].push_back(q);
    std::vector<TrigPolynomial> candidates;
    std::size_t count = 0;
    for (const auto& [steps, points] : groups) {
      if (++count > kMostGroups) break;
      TrigMatrix J = determinant_.jacobian;
      for (int i = 0; i < J.rows(); ++i) {
        for (int j = 0; j < J.columns(); ++j) J(i, j) = at(set.conditions, steps, J(i, j));
      }
      std::vector<TrigPolynomial> inexact;
      for (const ExactCondition& condition : set.conditions) {
        const TrigPolynomial rest = at(set.conditions, steps, condition.base);
        if (!rest.isZero()) inexact.push_back(rest);
      }
      for (const TrigPolynomial& factor : minorFactors(J, inexact, points, set.rank)) {
        const bool taken = std::any_of(candidates.begin(), candidates.end(),
                                       [&factor](const TrigPolynomial& other) { return isSame(other, factor); });
        if (!taken && !contains(set.conditions, factor)) candidates.push_back(factor);
      }
    }
    return candidates;
  }

  /// Of each condition of one joint with exact values the one that holds at q; no angle where it has none.
  std::vector<int> stepsAt(const std::vector<ExactCondition>& conditions, const VectorX& q) const {
    std::vector<int> steps;
    for (const ExactCondition& condition : conditions) {
      steps.push_back(kNotExact);
      if (condition.numeric.joints.size() != 1) continue;
      const int joint = condition.numeric.joints.front();
      if (!chain_.joint(joint).isRevolute()) continue;
      steps.back() = exactSteps(condition.base, joint, q[joint]).value_or(kNotExact);
    }
    return steps;
  }

  /// With the exact values that the conditions give to joints.
  TrigPolynomial at(const std::vector<ExactCondition>& conditions, const std::vector<int>& steps,
                    TrigPolynomial entry) const {
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      const ExactCondition& condition = conditions[i];
      if (condition.numeric.joints.size() != 1) continue;
      const int joint = condition.numeric.joints.front();
      if (steps[i] != kNotExact) {
        entry = entry.atAngle(joint, steps[i]);
      } else if (!chain_.joint(joint).isRevolute()) {
        const std::optional<TrigPolynomial> value = exactSlide(condition.base, joint);
        if (value) entry = entry.atScalar(joint, *value);
      }
    }
    return entry;
  }

  std::vector<TrigPolynomial> minorFactors(const TrigMatrix& given, const std::vector<TrigPolynomial>& zeros,
                                           const std::vector<VectorX>& points, int rank) const {
    std::vector<MatrixX> values;
    for (const VectorX& q : points) values.push_back(valuesOf(exact_, given, q));
    const TrigMatrix J = withoutZeros(given, values);
    std::vector<std::pair<std::size_t, std::pair<std::vector<int>, std::vector<int>>>> selections;
    for (const std::vector<int>& rows : choicesOf(J.rows(), rank)) {
      for (const std::vector<int>& columns : choicesOf(J.columns(), rank)) {
        if (!hasFullRank(selected(values.front(), rows, columns))) continue;
        const std::size_t size = selected(J, rows, columns).termCount();
        if (size <= kLargestSelection) selections.push_back({size, {rows, columns}});
      }
    }
    if (selections.empty()) return {};
    const auto& [rows, columns] = std::min_element(selections.begin(), selections.end())->second;
    const auto minors = largestMinors(selected(J, rows, columns), kLargestReduced);
    if (!minors) return {};
    const TrigPolynomial minor = whereZero(zeros, minors->front(), kLargestReduced);
    std::vector<TrigPolynomial> factors;
    if (minor.isZero() || minor.terms().size() > kLargestFactored) return factors;
    for (const PolynomialFactor& factor : factored(minor, exact_.table.symbols).factors) {
      if (!jointsOf(exact_, factor.base).empty() && factor.base.terms().size() <= kLongestCondition)
        factors.push_back(factor.base);
    }
    return factors;
  }

  static constexpr int kNotExact = 1000;

  const ExactChain& exact_;
  const SerialChain& chain_;
  const Task& task_;
  const ExactDeterminant& determinant_;
  int full_ = 0;  ///< The rank at most configurations.
  std::vector<std::vector<ExactCondition>> visited_;
  std::vector<SingularSet> found_;
};

}  // namespace

std::vector<SingularSet> singularSets(const ExactChain& exact, const SerialChain& chain, const Task& task,
                                      const std::vector<ExactCondition>& single) {
  return SetSearch(exact, chain, task).run(single);
}

}  // namespace screwline
