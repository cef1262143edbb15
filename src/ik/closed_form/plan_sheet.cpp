// Continua along which one joint of the arm turns about the point that the spherical axes share.
#include "screwline/ik/closed_form/plan.h"

namespace screwline {
namespace {

bool isOneBit(unsigned bits) {
  return bits != 0 && (bits & (bits - 1U)) == 0U;
}

/// To the bit: where the free axis does not matter, the others are computed from the same numbers.
bool areAlikeBut(std::size_t axis, const PositionSolution& a, const PositionSolution& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (i == axis) continue;
    if (a.turn[i].c != b.turn[i].c || a.turn[i].s != b.turn[i].s || a.q[i] != b.q[i]) return false;
  }
  return true;
}

}  // namespace

/// The arm of a solution's branch; null where there is none.
const PositionSolution* ClosedFormPlan::armOf(const PlanSolution& solution, const PositionSolutions& arms) const {
  for (const PositionSolution& arm : arms) {
    const PlanSolution one = solutionOf(arm);
    const bool same = one.free == solution.free && one.sign[0] == solution.sign[0] && one.sign[1] == solution.sign[1];
    if (same && one.rank == solution.rank) return &arm;
  }
  return nullptr;
}

std::optional<PlanSheet> ClosedFormPlan::sheetOf(const Pose& target, const PlanSolution& solution) const {
  const bool is_spherical = shape_ == Shape::kWrist || shape_ == Shape::kShoulder;
  if (!is_spherical || !isOneBit(solution.free)) return std::nullopt;
  std::size_t axis = 0;
  while (axis < 3 && solution.free != 1U << stage_joints_[axis]) ++axis;
  if (axis == 3) return std::nullopt;  // One of the spherical ones.
  const SphericalGoal goal = sphericalGoal(target);
  std::array<double, 3> wished = wishedOf(solution.q.data());
  PositionSolutions arms;
  position_->solveInTurns(start_, goal.point, wished, arms);
  const PositionSolution* arm = armOf(solution, arms);
  PositionSolutions moved_arms;
  wished[axis] += 1.0;
  position_->solveInTurns(start_, goal.point, wished, moved_arms);
  const PositionSolution* moved = armOf(solution, moved_arms);
  if (arm == nullptr || moved == nullptr || !areAlikeBut(axis, *arm, *moved)) return std::nullopt;
  PlanSheet sheet;
  sheet.plan_ = this;
  sheet.joint_ = static_cast<std::size_t>(stage_joints_[axis]);
  sheet.sense_ = stage_axes_[axis].prismatic ? 0.0 : stage_sign_;
  sheet.branch_ = solution;
  const auto restAt = [&](const Turn& turn) {
    std::array<Turn, 3> turns = arm->turn;
    if (!stage_axes_[axis].prismatic) turns[axis] = turn;
    Matrix3 rest = goal.M;
    others_.undo(turns, rest);
    return shape_ == Shape::kShoulder ? Matrix3(rest.transpose()) : rest;
  };
  const Matrix3 here = restAt({1.0, 0.0});
  const Matrix3 opposite = restAt({-1.0, 0.0});
  sheet.middle_ = 0.5 * (here + opposite);
  sheet.cosine_ = 0.5 * (here - opposite);
  sheet.sine_ = restAt({0.0, 1.0}) - sheet.middle_;
  return sheet;
}

bool PlanSheet::member(double value, PlanSolution& solution) const {
  const Turn turn = turnBy(sense_ * value);
  const Matrix3 rest = middle_ + turn.c * cosine_ + turn.s * sine_;
  TurnBatch batch;
  const OrientationTurns wrists = plan_->orientation_->turnsInFrames(rest, 0.0, 0.0, batch);
  batch.takeAngles();
  OrientationSolutions found;
  OrientationProblem::takeFrom(batch, wrists, 0.0, found);
  const auto first = static_cast<std::size_t>(plan_->spherical_first_);
  for (const OrientationSolution& wrist : found) {
    if (wrist.free || wrist.sign != branch_.sign[2]) continue;
    solution = branch_;
    solution.q[joint_] = value;
    for (std::size_t i = 0; i < 3; ++i) solution.q[first + i] = wrist.q[i];
    return true;
  }
  return false;
}

}  // namespace screwline
