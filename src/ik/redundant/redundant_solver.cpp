#include "screwline/ik/redundant/redundant_solver.h"

#include <utility>

#include "screwline/spatial/rotation.h"
#include "usual_rank.h"

namespace screwline {
namespace {

constexpr int kLast = kRedundantJoints - 1;

Pose motionOf(bool prismatic, const Vector3& direction, const Vector3& point, double value) {
  if (prismatic) return {Matrix3::Identity(), value * direction};
  const Matrix3 R = rotationAbout(direction, value);
  return {R, point - R * point};
}

/// The chain with one joint rigid at `value`.
SerialChain lockedChain(const SerialChain& chain, int joint, double value) {
  const Axis& axis = chain.axes()[static_cast<std::size_t>(joint)];
  const Pose X = motionOf(axis.prismatic, axis.direction, axis.point, value);
  ChainDescription description;
  description.name = chain.name();
  description.base_link = chain.baseLink();
  description.tip_link = chain.tipLink();
  for (int i = 0; i < chain.size(); ++i) {
    if (i == joint) continue;
    Axis other = chain.axes()[static_cast<std::size_t>(i)];
    if (i > joint) {
      other.direction = (X.R * other.direction).normalized();
      other.point = X * other.point;
    }
    other.source = static_cast<int>(description.joints.size());
    description.axes.push_back(other);
    description.joints.push_back(chain.joint(i));
  }
  description.home = X * chain.home();
  description.links = {{chain.tipLink(), chain.size() - 1, description.home}};
  return SerialChain(description);
}

/// A closed form of the chain with that joint rigid; for a joint inside of the chain, at each of a few values.
std::optional<SixJointSolver> closedFormWithout(const SerialChain& chain, int joint) {
  std::optional<SixJointSolver> solver = SixJointSolver::compileClosedForm(lockedChain(chain, joint, 0.0));
  if (joint == 0 || joint == kLast) return solver;
  for (double value : {0.7, -1.9}) {
    if (!solver || !SixJointSolver::compileClosedForm(lockedChain(chain, joint, value))) return std::nullopt;
  }
  return solver;
}

PlanSolution tagsOf(const RedundantSolution& solution) {
  PlanSolution tags;
  tags.sign = solution.sign;
  tags.rank = solution.rank;
  return tags;
}

}  // namespace

RedundantSolver::RedundantSolver(const SerialChain& chain, int parameter, SixJointSolver others)
    : chain_(chain), parameter_(parameter), others_(std::move(others)) {
  const Axis& axis = chain.axes()[static_cast<std::size_t>(parameter)];
  prismatic_ = axis.prismatic;
  direction_ = axis.direction;
  point_ = axis.point;
  if (parameter == kLast) {
    const Pose X_TB = chain.home().inverse();
    direction_ = X_TB.R * direction_;
    point_ = X_TB * point_;
  }
  method_ = chain.joint(parameter).name + " given, " + others_.method();
}

std::optional<RedundantSolver> RedundantSolver::compile(const SerialChain& chain) {
  if (chain.hasMimic() || chain.size() != kRedundantJoints) return std::nullopt;
  // A branch that more signs tell apart has simpler equations: quadratics, not a quartic.
  std::optional<RedundantSolver> best;
  const auto leads = [&chain](int joint) { return usualRank(chain, joint) == 6; };
  for (int joint : {kLast, 0}) {
    if (!leads(joint)) continue;
    const std::optional<SixJointSolver> others = closedFormWithout(chain, joint);
    if (others && (!best || others->branchParts().size() > best->others_.branchParts().size()))
      best = RedundantSolver(chain, joint, *others);
  }
  for (int joint = 1; joint < kLast && !best; ++joint) {
    if (!leads(joint)) continue;
    if (const std::optional<SixJointSolver> others = closedFormWithout(chain, joint))
      best = RedundantSolver(chain, joint, *others);
  }
  for (int joint : {kLast, 0}) {
    if (best || !leads(joint)) continue;
    if (const std::optional<SixJointSolver> others = SixJointSolver::compileAlgebraic(lockedChain(chain, joint, 0.0)))
      best = RedundantSolver(chain, joint, *others);
  }
  return best;
}

void RedundantSolver::solveAt(const Pose& target, double value, const Vector7& preferred,
                              RedundantSolutions& solutions) const {
  std::array<double, kMaxPlanJoints> wished{};
  for (int i = 0, k = 0; i < kRedundantJoints; ++i) {
    if (i != parameter_) wished[static_cast<std::size_t>(k++)] = preferred[i];
  }
  SixJointSolutions found;
  if (parameter_ == 0) {
    others_.solve(motionOf(prismatic_, direction_, point_, -value) * target, wished.data(), found);
  } else if (parameter_ == kLast) {
    others_.solve(target * motionOf(prismatic_, direction_, point_, -value), wished.data(), found);
  } else if (const std::optional<SixJointSolver> others =
                 SixJointSolver::compileClosedForm(lockedChain(chain_, parameter_, value))) {
    others->solve(target, wished.data(), found);
  }
  solutions.count = 0;
  solutions.complete = found.complete;
  const unsigned below = (1U << parameter_) - 1U;
  for (const PlanSolution& plan_solution : found) {
    RedundantSolution& solution = solutions.solutions[static_cast<std::size_t>(solutions.count++)];
    for (int i = 0, k = 0; i < kRedundantJoints; ++i)
      solution.q[i] = i == parameter_ ? value : plan_solution.q[static_cast<std::size_t>(k++)];
    solution.free = (plan_solution.free & below) | ((plan_solution.free & ~below) << 1U);
    solution.sign = plan_solution.sign;
    solution.rank = plan_solution.rank;
  }
}

std::optional<InverseOutline> RedundantSolver::outline() const {
  if (others_.plan() == nullptr || !compiledOnce()) return std::nullopt;
  InverseOutline outline = others_.plan()->outline();
  outline.given = parameter_;
  return outline;
}

std::string RedundantSolver::branchName(const RedundantSolution& solution) const {
  return others_.branchName(tagsOf(solution));
}

bool RedundantSolver::isDouble(const RedundantSolution& solution) const {
  return others_.isDouble(tagsOf(solution));
}

}  // namespace screwline
