#include <algorithm>
#include <cmath>
#include <random>

#include "screwline/ik/closed_form/parallel_plan.h"
#include "screwline/ik/task_error.h"
#include "screwline/kinematics/forward.h"
#include "screwline/model/structure.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr int kTrials = 12;               // Configurations that a plan has to reproduce before it is used.
constexpr double kTrialTolerance = 1e-7;  // [m, rad]: a wrong plan misses by far more, an imprecise URDF by far less.
constexpr int kNamingTrials = 40;

bool areParallel(const Vector3& a, const Vector3& b) {
  return a.cross(b).norm() <= kStructureAngleTolerance;
}

double largestDifference(const PlanSolution& solution, const VectorX& q) {
  double worst = 0.0;
  for (int i = 0; i < 6; ++i)
    worst = std::max(worst, std::abs(wrapAngle(solution.q[static_cast<std::size_t>(i)] - q[i])));
  return worst;
}

VectorX randomTurns(std::mt19937& random) {
  VectorX q(6);
  for (int i = 0; i < 6; ++i) q[i] = kPi * (2.0 * static_cast<double>(random()) / 4294967296.0 - 1.0);
  return q;
}

BranchPart part(const std::string& what, const char* positive, const char* negative, const char* neutral,
                std::array<bool, 3> signs) {
  return {signs, 1, what + " " + positive, what + " " + negative, what + " " + neutral};
}

}  // namespace

std::optional<ParallelPlan> ParallelPlan::compile(const SerialChain& chain) {
  const auto isTurn = [](const Axis& axis) { return !axis.prismatic; };
  if (chain.size() != 6 || chain.hasMimic() || !std::all_of(chain.axes().begin(), chain.axes().end(), isTurn))
    return std::nullopt;
  struct Order {
    int first_parallel;
    Single single;
  };
  for (const Order& order :
       {Order{1, Single::kBeforeParallel}, Order{0, Single::kBetween}, Order{0, Single::kBehindPair}}) {
    for (bool reversed : {false, true}) {
      ParallelPlan plan;
      if (!plan.compileOrder(chain, reversed, order.first_parallel, order.single)) continue;
      if (!plan.reproduces(chain)) continue;
      plan.nameBranches(chain);
      return plan;
    }
  }
  return std::nullopt;
}

bool ParallelPlan::compileOrder(const SerialChain& chain, bool reversed, int first_parallel, Single single) {
  reversed_ = reversed;
  single_ = single;
  first_parallel_ = first_parallel;
  single_axis_ = single == Single::kBeforeParallel ? 0 : single == Single::kBetween ? 3 : 5;
  pair_axis_ = single == Single::kBehindPair ? 3 : 4;
  home_inverse_ = chain.home().inverse();
  length_ = chain.characteristicLength();
  reach_ = length_ + chain.home().p.norm();
  for (int axis = 0; axis < 6; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const Axis& source = chain.axes()[static_cast<std::size_t>(jointOf(axis))];
    direction_[i] = source.direction;
    point_[i] = source.point;
    sense_[i] = reversed ? -1.0 : 1.0;
    if (axis > 0) reach_ += (point_[i] - point_[i - 1]).norm();
  }
  const auto k = static_cast<std::size_t>(first_parallel);
  const Vector3& h = direction_[k];
  if (!areParallel(h, direction_[k + 1]) || !areParallel(h, direction_[k + 2])) return false;
  for (std::size_t i = k + 1; i < k + 3; ++i) {
    const double alike = std::copysign(1.0, direction_[i].dot(h));
    direction_[i] *= alike;
    sense_[i] *= alike;
  }
  const auto pair = static_cast<std::size_t>(jointOf(pair_axis_));
  const auto next = static_cast<std::size_t>(jointOf(pair_axis_ + 1));
  const AxisRelation relation = relate(chain.axes()[pair], chain.axes()[next], length_);
  if (!relation.intersecting) return false;
  meeting_ = relation.meeting_point;
  x_ = anyPerpendicular(h);
  y_ = h.cross(x_);
  const auto link = [&](std::size_t from) {
    const Vector3 step = point_[from + 1] - point_[from];
    return Turn{step.dot(x_), step.dot(y_)};
  };
  pair_ = DirectionProblem::compile(direction_[static_cast<std::size_t>(pair_axis_)],
                                    direction_[static_cast<std::size_t>(pair_axis_) + 1]);
  plane_ = PlanarProblem::compile(link(k), link(k + 1), length_);
  if (!pair_ || !plane_) return false;
  const auto nameOf = [&](int axis) { return chain.joint(jointOf(axis)).name; };
  const int low = reversed ? pair_axis_ + 1 : pair_axis_;
  const int high = reversed ? pair_axis_ : pair_axis_ + 1;
  method_ = "three parallel axes (" + nameOf(first_parallel + (reversed ? 2 : 0)) + " to " +
            nameOf(first_parallel + (reversed ? 0 : 2)) + "), " + nameOf(single_axis_) + " by a height along them, " +
            nameOf(low) + " and " + nameOf(high) + " by their direction";
  return true;
}

InverseOutline ParallelPlan::outline() const {
  InverseOutline outline;
  outline.shape = InverseShape::kParallel;
  outline.reversed = reversed_;
  outline.first_parallel = first_parallel_;
  outline.single = single_axis_;
  outline.pair = pair_axis_;
  return outline;
}

bool ParallelPlan::reproduces(const SerialChain& chain) const {
  std::mt19937 random(20240229);
  VectorX found(6);
  for (int trial = 0; trial < kTrials; ++trial) {
    const VectorX q = randomTurns(random);
    const Pose target = forwardKinematics(chain, q);
    // Free joints would be given wrong values: a plan that leaves one open in general reproduces nothing.
    const VectorX elsewhere = q.array() + 1.0;
    ParallelSolutions solutions;
    solve(target, elsewhere.data(), solutions);
    const bool contained = std::any_of(solutions.begin(), solutions.end(), [&](const PlanSolution& solution) {
      return largestDifference(solution, q) <= kTrialTolerance;
    });
    if (!contained) return false;
    for (const PlanSolution& solution : solutions) {
      for (int i = 0; i < 6; ++i) found[i] = solution.q[static_cast<std::size_t>(i)];
      if (taskError(Task(), target, forwardKinematics(chain, found)).norm() > kTrialTolerance * (1.0 + length_))
        return false;
    }
  }
  return true;
}

/// Signs: the single joint's root, the elbow, the pair.
void ParallelPlan::nameBranches(const SerialChain& chain) {
  const bool middle = single_ == Single::kBeforeParallel;
  const std::string side = middle ? (reversed_ ? "wrist" : "shoulder") : (reversed_ ? "base" : "hand");
  const bool is_arm = middle && !reversed_;
  parts_ = {part(side, "front", "back", "centred", {{true, false, false}}),
            part("elbow", "up", "down", "straight", {{is_arm, true, false}}),
            part(reversed_ ? "shoulder" : "wrist", "no flip", "flip", "aligned", {{false, false, true}})};
  // A part without a geometric meaning is positive at zero, or near it.
  std::mt19937 random(7);
  VectorX q = VectorX::Zero(6);
  std::array<int, 3> signs{};
  for (int trial = 0; trial < kNamingTrials && signs[0] * signs[1] * signs[2] == 0; ++trial) {
    signs = signsAt(forwardKinematics(chain, q), q.data());
    q = 0.1 * randomTurns(random);
  }
  parts_[0].orientation = signs[0] < 0 ? -1 : 1;
  parts_[2].orientation = signs[2] < 0 ? -1 : 1;
  parts_[1].orientation = reversed_ ? (signs[1] < 0 ? -1 : 1) : upwards();
}

/// "Up" means up: with axes that are parallel from the base on, the elbow lies above (z, else y) the line from shoulder
/// to wrist of an arm that reaches forward (x, else y). Behind an upright first axis the arm's plane turns, and the
/// sign of the single joint's root tells on which side of that axis the arm reaches.
int ParallelPlan::upwards() const {
  if (single_ == Single::kBeforeParallel) return direction_[0].z() < -1e-6 ? 1 : -1;
  const Vector3& h = direction_[static_cast<std::size_t>(first_parallel_)];
  Eigen::Index dominant = 0;
  h.cwiseAbs().maxCoeff(&dominant);
  return (dominant == 1 ? 1.0 : -1.0) * h[dominant] > 0.0 ? 1 : -1;
}

}  // namespace screwline
