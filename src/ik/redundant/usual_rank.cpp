#include "usual_rank.h"

#include <algorithm>
#include <cmath>

#include "screwline/ik/redundant/redundant_solver.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/singularity.h"

namespace screwline {
namespace {

constexpr int kTrials = 8;

}  // namespace

int usualRank(const SerialChain& chain, int still) {
  Matrix6X J(6, kRedundantJoints);
  int rank = 0;
  for (int k = 1; k <= kTrials && rank < 6; ++k) {
    Vector7 q;
    for (int i = 0; i < kRedundantJoints; ++i) q[i] = std::remainder(k * (0.7 + 0.31 * i), kPi);
    geometricJacobian(chain, q, J);
    if (still >= 0) J.col(still).setZero();
    rank = std::max(rank, rankOf(singularValues(J), jacobianNoise(J)));
  }
  return rank;
}

}  // namespace screwline
