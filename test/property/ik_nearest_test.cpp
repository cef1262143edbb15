#include <gtest/gtest.h>

#include <cstdio>

#include "published_arms.h"
#include "screwline/ik/numerical/nearest_on_manifold.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/kinematics/singularity.h"

namespace screwline {
namespace {

/// Random steps along the self-motion from q, brought back to the task: none within limits may be nearer.
double nearestBeside(const SerialChain& chain, const Pose& target, const VectorX& q, const VectorX& seed,
                     std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Matrix6X J;
  geometricJacobian(chain, q, J);
  const MatrixX motions = taskRank(J).self_motions;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 40; ++k) {
    VectorX moved = q;
    for (Eigen::Index i = 0; i < motions.rows(); ++i) moved += 3e-3 * unit(random) * motions.row(i).transpose();
    VectorX solution = moved;
    if (polish(chain, Task(), target, solution).norm() > 1e-9) continue;
    if ((chain.clamped(solution) - solution).cwiseAbs().maxCoeff() > 0.0) continue;
    least = std::min(least, (solution - seed).norm());
  }
  return least;
}

TEST(IkNearestOnManifold, NothingBesideItIsNearer) {
  int converged = 0;
  int total = 0;
  for (const test::PublishedArm& arm : {test::panda(), test::iiwa14(), test::iiwaOnRail(), test::pandaOnPlatform()}) {
    const SerialChain chain = chainOf(arm);
    std::mt19937 random(7);
    for (int k = 0; k < 50; ++k, ++total) {
      const VectorX start = test::randomWithinLimits(chain, random);
      const VectorX seed = test::randomWithinLimits(chain, random);
      const Pose target = forwardKinematics(chain, start);
      const NearestResult nearest = nearestOnManifold(chain, Task(), target, start, seed);
      EXPECT_LT(nearest.error.norm(), 1e-9) << arm.name << " " << k;
      EXPECT_EQ((chain.clamped(nearest.q) - nearest.q).cwiseAbs().maxCoeff(), 0.0) << arm.name << " " << k;
      EXPECT_LE(nearest.distance, (start - seed).norm() + 1e-12);
      if (!nearest.converged) continue;
      ++converged;
      EXPECT_GE(nearestBeside(chain, target, nearest.q, seed, random), nearest.distance - 1e-6) << arm.name << " " << k;
    }
  }
  std::printf("seed 7: %d of %d walks ended at a minimum\n", converged, total);
  EXPECT_GE(converged, total * 9 / 10);
}

}  // namespace
}  // namespace screwline
