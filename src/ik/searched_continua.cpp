#include "searched_continua.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "screwline/ik/numerical/nearest_on_manifold.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/singularity.h"

namespace screwline {
namespace {

constexpr double kTrial = 0.02;   // [rad, m] Moved so far, a member of a continuum is one still.
constexpr double kEnd = 1e-4;     // [rad, m] of a projected gradient: the range's end is told to its square.
constexpr double kFarAway = 1e3;  // [rad, m]
constexpr int kStepsToEnd = 80;
constexpr double kTogether = 1e-5;  // [rad, m] A walk that ends so near has arrived.

/// Walks along the pose's own solutions.
class Walks {
 public:
  Walks(const SerialChain& chain, const Task& task, const IkRequest& request)
      : chain_(chain), task_(task), target_(request.target) {
    options_.honour_limits = !request.ignore_limits;
  }

  VectorX towards(const VectorX& from, const VectorX& goal) const {
    return nearestOnManifold(chain_, task_, target_, from, goal, options_).q;
  }

  bool arrive(const VectorX& from, const VectorX& goal) const {
    const VectorX near = nearestTurns(chain_, goal, from);
    return (towards(from, near) - near).cwiseAbs().maxCoeff() <= kTogether;
  }

  /// Whether the pose is left alone along a direction for more than to first order.
  bool isMember(const VectorX& q) const {
    Matrix6X J;
    const Pose tip = geometricJacobian(chain_, q, J);
    const MatrixX rows = taskRank(task_.select(J, tip.R), jacobianNoise(J)).self_motions;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const VectorX step = kTrial * rows.row(i).transpose();
      const auto moves = [&](const VectorX& goal) { return (towards(q, goal) - q).norm() > 0.5 * kTrial; };
      if (moves(q + step) || moves(q - step)) return true;
    }
    return false;
  }

  /// Widens the range of each free joint by walks towards its ends.
  void explore(IkAnswer& answer) const {
    const auto count = static_cast<Eigen::Index>(answer.free_joints.size());
    answer.self_motion_lower.resize(count);
    answer.self_motion_upper.resize(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const int joint = answer.free_joints[static_cast<std::size_t>(k)];
      const JointLimits& limits = chain_.joint(joint).limits;
      const double reach = chain_.joint(joint).isRevolute() ? kTwoPi : 4.0 * chain_.characteristicLength();
      const double value = answer.position[joint];
      NearestOptions options = options_;
      options.tolerance = kEnd;
      options.max_iterations = kStepsToEnd;
      const auto endTowards = [&](double side) {
        VectorX goal = answer.position;
        goal[joint] += side * kFarAway;  // So far that the other joints' wish to stay counts for nothing.
        return nearestOnManifold(chain_, task_, target_, answer.position, goal, options).q[joint];
      };
      answer.self_motion_lower[k] = std::min(value, std::max({endTowards(-1.0), limits.lower, value - reach}));
      answer.self_motion_upper[k] = std::max(value, std::min({endTowards(1.0), limits.upper, value + reach}));
    }
  }

 private:
  const SerialChain& chain_;
  const Task& task_;
  const Pose& target_;
  NearestOptions options_;
};

}  // namespace

std::vector<IkAnswer> joinSearchedContinua(const SerialChain& chain, const Task& task, const IkRequest& request,
                                           const SolutionBuilder& builder, std::vector<IkAnswer> answers) {
  const Walks walks(chain, task, request);
  std::vector<IkAnswer> isolated;  // Or described already.
  std::vector<IkAnswer> continua;
  int members = 0;
  for (IkAnswer& answer : answers) {
    if (answer.self_motion.rows() > 0 || !walks.isMember(answer.position)) {
      isolated.push_back(std::move(answer));
      continue;
    }
    if (!continua.empty() && (++members > kMostMembers || builder.timeLeft() <= 0.0)) continue;
    const auto isKnown = [&](const VectorX& q) {
      return std::any_of(continua.begin(), continua.end(),
                         [&](const IkAnswer& other) { return walks.arrive(q, other.position); });
    };
    if (isKnown(answer.position)) continue;
    const VectorX goal = nearestTurns(chain, builder.seed(), answer.position);
    Candidate nearest = unnamed(walks.towards(answer.position, goal));
    nearest.branch = answer.branch;
    if (isKnown(nearest.q)) continue;
    std::optional<IkAnswer> one = builder.build(std::move(nearest));
    continua.push_back(one ? std::move(*one) : std::move(answer));
  }
  for (IkAnswer& continuum : continua) {
    describeRedundancy(chain, task, continuum);
    walks.explore(continuum);
  }
  std::move(continua.begin(), continua.end(), std::back_inserter(isolated));
  return isolated;
}

}  // namespace screwline
