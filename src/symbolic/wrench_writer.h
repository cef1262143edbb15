#ifndef SCREWLINE_SRC_SYMBOLIC_WRENCH_WRITER_H
#define SCREWLINE_SRC_SYMBOLIC_WRENCH_WRITER_H

#include <map>
#include <vector>

#include "exact_conditions.h"
#include "screwline/symbolic/lost_direction.h"

namespace screwline {

constexpr std::size_t kLongestWrench = 240;   ///< Characters of a direction that is still worth reading.
constexpr std::size_t kMostWrenchTerms = 60;  ///< Beyond them a direction is not worth factoring.

/// [f; n] at the origin of frame `point`, in the axes of frame `axes`.
struct ExactWrench {
  int point = 0;
  int axes = 0;
  std::vector<TrigPolynomial> entries;
};

std::size_t termsOf(const std::vector<TrigPolynomial>& entries);
/// Whether all of the entries are short over half angles, where they are factored; their time has no other bound.
bool isFactorable(const std::vector<TrigPolynomial>& entries);

/// Brings directions, whose length means nothing, to their shortest form where conditions hold, and writes them.
class WrenchWriter {
 public:
  /// Keeps references.
  WrenchWriter(const ExactChain& exact, const SerialChain& chain) : exact_(exact), chain_(chain) {}

  /// The conditions that hold from now on.
  void begin(const std::vector<ExactCondition>& conditions);
  /// Without what its entries have in common and what is zero, the conditions' joints at their values where these are
  /// exact and the direction the same for all of them.
  ExactWrench shortened(ExactWrench wrench) const;
  /// Characters; much more than kLongestWrench for what is too long to be looked at.
  std::size_t lengthOf(const ExactWrench& wrench) const;
  LostDirection written(const ExactWrench& wrench) const;

 private:
  void reduce(std::vector<TrigPolynomial>& entries) const;
  ExactWrench solved(const ExactWrench& wrench) const;
  ExactWrench solvedFor(const ExactCondition& condition, const ExactWrench& wrench) const;
  ExactWrench withSlide(const ExactWrench& wrench, const TrigPolynomial& f, int joint) const;
  void divideByNumber(std::vector<TrigPolynomial>& entries) const;
  Formula formulaOf(const TrigPolynomial& entry) const;

  const ExactChain& exact_;
  const SerialChain& chain_;
  std::vector<ExactCondition> conditions_;
  std::vector<TrigPolynomial> zeros_;
  mutable std::map<TrigPolynomial::Terms, Formula> formulas_;  ///< Written so far.
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_WRENCH_WRITER_H
