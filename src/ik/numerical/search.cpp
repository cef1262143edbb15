#include <algorithm>

#include "descent.h"
#include "solution_set.h"

namespace screwline {
namespace {

/// Rotation beside translation, in units of length: what solves most poses per iteration.
constexpr double kSearchWeight = 0.5;

/// Start `index`: the given ones first.
VectorX startOf(const JointBox& box, const std::vector<VectorX>& starts, int index) {
  const int given = static_cast<int>(starts.size());
  return index < given ? starts[static_cast<std::size_t>(index)] : box.restart(index - given + 1);
}

}  // namespace

SearchResult search(const SerialChain& chain, const Task& task, const Pose& target, const std::vector<VectorX>& starts,
                    const SearchOptions& options) {
  const Watch watch(options.timeout, options.cancelled);
  DescentOptions descent_options = options.descent;
  descent_options.rotation_weight = kSearchWeight * lengthUnit(chain);
  Descent descent(chain, task, target, descent_options, watch);
  SearchResult result;
  const int count = std::max(1, static_cast<int>(starts.size()) + options.restarts);
  for (int index = 0; index < count; ++index) {
    if (watch.expired() && index > 0) {
      result.timed_out = true;
      break;
    }
    descent.run(startOf(descent.box(), starts, index), DescentGoal::kSolution);
    ++result.descents;
    const TaskPoint& end = descent.point();
    const double weight = options.descent.rotation_weight;
    if (index == 0 || end.error.weighted(weight) < result.best.error.weighted(weight)) result.best = descent.result();
    if (!isAccepted(end.error)) continue;
    if (indexOfKnown(chain, task, descent.box(), result.solutions, end.q, end.error) >= 0) continue;
    result.solutions.emplace_back(end.q);
    descent.box().wrapUnbounded(result.solutions.back());
    if (static_cast<int>(result.solutions.size()) == options.max_solutions) break;
  }
  return result;
}

}  // namespace screwline
