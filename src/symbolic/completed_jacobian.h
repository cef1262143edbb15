#ifndef SCREWLINE_SRC_SYMBOLIC_COMPLETED_JACOBIAN_H
#define SCREWLINE_SRC_SYMBOLIC_COMPLETED_JACOBIAN_H

#include "exact_chain.h"
#include "screwline/model/task.h"

namespace screwline {

/// The chain's Jacobian [v; w] of the point of the tip's link at the origin of frame `point`, in the axes of frame
/// `axes`, and beside it a twist for each row that the task leaves out: along or about that row's axis. A wrench that
/// does no work on any of these columns is what the task loses, whatever its rows are. 6 x (joints + 6 - task.size()).
TrigMatrix completedJacobian(const ExactChain& exact, const Task& task, int axes, int point);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_COMPLETED_JACOBIAN_H
