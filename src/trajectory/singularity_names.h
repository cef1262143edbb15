#ifndef SCREWLINE_SRC_TRAJECTORY_SINGULARITY_NAMES_H
#define SCREWLINE_SRC_TRAJECTORY_SINGULARITY_NAMES_H

#include <string>
#include <vector>

#include "screwline/kinematics/singularity_factors.h"

namespace screwline {

/// What a singularity is called: the factor of the task determinant that is nearest to zero.
class SingularityNames {
 public:
  SingularityNames(const SerialChain& chain, const Task& task) : factors_(factorsOf(chain, task)) {}

  /// "wrist (sin(theta5) = 0)"; "rank" where the determinant has no factors.
  std::string nearest(const VectorX& q) const;

 private:
  std::vector<SingularityFactor> factors_;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_SINGULARITY_NAMES_H
