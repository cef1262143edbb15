#ifndef SCREWLINE_IK_NUMERICAL_NUMERICAL_SOLVER_H
#define SCREWLINE_IK_NUMERICAL_NUMERICAL_SOLVER_H

#include <functional>
#include <vector>

#include "screwline/ik/task_error.h"
#include "screwline/kinematics/jacobian.h"

namespace screwline {

/// Numerical inverse kinematics for any chain and task. All functions are deterministic (the same input gives the same
/// bytes, unless time runs out), allocate, and may be called from many threads. @pre: starts have chain.size() finite
/// values, the target is finite and its R a rotation. Where limits are honoured, starts are clamped into them first,
/// and every configuration returned lies within them, without tolerance. A joint that can make a full turn within its
/// limits passes from one to the other.

/// One descent from a start.
struct DescentResult {
  VectorX q;
  TaskError error;
  bool converged = false;  ///< Both errors at most the tolerance.
  int iterations = 0;
};

struct DescentOptions {
  double tolerance = 1e-12;      ///< [m], [rad]
  int max_iterations = 100;      ///< First-order and second-order steps together.
  bool honour_limits = true;     ///< Stay within the chain's position limits at every step.
  double rotation_weight = 1.0;  ///< [m/rad] in the norm that is minimised.
};

/// Levenberg-Marquardt on the task error with damping in proportion to it (Sugihara 2011), limits by projection with an
/// active set; then steps with the whole Hessian (by differences of the gradient) where the pose cannot be reached, to
/// a local minimum of the weighted error: its value is accurate to rounding there, and a saddle, as a straight arm with
/// the target along it, is left along its negative curvature. A solution is refined until steps are below 1e-10 or gain
/// nothing. Joints without limits stay in the turn of the start.
/// About 1 us per first-order step of six joints; such steps do not allocate.
DescentResult descend(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& start,
                      const DescentOptions& options);

/// Newton steps (least norm, rank revealing) on a configuration that is almost a solution, taken only while they lessen
/// the error: to machine precision, without leaving the solution's branch or turn (steps above 1e-3 rad or m are
/// refused). Limits are not looked at. Returns the final error.
TaskError polish(const SerialChain& chain, const Task& task, const Pose& target, VectorX& q);

struct SearchOptions {
  DescentOptions descent;
  int max_solutions = 0;  ///< Stop when so many different ones are found; 0: search until `restarts`.
  /// Deterministic quasi-random starts within limits, after the given ones. Where there are no limits: a full turn, or
  /// to both sides two characteristic lengths or twice the target's distance from home.
  int restarts = 256;
  double timeout = 0.1;             ///< [s] Looked at every few iterations; the first descent begins in any case.
  std::function<bool()> cancelled;  ///< Asked as often; may be empty.
};

struct SearchResult {
  /// Errors below 1e-9, in the order found. Different from each other by more than 1e-6 rad or characteristic lengths
  /// in some joint (revolute joints modulo 2 pi), and by more than the residual over the smallest singular value leaves
  /// uncertain. Of a continuum, the members that were met. Joints without limits are in (-pi, pi].
  std::vector<VectorX> solutions;
  DescentResult best;      ///< Least weighted error met; no minimum where it is not a solution: see closestReachable().
  bool timed_out = false;  ///< Or cancelled.
  int descents = 0;
};

/// Descents from the given starts (the seed, solutions of a nearby ideal geometry, ...; clamped zero is not added) and
/// then from restarts. A descent is given up as soon as it is seen to end above zero. Inside, rotation counts by half
/// the characteristic length, whatever `options.descent.rotation_weight` is; that decides about `best` only.
SearchResult search(const SerialChain& chain, const Task& task, const Pose& target, const std::vector<VectorX>& starts,
                    const SearchOptions& options);

/// The configuration nearest to the target in the weighted error: descents from the given starts and from restarts, of
/// which the most promising are followed to their minimum. Of minima that are equal within 1e-11, the one nearest to
/// the first start. A local minimum for certain (unless time runs out or max_iterations are used up), the global one
/// with high probability only: for whole poses out of reach of five arms of 6 and 7 joints, 256 restarts (3 to 5 ms)
/// missed nothing that 2048 found in 200 poses each, 64 restarts (2 to 3 ms) 1 %, 8 restarts up to a third.
DescentResult closestReachable(const SerialChain& chain, const Task& task, const Pose& target,
                               const std::vector<VectorX>& starts, const SearchOptions& options);

}  // namespace screwline

#endif  // SCREWLINE_IK_NUMERICAL_NUMERICAL_SOLVER_H
