#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "descent.h"
#include "screwline/kinematics/jacobian.h"

namespace screwline {
namespace {

constexpr double kAccepted = 1e-9;     ///< [m], [rad] that a solution's errors stay below.
constexpr double kSame = 1e-6;         ///< Every joint closer: one solution.
constexpr double kPerhapsSame = 1e-3;  ///< Closer: one solution where it is known no better than that.
constexpr double kRounding = 1e-15;    ///< Of the chain's size: what forward kinematics leaves of the residual.
constexpr double kBandFactor = 10.0;
/// Rotation beside translation, in units of length: what solves most poses per iteration.
constexpr double kSearchWeight = 0.5;

/// Start `index`: the given ones first.
VectorX startOf(const JointBox& box, const std::vector<VectorX>& starts, int index) {
  const int given = static_cast<int>(starts.size());
  return index < given ? starts[static_cast<std::size_t>(index)] : box.restart(index - given + 1);
}

/// How far off a solution may be in joint space: residual over the smallest singular value.
double jointBand(const SerialChain& chain, const Task& task, const VectorX& q, double residual) {
  Matrix6X J;
  geometricJacobian(chain, q, J);
  const Eigen::JacobiSVD<MatrixX> svd(task.select(J));
  const double smallest = svd.singularValues().minCoeff();
  return smallest > 0.0 ? kBandFactor * (residual + kRounding * (1.0 + lengthUnit(chain))) / smallest : kPerhapsSame;
}

bool isKnown(const SerialChain& chain, const Task& task, const JointBox& box, const std::vector<VectorX>& solutions,
             const TaskPoint& point) {
  for (const VectorX& known : solutions) {
    const double distance = box.distance(known, point.q);
    if (distance <= kSame) return true;
    if (distance > kPerhapsSame) continue;
    if (distance <= std::min(jointBand(chain, task, point.q, point.error.norm()), kPerhapsSame)) return true;
  }
  return false;
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
    if (!(end.error.position < kAccepted && end.error.orientation < kAccepted)) continue;
    if (isKnown(chain, task, descent.box(), result.solutions, end)) continue;
    result.solutions.emplace_back(end.q);
    descent.box().wrapUnbounded(result.solutions.back());
    if (static_cast<int>(result.solutions.size()) == options.max_solutions) break;
  }
  return result;
}

}  // namespace screwline
