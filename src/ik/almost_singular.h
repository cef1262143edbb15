#ifndef SCREWLINE_SRC_IK_ALMOST_SINGULAR_H
#define SCREWLINE_SRC_IK_ALMOST_SINGULAR_H

#include <optional>
#include <vector>

#include "solution_builder.h"

namespace screwline {

/// Puts right what rounding does to isolated solutions of manipulability up to `bound`: those that they are about to
/// meet are added where they are missing, those that stand between two are taken away. False where the pose does not
/// tell one of them from a curve of configurations. As many joints as rows.
/// @param bound none: the list has all of its double solutions, and is only asked whether they are told.
bool completeAlmostSingular(const SerialChain& chain, const Task& task, const Pose& target, std::optional<double> bound,
                            const SolutionBuilder& builder, std::vector<IkAnswer>& answers);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ALMOST_SINGULAR_H
