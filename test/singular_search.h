#ifndef SCREWLINE_TEST_SINGULAR_SEARCH_H
#define SCREWLINE_TEST_SINGULAR_SEARCH_H

#include <Eigen/QR>
#include <algorithm>
#include <vector>

#include "ik_gate.h"
#include "screwline/ik/numerical/numerical_solver.h"

namespace screwline {
namespace test {

/// Distances from a singular pose that are looked at [rad, m].
inline const std::vector<double>& singularOffsets() {
  static const std::vector<double> offsets = {0.0, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3};
  return offsets;
}

/// Newton's method, steps of least norm, until rounding is reached: what does not get there only comes near to the
/// pose, as all members of a continuum beside the pose do. False there.
inline bool isTrueSolution(const InverseKinematics& ik, const Pose& target, VectorX& q) {
  constexpr double kLongestStep = 0.3;  // [rad, m]
  const double rounding = 2e-15 * (1.0 + ik.chain().characteristicLength());
  Matrix6X J;
  for (int k = 0; k < 100; ++k) {
    const Pose tip = geometricJacobian(ik.chain(), q, J);
    const TaskError error = taskError(ik.task(), target, tip);
    if (error.norm() <= rounding) return true;
    const VectorX step =
        ik.task().select(J, tip.R).completeOrthogonalDecomposition().solve(ik.task().select(error.twist, tip.R));
    q += std::min(1.0, kLongestStep / step.norm()) * step;
  }
  return false;
}

/// Solutions that descents from many starts find for the pose of q and inverse kinematics has not, on no continuum
/// either. `max_solutions`: of inverse kinematics. Of a redundant chain, every start finds another member: the first
/// few are looked at.
inline int missedSolutions(const InverseKinematics& ik, const VectorX& q, int restarts, int max_solutions = 0) {
  constexpr int kMembers = 8;
  const IkGate gate(ik, q, true);
  IkRequest request = gate.request();
  request.max_solutions = max_solutions;
  const IkResult result = ik.solve(request);
  const bool redundant = ik.chain().size() > ik.task().size();
  SearchOptions options;
  options.restarts = redundant ? kMembers : restarts;
  options.timeout = 60.0;
  options.descent.honour_limits = false;
  int missed = 0;
  for (VectorX& found : search(ik.chain(), ik.task(), request.target, {}, options).solutions) {
    const double error = polish(ik.chain(), ik.task(), request.target, found).norm();
    if (!isTrueSolution(ik, request.target, found)) continue;
    // Next to a double root an error is worth its square root.
    const double tolerance = 1e-5 + 4.0 * std::sqrt(error) + placeTolerance(ik.chain(), ik.task(), found);
    if (!gate.isKnown(found, result, tolerance)) ++missed;
  }
  return missed;
}

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_SINGULAR_SEARCH_H
