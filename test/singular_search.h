#ifndef SCREWLINE_TEST_SINGULAR_SEARCH_H
#define SCREWLINE_TEST_SINGULAR_SEARCH_H

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

/// Solutions that descents from many starts find for the pose of q and inverse kinematics has not, on no continuum
/// either. `max_solutions`: of inverse kinematics.
inline int missedSolutions(const InverseKinematics& ik, const VectorX& q, int restarts, int max_solutions = 0) {
  const IkGate gate(ik, q, true);
  IkRequest request = gate.request();
  request.max_solutions = max_solutions;
  const IkResult result = ik.solve(request);
  SearchOptions options;
  options.restarts = restarts;
  options.timeout = 60.0;
  options.descent.honour_limits = false;
  int missed = 0;
  for (VectorX& found : search(ik.chain(), ik.task(), request.target, {}, options).solutions) {
    const double error = polish(ik.chain(), ik.task(), request.target, found).norm();
    // Next to a double root an error is worth its square root.
    const double tolerance = 1e-5 + 4.0 * std::sqrt(error) + placeTolerance(ik.chain(), ik.task(), found);
    if (!gate.isKnown(found, result, tolerance)) ++missed;
  }
  return missed;
}

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_SINGULAR_SEARCH_H
