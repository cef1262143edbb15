#ifndef SCREWLINE_IK_BATCH_H
#define SCREWLINE_IK_BATCH_H

#include <cstdint>
#include <functional>
#include <vector>

#include "screwline/ik/inverse_kinematics.h"

namespace screwline {

/// What a batch of inverse kinematics is asked for.
struct IkBatchRequest {
  const Pose* targets = nullptr;  ///< count, X_BT wanted, base frame; only the task's rows are read.
  std::size_t count = 0;
  IkRequest each;        ///< What is asked of every pose; its target is not read, and nothing closest is searched.
  int threads = 1;       ///< At most; 0: as many as cores.
  double time = 3600.0;  ///< [s] for the whole batch: what is not begun then has no solutions.
  std::size_t most_numbers = 100000000;  ///< That `positions` may hold.
  std::function<bool()> cancelled;  ///< Asked by the calling thread every few poses; true: no further pose is begun.
};

/// The solutions of many poses, pose after pose.
struct IkBatchResult {
  std::vector<std::uint32_t> counts;  ///< count: solutions of each pose, as InverseKinematics::solve() lists them.
  std::vector<double> positions;      ///< Sum of counts x n [rad, m]: the first pose's solutions, the second's, ...
  std::vector<std::uint8_t>
      complete;  ///< count: 1 where no solution is missing, also where it is proved that there is none.
  std::size_t without_solution = 0;  ///< Poses with none.
  std::size_t not_begun = 0;         ///< Poses left out because the time was over or the batch cancelled.
  bool timed_out = false;            ///< Of the batch or, where solutions are searched numerically, of a pose.
};

/// Every pose by InverseKinematics::solve(), several at a time. The result does not depend on the number of threads
/// (unless time runs out). Allocates.
/// @throws InputError: what solve() refuses, with the pose's row in the message, before any pose is solved; kTooLarge
/// where the solutions have more numbers than most_numbers.
IkBatchResult solveBatch(const InverseKinematics& solver, const IkBatchRequest& request);

}  // namespace screwline

#endif  // SCREWLINE_IK_BATCH_H
