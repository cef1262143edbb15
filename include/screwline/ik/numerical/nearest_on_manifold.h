#ifndef SCREWLINE_IK_NUMERICAL_NEAREST_ON_MANIFOLD_H
#define SCREWLINE_IK_NUMERICAL_NEAREST_ON_MANIFOLD_H

#include "screwline/ik/task_error.h"
#include "screwline/model/serial_chain.h"

namespace screwline {

struct NearestOptions {
  double tolerance = 1e-6;  ///< Of the projected gradient: rad, and m over the chain's characteristic length.
  int max_iterations = 200;
  bool honour_limits = true;
};

struct NearestResult {
  VectorX q;
  TaskError error;
  double distance = 0.0;   ///< Norm of q - seed, as it is: rad and m.
  bool converged = false;  ///< A local minimum of the distance within limits, to the tolerance.
  int iterations = 0;
};

/// From a solution of a redundant chain along its self-motion to the one that is (locally) nearest to the seed, within
/// limits: projected gradient steps, with joints that press against a limit held there, each brought back to the task
/// by Newton steps and taken only where it is nearer and a solution still (errors below 1e-9). Full turns are taken as
/// they are. A start that is no solution, or outside honoured limits, is returned unchanged, not converged. Allocates;
/// deterministic; some 10 us per step.
NearestResult nearestOnManifold(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& start,
                                const VectorX& seed, const NearestOptions& options = {});

}  // namespace screwline

#endif  // SCREWLINE_IK_NUMERICAL_NEAREST_ON_MANIFOLD_H
