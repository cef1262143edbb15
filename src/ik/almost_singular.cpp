#include "almost_singular.h"

#include <algorithm>
#include <iterator>

#include "mate.h"

namespace screwline {
namespace {

bool isIsolated(const IkAnswer& answer) {
  return answer.self_motion.rows() == 0;
}

bool allAreTold(const SerialChain& chain, const Task& task, const Pose& target, const SolutionBuilder& builder,
                const std::vector<IkAnswer>& answers) {
  return std::all_of(answers.begin(), answers.end(), [&](const IkAnswer& answer) {
    const WeakDirections* weak = isIsolated(answer) ? builder.weakDirectionsAt(answer.position) : nullptr;
    return weak == nullptr || isTold(chain, task, target, answer.position, *weak);
  });
}

}  // namespace

bool completeAlmostSingular(const SerialChain& chain, const Task& task, const Pose& target, std::optional<double> bound,
                            const SolutionBuilder& builder, std::vector<IkAnswer>& answers) {
  if (!bound) return allAreTold(chain, task, target, builder, answers);
  bool told = true;
  std::vector<IkAnswer> mates;
  std::vector<bool> between(answers.size(), false);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!isIsolated(answers[i]) || !(answers[i].manipulability <= *bound)) continue;
    const auto isAt = [&](const IkAnswer& answer, const VectorX& place, double distance) {
      return isIsolated(answer) && largestDifference(chain, answer.position, place) <= distance;
    };
    const auto isAtHand = [&](const VectorX& place, double distance) {
      for (std::size_t k = 0; k < answers.size(); ++k) {
        if (k != i && !between[k] && isAt(answers[k], place, distance)) return true;
      }
      return std::any_of(mates.begin(), mates.end(), [&](const IkAnswer& mate) { return isAt(mate, place, distance); });
    };
    // What points somewhere has rows of its own in the residual.
    const WeakDirections* known = task.pointingAxis() < 0 ? builder.weakDirectionsAt(answers[i].position) : nullptr;
    const SolutionsAbout about = solutionsAbout(chain, task, target, answers[i].position, known, isAtHand);
    for (const VectorX& q : about.solutions) {
      Candidate candidate = unnamed(q);
      candidate.branch = answers[i].branch;
      std::optional<IkAnswer> mate = builder.build(std::move(candidate));
      if (mate && !isAtHand(mate->position, kSameSolution)) mates.push_back(std::move(*mate));
    }
    between[i] = !about.is_one;
    told = told && about.is_told;
  }
  std::vector<IkAnswer> all;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!between[i]) all.push_back(std::move(answers[i]));
  }
  std::move(mates.begin(), mates.end(), std::back_inserter(all));
  answers = std::move(all);
  return told;
}

}  // namespace screwline
