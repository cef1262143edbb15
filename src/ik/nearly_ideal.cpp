#include "nearly_ideal.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "parallel_candidates.h"
#include "plan_candidates.h"
#include "screwline/ik/numerical/ideal_geometry.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/kinematics/jacobian.h"
#include "task_conditioning.h"

namespace screwline {
namespace {

constexpr int kMostIterations = 20;  // Of a descent: an ideal solution that is near needs a few.
constexpr double kClear = 4.0;       // Times near_singular_, whose square over the chain's length is the deviation.
constexpr double kReach = 2.0;       // First steps of Newton's method within which its end lies.

std::vector<IdealSolution> ideally(const std::vector<Candidate>& candidates) {
  std::vector<IdealSolution> solutions;
  for (const Candidate& candidate : candidates) solutions.push_back({candidate.q, candidate.branch, candidate.free});
  return solutions;
}

/// Every solution of the ideal chain; empty where it has no closed form.
IdealSolver exactSolver(const std::shared_ptr<const SerialChain>& chain, const Task& task) {
  if (const std::optional<TaskPlan> plan = planFor(*chain, task)) {
    const auto kept = std::make_shared<const TaskPlan>(*plan);
    return [chain, kept](const Pose& target, const VectorX& preferred) {
      return ideally(candidatesOf(*kept, *chain, target, preferred));
    };
  }
  if (const std::optional<ParallelMethod> parallel = parallelMethodFor(*chain, task)) {
    const auto kept = std::make_shared<const ParallelMethod>(*parallel);
    return [chain, kept](const Pose& target, const VectorX& preferred) {
      return ideally(candidatesOf(*kept, *chain, target, preferred, false).found);
    };
  }
  return nullptr;
}

}  // namespace

NearlyIdeal::NearlyIdeal(const SerialChain& chain, const SerialChain& ideal, const Task& task, const IdealSolver& exact)
    : chain_(chain), task_(task), exact_(exact), continued_(chain, ideal, task, exact) {
  const double length = chain.characteristicLength();
  deviation_ = std::hypot(continued_.positionDeviation(), continued_.rotationDeviation());
  near_singular_ =
      std::sqrt(length * std::hypot(continued_.positionDeviation(), length * continued_.rotationDeviation()));
}

std::optional<NearlyIdeal> NearlyIdeal::compile(const SerialChain& chain, const Task& task) {
  const std::optional<IdealGeometry> ideal = idealized(chain);
  if (!ideal) return std::nullopt;
  const IdealSolver exact = exactSolver(std::make_shared<const SerialChain>(ideal->chain), task);
  if (!exact) return std::nullopt;
  return NearlyIdeal(chain, ideal->chain, task, exact);
}

/// Whether every ideal solution leads to one of its own. A singular one may lead to two; from one that is clear of
/// singularities Newton's method goes to the only solution near (Kantorovich: its first step, times the second
/// derivative over the least singular value, is small), and need not be sent there.
bool NearlyIdeal::confirms(const Pose& target, const VectorX& seed, const std::vector<Candidate>& found) const {
  DescentOptions options;
  options.honour_limits = false;
  options.max_iterations = kMostIterations;
  std::vector<bool> taken(found.size(), false);
  Matrix6X J;
  for (const IdealSolution& ideal : exact_(target, seed)) {
    if (!ideal.free.empty()) return false;
    geometricJacobian(chain_, ideal.q, J);
    const double least = conditioningOf(task_.select(J), 0.0).smallest;
    if (least < near_singular_) return false;
    const auto knownWithin = [&](const VectorX& q, double reach) {
      return std::find_if(found.begin(), found.end(), [&](const Candidate& candidate) {
        return largestDifference(chain_, candidate.q, q) <= reach;
      });
    };
    auto known = found.end();
    if (least > kClear * near_singular_) known = knownWithin(ideal.q, kReach * deviation_ / least);
    if (known == found.end()) {
      VectorX q = descend(chain_, task_, target, ideal.q, options).q;
      polish(chain_, task_, target, q);
      known = knownWithin(q, kSameSolution);
    }
    const auto place = static_cast<std::size_t>(known - found.begin());
    if (known == found.end() || taken[place]) return false;
    taken[place] = true;
  }
  return true;
}

bool NearlyIdeal::addMissing(const Pose& target, const VectorX& seed, double timeout,
                             std::vector<Candidate>& found) const {
  if (confirms(target, seed, found)) return true;
  const ContinuedSolutions continued = continued_.solve(target, seed, timeout);
  bool complete = continued.complete;
  for (const ContinuedSolution& solution : continued.solutions) {
    if (solution.free >= 0) complete = false;  // Of a continuum a member is known, and not the rest.
    const bool known = std::any_of(found.begin(), found.end(), [&](const Candidate& candidate) {
      return isSameConfiguration(chain_, candidate.q, solution.q);
    });
    if (!known) found.push_back(unnamed(solution.q));
  }
  return complete;
}

}  // namespace screwline
