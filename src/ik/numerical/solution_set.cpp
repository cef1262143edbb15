#include "solution_set.h"

#include <algorithm>

#include "screwline/spatial/svd.h"

namespace screwline {
namespace {

constexpr double kSame = 1e-6;         ///< Every joint closer: one solution.
constexpr double kPerhapsSame = 1e-3;  ///< Closer: one solution where it is known no better than that.
constexpr double kRounding = 1e-15;    ///< Of the chain's size: what forward kinematics leaves of the residual.
constexpr double kBandFactor = 10.0;

/// How far off a solution may be in joint space: residual over the smallest singular value.
double jointBand(const SerialChain& chain, const Task& task, const ConstVectorRef& q, double residual) {
  const Svd svd(taskJacobian(chain, q, task));
  const double smallest = svd.singularValues().minCoeff();
  return smallest > 0.0 ? kBandFactor * (residual + kRounding * (1.0 + lengthUnit(chain))) / smallest : kPerhapsSame;
}

}  // namespace

int indexOfKnown(const SerialChain& chain, const Task& task, const JointBox& box, const std::vector<VectorX>& solutions,
                 const ConstVectorRef& q, const TaskError& error) {
  for (std::size_t i = 0; i < solutions.size(); ++i) {
    const double distance = box.distance(solutions[i], q);
    const bool same =
        distance <= kSame ||
        (distance <= kPerhapsSame && distance <= std::min(jointBand(chain, task, q, error.norm()), kPerhapsSame));
    if (same) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace screwline
