#include <Eigen/QR>

#include "screwline/ik/numerical/numerical_solver.h"
#include "task_residual.h"

namespace screwline {
namespace {

constexpr double kLongestStep = 1e-3;    ///< [rad], [m]
constexpr double kShortestStep = 1e-12;  ///< [rad], [m]
constexpr int kMaxSteps = 32;            ///< A double root takes one per bit.

}  // namespace

TaskError polish(const SerialChain& chain, const Task& task, const Pose& target, VectorX& q) {
  TaskResidual residual(chain, task, target, 1.0);
  TaskPoint points[2];
  TaskPoint* current = &points[0];
  TaskPoint* trial = &points[1];
  current->q = q;
  residual.evaluate(*current);
  for (int k = 0; k < kMaxSteps && current->cost > 0.0; ++k) {
    // Least norm, least squares, rank revealing: at a singular solution the directions that do nothing are left alone.
    const Eigen::CompleteOrthogonalDecomposition<TaskMatrix> factor(current->J);
    const VectorX step = factor.solve(current->residual);
    const double longest = step.cwiseAbs().maxCoeff();
    if (!(longest <= kLongestStep) || longest < kShortestStep) break;
    trial->q = current->q + step;
    residual.evaluate(*trial);
    if (!(trial->cost < current->cost)) break;
    std::swap(current, trial);
  }
  q = current->q;
  return current->error;
}

}  // namespace screwline
