#ifndef SCREWLINE_IK_NUMERICAL_NUMERICAL_SOLVER_H
#define SCREWLINE_IK_NUMERICAL_NUMERICAL_SOLVER_H

#include <functional>
#include <vector>

#include "screwline/ik/task_error.h"
#include "screwline/kinematics/jacobian.h"

namespace screwline {

/// One descent from a start.
struct DescentResult {
  VectorX q;
  TaskError error;
  bool converged = false;  ///< Both errors below the tolerance.
  int iterations = 0;
};

struct DescentOptions {
  double tolerance = 1e-12;  ///< [m], [rad]
  int max_iterations = 60;
  bool honour_limits = true;     ///< Stay within the chain's position limits at every step.
  double rotation_weight = 1.0;  ///< [m/rad] in the norm that is minimised.
};

/// Levenberg-Marquardt on the task error with damping in proportion to it (Sugihara 2011), limits by projection with an
/// active set. Where the pose cannot be reached it ends at a local minimum of the weighted error. Deterministic.
DescentResult descend(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& start,
                      const DescentOptions& options);

/// Newton steps on a configuration that is almost a solution, taken only while they lessen the error: to machine
/// precision, without leaving the solution's branch (steps above 1e-3 rad or m are refused). Returns the final error.
TaskError polish(const SerialChain& chain, const Task& task, const Pose& target, VectorX& q);

struct SearchOptions {
  DescentOptions descent;
  int max_solutions = 0;  ///< Stop when so many different ones are found; 0: search until `restarts`.
  int restarts =
      64;  ///< Deterministic quasi-random starts within limits (full turns where there are none), after the seed.
  double timeout = 0.1;             ///< [s]
  std::function<bool()> cancelled;  ///< Asked between descents; may be empty.
};

struct SearchResult {
  std::vector<VectorX> solutions;  ///< Different by more than 1e-6 (revolute joints modulo 2 pi), in the order found.
  DescentResult best;              ///< Least weighted error met.
  bool timed_out = false;
  int descents = 0;
};

/// Descents from the given starts (the seed, solutions of a nearby ideal geometry, ...) and then from restarts.
SearchResult search(const SerialChain& chain, const Task& task, const Pose& target, const std::vector<VectorX>& starts,
                    const SearchOptions& options);

/// The configuration nearest to the target in the weighted error, from several starts; for poses out of reach or out of
/// limits.
DescentResult closestReachable(const SerialChain& chain, const Task& task, const Pose& target,
                               const std::vector<VectorX>& starts, const SearchOptions& options);

}  // namespace screwline

#endif  // SCREWLINE_IK_NUMERICAL_NUMERICAL_SOLVER_H
