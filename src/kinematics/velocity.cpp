#include "screwline/kinematics/velocity.h"

#include <algorithm>
#include <cmath>

#include "screwline/kinematics/singularity.h"
#include "screwline/spatial/svd.h"

namespace screwline {
namespace {

/// One direction of the task: J takes the joint direction to `sigma` times it, and the twist has `wanted` along it.
struct Component {
  double sigma;
  double wanted;
  bool in_rank;
};

struct Gain {
  double rate = 0.0;
  double damping = 0.0;
};

/// Rate along one singular direction. From the threshold down, lambda^2 = threshold^2 - sigma^2, so that the gain
/// sigma / threshold^2 falls to nothing at the singularity; but only as far as the twist asks for rates faster than
/// half of what the threshold allows: what J qd of a moderate qd asks for is given exactly.
Gain gainOf(const Component& part, double threshold, double twist_norm) {
  if (part.sigma >= threshold) return {part.wanted / part.sigma, 0.0};
  if (std::abs(part.wanted) <= 1e-10 * (1.0 + twist_norm) && !part.in_rank) return {};
  const double fastest = twist_norm / threshold;
  const double demand = part.in_rank ? std::abs(part.wanted) / (part.sigma * fastest) : 1.0;
  const double share = std::clamp(2.0 * demand - 1.0, 0.0, 1.0);
  if (share == 0.0) return {part.wanted / part.sigma, 0.0};
  if (std::abs(part.wanted) <= 1e-10 * (1.0 + twist_norm)) return {};
  const double squared = (threshold * threshold - part.sigma * part.sigma) * share;
  return {part.wanted * part.sigma / (part.sigma * part.sigma + squared), std::sqrt(squared)};
}

}  // namespace

Vector6 tipTwist(const SerialChain& chain, const ConstVectorRef& q, const ConstVectorRef& velocity) {
  Matrix6X J;
  geometricJacobian(chain, q, J);
  return J * velocity;
}

VelocitySolution solveVelocity(const SerialChain& chain, const ConstVectorRef& q, const Vector6& twist,
                               const Task& task) {
  Matrix6X J;
  const Matrix3 R_BT = geometricJacobian(chain, q, J).R;
  const MatrixX J_task = taskJacobian(task, J, R_BT);
  const VectorX wanted = task.select(twist, R_BT);
  const double norm = wanted.norm();
  const Svd svd(J_task, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VectorX& sigma = svd.singularValues();
  const int rank = rankOf(sigma, jacobianNoise(J));

  VelocitySolution solution;
  solution.velocity = VectorX::Zero(chain.size());
  // Without any rank no rate does anything, and none is damped.
  for (int i = 0; rank > 0 && i < sigma.size(); ++i) {
    const Component part{sigma[i], svd.matrixU().col(i).dot(wanted), i < rank};
    const Gain gain = gainOf(part, kDampingThreshold * sigma[0], norm);
    solution.velocity += gain.rate * svd.matrixV().col(i);
    solution.damping = std::max(solution.damping, gain.damping);
  }
  solution.twist = J * solution.velocity;
  solution.residual = (wanted - task.select(solution.twist, R_BT)).norm();
  solution.exact = solution.damping == 0.0 && solution.residual < 1e-9 * (1.0 + norm);
  return solution;
}

}  // namespace screwline
