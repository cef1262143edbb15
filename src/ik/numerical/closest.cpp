#include <algorithm>
#include <cmath>

#include "descent.h"

namespace screwline {
namespace {

constexpr std::size_t kMaxFinished = 40;  ///< Estimates that are followed to their minimum.
constexpr double kSameMinimum = 1e-2;     ///< Scaled; estimates nearer to a finished one end where it did.
constexpr double kTie = 1e-11;            ///< Relative; between minima that are equal the nearest to the start counts.

struct Candidate {
  VectorX q;
  double cost = 0.0;
};

/// Ends of short descents, best first; the only one where it is a solution.
std::vector<Candidate> estimates(Descent& descent, const std::vector<VectorX>& starts, int count, const Watch& watch) {
  std::vector<Candidate> found;
  const int given = static_cast<int>(starts.size());
  for (int index = 0; index < count; ++index) {
    if (index > 0 && watch.expired()) break;
    const VectorX start =
        index < given ? starts[static_cast<std::size_t>(index)] : descent.box().restart(index - given + 1);
    descent.run(start, DescentGoal::kSolution);
    found.push_back({descent.point().q, descent.point().cost});
    if (descent.converged()) return {found.back()};
  }
  std::stable_sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return found;
}

bool isNearAny(const JointBox& box, const std::vector<DescentResult>& minima, const VectorX& q) {
  return std::any_of(minima.begin(), minima.end(),
                     [&](const DescentResult& minimum) { return box.distance(minimum.q, q) < kSameMinimum; });
}

}  // namespace

DescentResult closestReachable(const SerialChain& chain, const Task& task, const Pose& target,
                               const std::vector<VectorX>& starts, const SearchOptions& options) {
  const Watch watch(options.timeout, options.cancelled);
  Descent descent(chain, task, target, options.descent, watch);
  const int count = std::max(1, static_cast<int>(starts.size()) + options.restarts);
  std::vector<DescentResult> minima;
  for (const Candidate& candidate : estimates(descent, starts, count, watch)) {
    if (minima.size() == kMaxFinished) break;
    if (isNearAny(descent.box(), minima, candidate.q)) continue;
    descent.run(candidate.q, DescentGoal::kMinimum);
    minima.push_back(descent.result());
    if (watch.expired()) break;
  }
  const double weight = options.descent.rotation_weight;
  double least = minima.front().error.weighted(weight);
  for (const DescentResult& minimum : minima) least = std::min(least, minimum.error.weighted(weight));
  const VectorX origin = starts.empty() ? chain.clamped(VectorX::Zero(chain.size())) : starts.front();
  const DescentResult* best = nullptr;
  for (const DescentResult& minimum : minima) {
    if (minimum.error.weighted(weight) > least + kTie * (1.0 + least)) continue;
    if (best == nullptr || (minimum.q - origin).norm() < (best->q - origin).norm()) best = &minimum;
  }
  DescentResult result = *best;
  descent.box().wrapUnbounded(result.q);
  return result;
}

}  // namespace screwline
