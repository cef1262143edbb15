#ifndef SCREWLINE_SRC_KINEMATICS_NEAREST_SINGULARITY_H
#define SCREWLINE_SRC_KINEMATICS_NEAREST_SINGULARITY_H

#include <limits>
#include <string>
#include <vector>

#include "screwline/kinematics/singularity_factors.h"

namespace screwline {

struct NearestSingularity {
  VectorX q;  ///< Empty: none found.
  double distance = std::numeric_limits<double>::infinity();
  bool within_limits = false;
  std::string note;
};

/// A singular configuration near q: always one that taskRank() calls singular; so the distance is an upper bound on the
/// true one. It is exact where all factors depend on one joint each. Deterministic.
NearestSingularity nearestSingularity(const TaskDeterminant& determinant, const VectorX& q,
                                      const std::vector<SingularityFactor>& factors, bool singular);

}  // namespace screwline

#endif  // SCREWLINE_SRC_KINEMATICS_NEAREST_SINGULARITY_H
