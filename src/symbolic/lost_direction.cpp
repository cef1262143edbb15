#include "screwline/symbolic/lost_direction.h"

#include <algorithm>
#include <utility>

#include "condition_points.h"
#include "lost_finder.h"
#include "singular_sets.h"

namespace screwline {
namespace {

constexpr int kStarts = 6;

HeldConditions heldAt(const SerialChain& chain, const Task& task, const std::vector<ExactCondition>& conditions,
                      std::vector<int>& ranks) {
  std::vector<const SingularityFactor*> factors;
  for (const ExactCondition& condition : conditions) factors.push_back(&condition.numeric);
  const std::vector<VectorX> all = commonZeros(chain, factors, kStarts);
  ranks = ranksAt(chain, task, all);
  HeldConditions held{conditions, {}, ranks.empty() ? 0 : ranks.back()};
  for (const VectorX& q : all) {
    if (rankAt(chain, task, q) == held.rank) held.points.push_back(q);
  }
  return held;
}

/// `lower`: what the rank has to be below for its directions to be looked for.
ConditionLoss lossAt(LossFinder& finder, const SerialChain& chain, const Task& task,
                     const std::vector<ExactCondition>& conditions, int lower) {
  ConditionLoss loss;
  const HeldConditions held = heldAt(chain, task, conditions, loss.ranks);
  if (!loss.ranks.empty() && held.rank < lower) loss.directions = finder.find(held, loss.deviation);
  return loss;
}

class MeetingList {
 public:
  MeetingList(const ExactChain& exact, const SerialChain& chain, const Task& task)
      : exact_(exact),
        chain_(chain),
        task_(task),
        finder_(exact, chain, task),
        single_(exactConditions(exact, chain, task)) {
    for (const ExactCondition& condition : single_) {
      std::vector<int> ranks;
      single_ranks_.push_back(heldAt(chain, task, {condition}, ranks).rank);
    }
  }

  std::vector<ConditionMeeting> list() {
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < single_.size(); ++i) {
      all.push_back(i);
      for (std::size_t j = i + 1; j < single_.size(); ++j) add({i, j}, {});
    }
    if (all.size() > 2) add(all, {});
    for (const SingularSet& set : singularSets(exact_, chain_, task_, single_)) add(set);
    return std::move(meetings_);
  }

 private:
  void add(const SingularSet& set) {
    std::vector<std::size_t> numbers;
    std::vector<ExactCondition> others;
    for (const ExactCondition& condition : set.conditions) {
      const auto known = std::find_if(single_.begin(), single_.end(),
                                      [&](const ExactCondition& one) { return one.base == condition.base; });
      if (known == single_.end()) {
        others.push_back(condition);
      } else {
        numbers.push_back(static_cast<std::size_t>(known - single_.begin()));
      }
    }
    std::sort(numbers.begin(), numbers.end());
    const bool known = others.empty() && std::any_of(meetings_.begin(), meetings_.end(), [&](const auto& meeting) {
                         return meeting.conditions == numbers;
                       });
    if (!known) add(numbers, others);
  }

  void add(const std::vector<std::size_t>& numbers, const std::vector<ExactCondition>& others) {
    ConditionMeeting meeting{numbers, {}, {}};
    std::vector<ExactCondition> conditions;
    int least = task_.size();
    for (const std::size_t i : numbers) {
      conditions.push_back(single_[i]);
      least = std::min(least, single_ranks_[i]);
    }
    for (const ConditionMeeting& part : meetings_) {
      const bool within = part.others.empty() &&
                          std::includes(numbers.begin(), numbers.end(), part.conditions.begin(), part.conditions.end());
      if (within && !part.loss.ranks.empty()) least = std::min(least, part.loss.ranks.back());
    }
    for (const ExactCondition& other : others) {
      conditions.push_back(other);
      meeting.others.push_back(exact_.formula(other.base));
    }
    meeting.loss = lossAt(finder_, chain_, task_, conditions, least);
    meetings_.push_back(std::move(meeting));
  }

  const ExactChain& exact_;
  const SerialChain& chain_;
  const Task& task_;
  LossFinder finder_;
  std::vector<ExactCondition> single_;
  std::vector<int> single_ranks_;
  std::vector<ConditionMeeting> meetings_;
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
  for (const ExactCondition& condition : exactConditions(exact, chain, task))
    losses.push_back(lossAt(finder, chain, task, {condition}, task.size()));
  return losses;
}

std::vector<ConditionMeeting> meetingsOf(const SymbolicChain& symbolic, const SerialChain& chain, const Task& task) {
  const ExactChain& exact = symbolic.exact();
  return MeetingList(exact, chain, task).list();
}

}  // namespace screwline
