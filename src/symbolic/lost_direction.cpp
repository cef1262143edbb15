#include "screwline/symbolic/lost_direction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "../kinematics/sampling.h"
#include "common_content.h"
#include "condition_points.h"
#include "exact_conditions.h"
#include "exact_determinant.h"
#include "lost_check.h"

namespace screwline {
namespace {

constexpr int kStarts = 6;
constexpr std::size_t kLongest = 240;    ///< Characters of a direction that is still worth reading.
constexpr std::size_t kMaxChoices = 40;  ///< Of columns that are looked at.
constexpr std::size_t kMostTerms = 20;   ///< Of a direction; beyond them it is not worth factoring.

using Entries = std::vector<TrigPolynomial>;

/// [f; n] at the origin of frame `point`, in the axes of frame `axes`.
struct ExactWrench {
  int point = 0;
  int axes = 0;
  Entries entries;
};

TrigMatrix block(const Entries& entries, int first) {
  TrigMatrix column(entries.front().ring(), 3, 1);
  for (int i = 0; i < 3; ++i) column(i, 0) = entries[static_cast<std::size_t>(first + i)];
  return column;
}

bool isZero(const TrigMatrix& column) {
  return column(0, 0).isZero() && column(1, 0).isZero() && column(2, 0).isZero();
}

/// All choices of `count` of 0..size-1, ascending.
std::vector<std::vector<int>> choicesOf(int size, int count) {
  std::vector<std::vector<int>> all;
  std::vector<bool> taken(static_cast<std::size_t>(size), false);
  std::fill_n(taken.begin(), count, true);
  do {
    std::vector<int> choice;
    for (int i = 0; i < size; ++i) {
      if (taken[static_cast<std::size_t>(i)]) choice.push_back(i);
    }
    all.push_back(choice);
  } while (all.size() < kMaxChoices && std::prev_permutation(taken.begin(), taken.end()));
  return all;
}

MatrixX selected(const MatrixX& matrix, const std::vector<int>& rows, const std::vector<int>& columns) {
  MatrixX result(rows.size(), columns.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns.size(); ++j)
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = matrix(rows[i], columns[j]);
  }
  return result;
}

TrigMatrix selected(const TrigMatrix& matrix, const std::vector<int>& rows, const std::vector<int>& columns) {
  return matrix.selected(rows).transposed().selected(columns).transposed();
}

/// Finds what one condition loses.
class LossFinder {
 public:
  LossFinder(const ExactChain& exact, const SerialChain& chain, const Task& task)
      : exact_(exact), chain_(chain), task_(task), determinant_(exactDeterminant(exact, task)) {}

  ConditionLoss find(const ExactCondition& condition) {
    const std::vector<VectorX> all = commonZeros(chain_, {&condition.numeric}, kStarts);
    ConditionLoss loss;
    loss.ranks = ranksAt(chain_, task_, all);
    // Wrenches of rows about the tool's axes are not written.
    if (loss.ranks.empty() || task_.usesToolAxes()) return loss;
    const int rank = loss.ranks.back();
    points_.clear();
    for (const VectorX& q : all) {
      if (rankAt(chain_, task_, q) == rank) points_.push_back(q);
    }
    zero_ = &condition.base;
    if (const std::optional<LostDirection> direction = ofBlock(condition, rank)) {
      loss.directions.push_back(*direction);
      loss.deviation = lossDeviation({exact_, chain_, task_, points_}, loss.directions, 1);
      if (loss.deviation <= kLossAgreement) return loss;
      loss.directions.clear();
    }
    const std::vector<Entries> found = nullRows(rank);
    for (const Entries& row : found) {
      const std::optional<LostDirection> direction = shortest(row, condition);
      if (!direction) return {loss.ranks, {}, 0.0};
      loss.directions.push_back(*direction);
    }
    loss.deviation = lossDeviation({exact_, chain_, task_, points_}, loss.directions, task_.size() - rank);
    if (!(loss.deviation <= kLossAgreement)) return {loss.ranks, {}, 0.0};
    return loss;
  }

 private:
  MatrixX numeric(const TrigMatrix& matrix, const VectorX& q) const { return valuesOf(exact_, matrix, q); }

  /// Three rows of J as they are in some axes: a position or an orientation alone, or the two blocks of an arm with a
  /// wrist whose axes meet. None where J has no such block that loses just one direction.
  std::optional<LostDirection> ofBlock(const ExactCondition& condition, int rank) const {
    if (rank + 1 != task_.size()) return std::nullopt;
    const int tip = exact_.size + 1;
    std::vector<int> all;
    for (int joint = 0; joint < exact_.joints; ++joint) all.push_back(joint);
    if (task_.size() == 3 && task_.translationCount() % 3 == 0)
      return shortestOfBlock(condition, task_.translationCount() == 3 ? 0 : 3, all, tip);
    if (task_.size() != 6 || exact_.joints != 6) return std::nullopt;
    for (int point = 1; point <= exact_.size; ++point) {
      const TrigMatrix v = exact_.jacobian(point, point).selected({0, 1, 2});
      std::vector<int> arm;
      std::vector<int> wrist;
      for (const int joint : all) (isZero(v.column(joint)) ? wrist : arm).push_back(joint);
      if (wrist.size() != 3) continue;
      std::optional<LostDirection> of_arm = shortestOfBlock(condition, 0, arm, point);
      if (of_arm) return of_arm;
      std::optional<LostDirection> of_wrist = shortestOfBlock(condition, 3, wrist, point);
      if (of_wrist) of_wrist->at_rest = true;
      return of_wrist;
    }
    return std::nullopt;
  }

  /// What the columns' rows first..first+2 leave out, in the axes where that is shortest.
  std::optional<LostDirection> shortestOfBlock(const ExactCondition& condition, int first,
                                               const std::vector<int>& columns, int point) const {
    std::optional<ExactWrench> best;
    std::optional<ExactWrench> in_base;
    for (int axes = 0; axes <= exact_.size + 1; ++axes) {
      const TrigMatrix B = selected(exact_.jacobian(axes, point), {first, first + 1, first + 2}, columns);
      const MatrixX at_point = numeric(B, points_.front());
      if (hasFullRank(at_point) && columns.size() >= 3) return std::nullopt;
      for (const std::vector<int>& pair : choicesOf(B.columns(), 2)) {
        if (!hasFullRank(selected(at_point, {0, 1, 2}, pair))) continue;
        const TrigMatrix chosen = selected(B, {0, 1, 2}, pair);
        const TrigMatrix lost = cross(chosen.column(0), chosen.column(1));
        const TrigMatrix none(exact_.ring, 3, 1);
        const ExactWrench wrench =
            solved(first == 0 ? joined(point, axes, lost, none) : joined(point, axes, none, lost), condition);
        if (axes == 0 && (!in_base || lengthOf(wrench) < lengthOf(*in_base))) in_base = wrench;
        if (!best || lengthOf(wrench) < lengthOf(*best)) best = wrench;
      }
    }
    if (!best || lengthOf(*best) > kLongest) return std::nullopt;
    return written(*best, *in_base);
  }

  /// Rows that times J are zero where the condition holds, by the minors of a regular block of J and one more row.
  std::vector<Entries> nullRows(int rank) const {
    const TrigMatrix& J = determinant_.jacobian;
    const MatrixX at_point = numeric(J, points_.front());
    const MatrixX elsewhere = numeric(J, sampleConfiguration(chain_, 0));
    std::vector<int> kept;
    std::vector<int> columns;
    std::pair<int, std::size_t> least(std::numeric_limits<int>::max(), 0);
    for (const std::vector<int>& choice : choicesOf(J.columns(), rank)) {
      const int minors = nonzeroMinors(elsewhere, choice);
      for (const std::vector<int>& rows : choicesOf(J.rows(), rank)) {
        const std::pair<int, std::size_t> size(minors, selected(J, rows, choice).termCount());
        if (size >= least || !hasFullRank(selected(at_point, rows, choice))) continue;
        least = size;
        kept = rows;
        columns = choice;
      }
    }
    std::vector<Entries> all;
    if (static_cast<int>(kept.size()) != rank) return all;
    for (int extra = 0; extra < J.rows(); ++extra) {
      if (std::find(kept.begin(), kept.end(), extra) == kept.end()) all.push_back(nullRow(kept, extra, columns));
    }
    return all;
  }

  /// How many of these columns' minors differ from zero: fewer where J is made of blocks and the columns fill some.
  static int nonzeroMinors(const MatrixX& J, const std::vector<int>& columns) {
    int count = 0;
    for (const std::vector<int>& rows : choicesOf(static_cast<int>(J.rows()), static_cast<int>(columns.size())))
      count += hasFullRank(selected(J, rows, columns)) ? 1 : 0;
    return count;
  }

  Entries nullRow(std::vector<int> rows, int extra, const std::vector<int>& columns) const {
    const TrigMatrix& J = determinant_.jacobian;
    Entries row(static_cast<std::size_t>(J.rows()), TrigPolynomial(J.ring()));
    rows.push_back(extra);
    std::sort(rows.begin(), rows.end());
    if (columns.empty()) {
      row[static_cast<std::size_t>(extra)] = TrigPolynomial::number(J.ring(), 1);
      return row;
    }
    // In binary order of the rows kept: the minor without the last row comes first.
    const std::vector<TrigPolynomial> minors = largestMinors(selected(J, rows, columns));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const TrigPolynomial& minor = minors[rows.size() - 1 - i];
      row[static_cast<std::size_t>(rows[i])] = i % 2 == 0 ? minor : -minor;
    }
    reduce(row);
    return row;
  }

  static bool isLong(const Entries& entries) {
    std::size_t terms = 0;
    for (const TrigPolynomial& entry : entries) terms += entry.terms().size();
    return terms > kMostTerms;
  }

  void reduce(Entries& entries) const {
    if (!isLong(entries)) reduceDirection(entries, zero_, exact_.table.symbols);
  }

  ExactWrench wrenchOf(const Entries& row) const {
    ExactWrench wrench{determinant_.point, determinant_.frame, Entries(6, TrigPolynomial(exact_.ring))};
    for (int i = 0; i < task_.size(); ++i)
      wrench.entries[static_cast<std::size_t>(task_.row(i))] = row[static_cast<std::size_t>(i)];
    return wrench;
  }

  ExactWrench joined(int point, int axes, const TrigMatrix& f, const TrigMatrix& n) const {
    ExactWrench wrench{point, axes, {}};
    for (int i = 0; i < 3; ++i) wrench.entries.push_back(f(i, 0));
    for (int i = 0; i < 3; ++i) wrench.entries.push_back(n(i, 0));
    reduce(wrench.entries);
    return wrench;
  }

  ExactWrench movedTo(int point, const ExactWrench& wrench) const {
    const TrigMatrix f = block(wrench.entries, 0);
    const TrigMatrix r = exact_.pose(wrench.axes, wrench.point).p - exact_.pose(wrench.axes, point).p;
    return joined(point, wrench.axes, f, block(wrench.entries, 3) + cross(r, f));
  }

  ExactWrench turnedTo(int axes, const ExactWrench& wrench) const {
    const TrigMatrix R = exact_.pose(axes, wrench.axes).R;
    return joined(wrench.point, axes, R * block(wrench.entries, 0), R * block(wrench.entries, 3));
  }

  std::size_t lengthOf(const ExactWrench& wrench) const {
    if (isLong(wrench.entries)) return kLongest + 1;
    std::size_t length = 0;
    for (const TrigPolynomial& entry : wrench.entries) {
      if (!entry.isZero()) length += 4 + exact_.reader.length(exact_.formula(entry));
    }
    return length;
  }

  /// The same with the slide at its value, where that is a sum of lengths.
  ExactWrench withSlide(const ExactWrench& wrench, const TrigPolynomial& f, int joint) const {
    const TrigPolynomial constant = f.atScalar(joint, TrigPolynomial(exact_.ring));
    const TrigPolynomial slope = f.atScalar(joint, TrigPolynomial::number(exact_.ring, 1)) - constant;
    const TrigPolynomial slide = TrigPolynomial::scalar(exact_.ring, joint);
    if (!slope.isNumber() || slope.isZero() || !(constant + slope * slide == f)) return wrench;
    const TrigPolynomial value = constant.scaled(Rational(-1) / slope.terms().begin()->second);
    ExactWrench result = wrench;
    for (TrigPolynomial& entry : result.entries) entry = entry.atScalar(joint, value);
    reduceDirection(result.entries, nullptr, exact_.table.symbols);
    return lengthOf(result) <= lengthOf(wrench) ? result : wrench;
  }

  /// The same with the condition's joint at its value, where that is exact and the same for all of them.
  ExactWrench solved(const ExactWrench& wrench, const ExactCondition& condition) const {
    if (isLong(wrench.entries) || condition.numeric.joints.size() != 1 || condition.numeric.roots.empty())
      return wrench;
    const int joint = condition.numeric.joints.front();
    if (!chain_.joint(joint).isRevolute()) return withSlide(wrench, condition.base, joint);
    std::optional<ExactWrench> common;
    for (const double root : condition.numeric.roots) {
      const double steps = std::round(root / (kPi / 12.0));
      if (std::abs(root - steps * kPi / 12.0) > kExactAngle) return wrench;
      ExactWrench at_root = wrench;
      for (TrigPolynomial& entry : at_root.entries) entry = entry.atAngle(joint, static_cast<int>(steps));
      reduceDirection(at_root.entries, nullptr, exact_.table.symbols);
      if (common && !areParallel(common->entries, at_root.entries)) return wrench;
      if (!common) common = at_root;
    }
    return lengthOf(*common) <= lengthOf(wrench) ? *common : wrench;
  }

  /// Moved to the point, then to the axes where it is shortest; the tip and the base where others are not shorter.
  std::optional<LostDirection> shortest(const Entries& row, const ExactCondition& condition) const {
    const int tip = exact_.size + 1;
    if (isLong(row)) return std::nullopt;
    const ExactWrench given = wrenchOf(row);
    ExactWrench best = solved(movedTo(tip, given), condition);
    for (int point = exact_.size; point > 0; --point) {
      const ExactWrench moved = solved(movedTo(point, given), condition);
      if (lengthOf(moved) < lengthOf(best)) best = moved;
    }
    const ExactWrench at_point = best;
    const ExactWrench in_base = solved(turnedTo(0, at_point), condition);
    best = in_base;
    for (int axes = 1; axes <= tip; ++axes) {
      const ExactWrench turned = solved(turnedTo(axes, at_point), condition);
      if (lengthOf(turned) < lengthOf(best)) best = turned;
    }
    if (lengthOf(best) > kLongest) return std::nullopt;
    return written(best, in_base);
  }

  LostDirection written(const ExactWrench& wrench, const ExactWrench& in_base) const {
    const TrigMatrix f = block(wrench.entries, 0);
    const TrigMatrix n = block(wrench.entries, 3);
    LostDirection direction{wrench.point, wrench.axes, exact_.formula(f), exact_.formula(n), false, {}};
    if (lengthOf(in_base) > kLongest) return direction;
    if (isZero(n)) direction.in_base = exact_.formula(block(in_base.entries, 0));
    if (isZero(f)) direction.in_base = exact_.formula(block(in_base.entries, 3));
    return direction;
  }

  const ExactChain& exact_;
  const SerialChain& chain_;
  const Task& task_;
  const ExactDeterminant& determinant_;
  const TrigPolynomial* zero_ = nullptr;
  std::vector<VectorX> points_;
};

bool allZero(const FormulaMatrix& column) {
  return std::all_of(column.entries.begin(), column.entries.end(), [](const Formula& entry) { return entry.isZero(); });
}

}  // namespace

bool LostDirection::isTranslation() const {
  return allZero(n);
}

bool LostDirection::isRotation() const {
  return allZero(f);
}

std::vector<ConditionLoss> lossesOf(const SymbolicChain& symbolic, const SerialChain& chain, const Task& task) {
  const ExactChain& exact = symbolic.exact();
  LossFinder finder(exact, chain, task);
  std::vector<ConditionLoss> losses;
  for (const ExactCondition& condition : exactConditions(exact, chain, task)) losses.push_back(finder.find(condition));
  return losses;
}

std::vector<ConditionMeeting> meetingsOf(const SymbolicChain& symbolic, const SerialChain& chain, const Task& task) {
  const std::vector<ExactCondition> conditions = exactConditions(symbolic.exact(), chain, task);
  std::vector<ConditionMeeting> meetings;
  const auto add = [&](std::vector<std::size_t> numbers) {
    std::vector<const SingularityFactor*> factors;
    for (const std::size_t i : numbers) factors.push_back(&conditions[i].numeric);
    meetings.push_back({std::move(numbers), ranksAt(chain, task, commonZeros(chain, factors, kStarts))});
  };
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    all.push_back(i);
    for (std::size_t j = i + 1; j < conditions.size(); ++j) add({i, j});
  }
  if (all.size() > 2) add(all);
  return meetings;
}

}  // namespace screwline
