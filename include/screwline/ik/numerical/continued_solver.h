#ifndef SCREWLINE_IK_NUMERICAL_CONTINUED_SOLVER_H
#define SCREWLINE_IK_NUMERICAL_CONTINUED_SOLVER_H

#include <functional>
#include <string>
#include <vector>

#include "screwline/ik/task_error.h"
#include "screwline/model/serial_chain.h"

namespace screwline {

/// A solution of the ideal chain, as its exact solver gives it.
struct IdealSolution {
  VectorX q;
  std::string branch;
  std::vector<int> free;  ///< Joints that parametrise a continuum, q being one of its members; empty: isolated.
};

/// Every solution of the ideal chain for a pose; free joints are set from `preferred` (n values). Must be safe to call
/// from many threads.
using IdealSolver = std::function<std::vector<IdealSolution>(const Pose& target, const VectorX& preferred)>;

struct ContinuedSolution {
  VectorX q;           ///< Revolute joints in (-pi, pi] where a full turn changes nothing; limits are not looked at.
  std::string branch;  ///< Of the ideal chain's solution next to q, for the pose that the ideal chain has at q.
  int free = -1;       ///< Joint that parametrises a continuum of the true chain, of which q is the member next to the
                       ///< ideal one; -1: isolated.
  TaskError error;     ///< Below 1e-9, of the true chain.
};

struct ContinuedSolutions {
  std::vector<ContinuedSolution> solutions;  ///< Different from each other.
  int ideal = 0;                             ///< Isolated solutions of the ideal chain for the pose.
  int vanished = 0;  ///< Of those, such as the true chain does not have: two that met have gone out of reach.
  int appeared = 0;  ///< Solutions that the ideal chain does not have, at the rim of its reach or on a continuum of it.
  bool complete = true;  ///< Every ideal solution was followed to a solution or to where it vanishes.
  bool timed_out = false;
};

/// Inverse kinematics of a chain that is almost another one with an exact solver: a calibrated arm, or one whose
/// description has rounded numbers. Every exact solution of the ideal chain is the start of a descent on the true one.
/// Where solutions are about to meet, singularities move by the square root of the difference between the chains, and
/// solutions appear or vanish: there the curve on which they lie is followed and searched for all of them, also for
/// poses just out of the ideal chain's reach and next to its continua, of which the true chain has some isolated
/// members. Immutable; solve() may be called from many threads, allocates, is deterministic unless time runs out.
class ContinuedSolver {
 public:
  /// @pre both chains have as many joints, the task's rows are those that `solver` solves. With more joints than rows
  /// the members nearest to the ideal ones are found, and `complete` is true only away from singularities.
  ContinuedSolver(const SerialChain& chain, const SerialChain& ideal, const Task& task, IdealSolver solver);

  /// `timeout` [s].
  ContinuedSolutions solve(const Pose& target, const VectorX& preferred, double timeout = 0.1) const;

  /// Largest distance [m] and angle [rad] between the two chains' poses over a sample of configurations.
  double positionDeviation() const { return position_deviation_; }
  double rotationDeviation() const { return rotation_deviation_; }

 private:
  SerialChain chain_;
  SerialChain ideal_;
  Task task_;
  IdealSolver solver_;
  double position_deviation_ = 0.0;
  double rotation_deviation_ = 0.0;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_NUMERICAL_CONTINUED_SOLVER_H
