#ifndef SCREWLINE_SRC_IK_ALMOST_SINGULAR_H
#define SCREWLINE_SRC_IK_ALMOST_SINGULAR_H

#include <vector>

#include "solution_builder.h"

namespace screwline {

/// Puts right what rounding does to isolated solutions of manipulability up to `bound`: those that they are about to
/// meet are added where they are missing, those that stand between two are taken away. False where the pose does not
/// tell one of them from a curve of configurations. As many joints as rows.
bool completeAlmostSingular(const SerialChain& chain, const Task& task, const Pose& target, double bound,
                            const SolutionBuilder& builder, std::vector<IkAnswer>& answers);

/// The same question about a list to which nothing has to be added.
bool allAreTold(const SerialChain& chain, const Task& task, const Pose& target, const SolutionBuilder& builder,
                const std::vector<IkAnswer>& answers);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALMOST_SINGULAR_H
