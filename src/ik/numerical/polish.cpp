#include <Eigen/QR>

#include "screwline/ik/numerical/numerical_solver.h"
#include "task_residual.h"

namespace screwline {
namespace {

constexpr double kLongestStep = 1e-3;    ///< [rad], [m]
constexpr double kShortestStep = 1e-12;  ///< [rad], [m]
constexpr int kMaxSteps = 32;            ///< A double root takes one per bit.
constexpr int kMaxFailed = 3;  ///< Steps that do not help: the valley of an almost double root is bent, one may climb.

}  // namespace

TaskError polish(const SerialChain& chain, const Task& task, const Pose& target, VectorX& q) {
  TaskResidual residual(chain, task, target, 1.0);
  TaskPoint best;
  best.q = q;
  residual.evaluate(best);
  TaskPoint point = best;
  int failed = 0;
  for (int k = 0; k < kMaxSteps && failed < kMaxFailed && point.cost > 0.0; ++k) {
    // Least norm, least squares, rank revealing: at a singular solution the directions that do nothing are left alone.
    const Eigen::CompleteOrthogonalDecomposition<TaskMatrix> factor(point.J);
    const VectorX step = factor.solve(point.residual);
    const double longest = step.cwiseAbs().maxCoeff();
    if (!(longest <= kLongestStep) || longest < kShortestStep) break;
    point.q += step;
    residual.evaluate(point);
    const bool better = point.cost < best.cost;
    failed = better ? 0 : failed + 1;
    if (better) best = point;
  }
  q = best.q;
  return best.error;
}

}  // namespace screwline
