#ifndef SCREWLINE_SRC_SYMBOLIC_LOST_CHECK_H
#define SCREWLINE_SRC_SYMBOLIC_LOST_CHECK_H

#include <vector>

#include "exact_chain.h"
#include "screwline/symbolic/lost_direction.h"

namespace screwline {

constexpr double kLossAgreement = 1e-9;  ///< A direction that misses this is not given.

/// What lost directions are compared at.
struct LossPoints {
  const ExactChain& exact;
  const SerialChain& chain;
  const Task& task;
  const std::vector<VectorX>& points;  ///< Configurations where the condition holds.
};

/// The largest deviation of ConditionLoss; infinite where the directions are not `lost` independent ones, or vanish at
/// all points.
double lossDeviation(const LossPoints& given, const std::vector<LostDirection>& directions, int lost);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_LOST_CHECK_H
