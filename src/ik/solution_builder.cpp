#include "solution_builder.h"

#include <algorithm>
#include <cmath>

#include "continuum.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/kinematics/singularity.h"
#include "turns.h"

namespace screwline {
namespace {

constexpr double kGoodEnough = 1e-13;  // [m, rad] errors that Newton steps would not lessen.
constexpr double kLeastGain = 1e-12;
constexpr double kRounding = 2.2e-16;  // Of 1 and the chain's length: no residual is known better.
constexpr double kLeastBand = 1e-9;    // Limits are decided no finer than this, and no coarser than kMostBand.
constexpr double kMostBand = 1e-6;
constexpr double kMostFollowed = 1e-3;  // [rad, m] The square root of kMostBand: two roots are there at most.

bool isSolution(const IkAnswer& solution) {
  return solution.position_error <= kSolutionTolerance && solution.orientation_error <= kSolutionTolerance;
}

}  // namespace

SolutionBuilder::SolutionBuilder(const SerialChain& chain, const Task& task, const IkRequest& request)
    : chain_(chain),
      task_(task),
      request_(request),
      seed_(request.seed.size() > 0 ? request.seed : chain.clamped(VectorX::Zero(chain.size()))) {}

std::optional<IkAnswer> SolutionBuilder::build(Candidate candidate) const {
  IkAnswer solution;
  solution.branch = std::move(candidate.branch);
  solution.position = candidate.q;
  if (!candidate.free.empty()) {
    Continuum continuum = candidate.describe ? candidate.describe(seed_, request_.ignore_limits)
                                             : describeContinuum(chain_, candidate, seed_, request_.ignore_limits);
    solution.position = continuum.nearest;
    solution.self_motion = continuum.directions;
    solution.free_joints = continuum.free_joints;
    solution.self_motion_lower = continuum.lower;
    solution.self_motion_upper = continuum.upper;
  }
  if (verify(solution) > kGoodEnough) {
    polish(chain_, task_, request_.target, solution.position);
    verify(solution);
  }
  if (!isSolution(solution)) return std::nullopt;
  const TaskConditioning conditioning = measure(solution, candidate.merged);
  const VectorX refined = solution.position;
  place(solution, hasSeed() || !candidate.free.empty());
  const bool moved = largestDifference(chain_, refined, solution.position) > kGoodEnough;
  if (!isSolution(solution)) return std::nullopt;
  if (conditioning.weak && candidate.free.empty() && !moved) {
    nearly_singular_.emplace_back(solution.position, *conditioning.weak);
  }
  return solution;
}

const WeakDirections* SolutionBuilder::weakDirectionsAt(const VectorX& position) const {
  for (const auto& [place, weak] : nearly_singular_) {
    if (place == position) return &weak;
  }
  return nullptr;
}

/// Chooses turns and decides about limits. At a singularity rounding widens the band in which values are put on a limit
/// so far that this can leave the pose: then the other joints follow, and where they cannot, the limit is broken.
/// Full turns and what is put on a limit leave the Jacobian as it was, to rounding; the pose is looked at again.
void SolutionBuilder::place(IkAnswer& solution, bool near_seed) const {
  const VectorX refined = solution.position;
  const auto turn = [&](double band) {
    const Turned turned = chooseTurns(chain_, refined, seed_, near_seed, request_.ignore_limits, band);
    solution.within_limits = turned.within_limits;
    if (turned.q == solution.position) return true;
    solution.position = turned.q;
    verify(solution);
    return isSolution(solution);
  };
  if (turn(std::clamp(solution.joint_error, kLeastBand, kMostBand))) return;
  if (!request_.ignore_limits) {
    const VectorX follows = descend(chain_, task_, request_.target, solution.position, DescentOptions()).q;
    if ((follows - solution.position).cwiseAbs().maxCoeff() <= kMostFollowed) {
      solution.position = follows;
      verify(solution);
      if (isSolution(solution)) return;
    }
  }
  turn(0.0);
}

double SolutionBuilder::timeLeft() const {
  return request_.timeout - std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

IkAnswer SolutionBuilder::describe(const VectorX& q, int held) const {
  IkAnswer solution;
  solution.position = q;
  verify(solution);
  measure(solution, false);
  if (held >= 0) {
    MatrixX moving = task_.select(jacobian_, orientation_);
    moving.col(held).setZero();
    // The held joint's direction has a singular value of zero, where there are no more joints than rows.
    const VectorX values = singularValues(moving);
    const Eigen::Index rank = std::min<Eigen::Index>(task_.size(), chain_.size() - 1);
    solution.joint_error = jointError(solution, std::max(values[rank - 1], kLeastGain));
  }
  solution.within_limits = chooseTurns(chain_, q, q, true, false, kLeastBand).within_limits;
  return solution;
}

bool SolutionBuilder::seedSolves() const {
  if (!hasSeed()) return false;
  const TaskError error = taskError(task_, request_.target, forwardKinematics(chain_, seed_));
  if (error.position > kSolutionTolerance || error.orientation > kSolutionTolerance) return false;
  return request_.ignore_limits || (chain_.clamped(seed_) - seed_).cwiseAbs().maxCoeff() <= kLeastBand;
}

/// Errors by forward kinematics, with the Jacobian, and the distance to the seed. Returns both errors' norm.
double SolutionBuilder::verify(IkAnswer& solution) const {
  const Pose tip = geometricJacobian(chain_, solution.position, jacobian_);
  orientation_ = tip.R;
  const TaskError error = taskError(task_, request_.target, tip);
  solution.position_error = error.position;
  solution.orientation_error = error.orientation;
  solution.distance = (solution.position - seed_).norm();
  return error.norm();
}

/// @pre jacobian_ is the solution's.
TaskConditioning SolutionBuilder::measure(IkAnswer& solution, bool merged) const {
  TaskConditioning conditioning = conditioningOf(task_.select(jacobian_, orientation_), jacobianNoise(jacobian_));
  solution.joint_error = jointError(solution, conditioning.smallest);
  solution.manipulability = conditioning.manipulability;
  solution.singular =
      merged || solution.self_motion.rows() > std::max(0, chain_.size() - task_.size()) || !conditioning.full_rank;
  if (solution.self_motion.rows() == 0) solution.self_motion.resize(0, chain_.size());
  return conditioning;
}

double SolutionBuilder::jointError(const IkAnswer& solution, double smallest) const {
  const double rounding = kRounding * (1.0 + chain_.characteristicLength());  // A residual of zero is luck.
  return std::hypot(solution.position_error, solution.orientation_error, rounding) / smallest;
}

void describeRedundancy(const SerialChain& chain, const Task& task, IkAnswer& solution) {
  solution.self_motion = taskRank(taskJacobian(chain, solution.position, task)).self_motions;
  for (int i = 0; i < chain.size(); ++i) {
    if (solution.self_motion.rows() > 0 && solution.self_motion.col(i).cwiseAbs().maxCoeff() > 1e-9)
      solution.free_joints.push_back(i);
  }
  const auto count = static_cast<Eigen::Index>(solution.free_joints.size());
  solution.self_motion_lower.resize(count);
  solution.self_motion_upper.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    solution.self_motion_lower[i] = solution.self_motion_upper[i] =
        solution.position[solution.free_joints[static_cast<std::size_t>(i)]];
  }
}

IkAnswer toldBy(IkAnswer continuum, const IkAnswer& member) {
  continuum.position = member.position;
  continuum.position_error = member.position_error;
  continuum.orientation_error = member.orientation_error;
  continuum.joint_error = member.joint_error;
  continuum.manipulability = member.manipulability;
  continuum.within_limits = member.within_limits;
  continuum.distance = member.distance;
  return continuum;
}

std::vector<Candidate> joinEqual(const SerialChain& chain, std::vector<Candidate> candidates) {
  std::vector<Candidate> distinct;
  for (Candidate& candidate : candidates) {
    const auto same = std::find_if(distinct.begin(), distinct.end(), [&](const Candidate& other) {
      return other.free == candidate.free && !other.round && !candidate.round && !other.describe &&
             !candidate.describe && isSameConfiguration(chain, other.q, candidate.q);
    });
    if (same == distinct.end()) {
      distinct.push_back(std::move(candidate));
    } else {
      same->merged = true;
    }
  }
  return distinct;
}

}  // namespace screwline
