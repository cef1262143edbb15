#include "screwline/ik/closed_form/plan.h"

#include <algorithm>
#include <cmath>

#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr double kAlmostInLine = 1.0 - 1e-13;  // A cosine: closer than 5e-7 rad.

}  // namespace

void ClosedFormPlan::solve(const Pose& target, const double* preferred, PlanSolutions& solutions) const {
  solutions.count = 0;
  switch (shape_) {
    case Shape::kPosition:
      solvePosition(target.p, preferred, solutions);
      break;
    case Shape::kOrientation:
      solveOrientation(target, preferred, solutions);
      break;
    case Shape::kWrist:
    case Shape::kShoulder:
      solveSpherical(target, preferred, solutions);
      break;
    case Shape::kHeading:
      solveHeading(target, preferred, solutions);
      break;
  }
}

std::array<double, 3> ClosedFormPlan::wishedOf(const double* preferred) const {
  std::array<double, 3> wished{};
  for (std::size_t i = 0; i < 3; ++i)
    wished[i] = stage_joints_[i] < 0 ? 0.0 : stage_sign_ * preferred[stage_joints_[i]];
  return wished;
}

void ClosedFormPlan::solvePosition(const Vector3& goal, const double* preferred, PlanSolutions& solutions) const {
  PositionSolutions found;
  position_->solve(start_, goal, wishedOf(preferred), found);
  addStage(found, solutions);
}

PlanSolution ClosedFormPlan::solutionOf(const PositionSolution& position) const {
  PlanSolution solution;
  solution.sign = {position.sign[0], position.sign[1], 0};
  solution.rank = position.rank;
  for (std::size_t i = 0; i < 3; ++i) {
    if (stage_joints_[i] < 0) continue;
    const auto joint = static_cast<std::size_t>(stage_joints_[i]);
    solution.q[joint] = stage_sign_ * position.q[i];
    if (position.free[i]) solution.free |= 1U << joint;
  }
  return solution;
}

void ClosedFormPlan::addStage(const PositionSolutions& found, PlanSolutions& solutions) const {
  for (const PositionSolution& position : found) {
    solutions.solutions[static_cast<std::size_t>(solutions.count++)] = solutionOf(position);
  }
}

void ClosedFormPlan::addOrientation(const PlanSolution& arm, const OrientationSolutions& turns,
                                    PlanSolutions& solutions) const {
  const auto first = static_cast<std::size_t>(spherical_first_);
  for (const OrientationSolution& turn : turns) {
    PlanSolution& solution = solutions.solutions[static_cast<std::size_t>(solutions.count++)];
    solution.q = arm.q;
    for (std::size_t i = 0; i < 3; ++i) solution.q[first + i] = turn.q[i];
    solution.free = turn.free ? arm.free | 1U << first : arm.free;
    solution.sign = {arm.sign[0], arm.sign[1], turn.sign};
    solution.rank = arm.rank;
  }
}

void ClosedFormPlan::solveOrientation(const Pose& target, const double* preferred, PlanSolutions& solutions) const {
  OrientationSolutions turns;
  orientation_->solve(target.R * home_.R.transpose(), preferred[0], turns);
  addOrientation(PlanSolution(), turns, solutions);
}

/// With S the turns of the other axes and N, F the frames of the orientation problem: N^T S^T target home^T F for a
/// wrist; a shoulder's is the transpose, with N and F exchanged. Only S is left for solveSpherical().
void ClosedFormPlan::foldSpherical() {
  const bool is_wrist = shape_ == Shape::kWrist;
  others_ = TurnSequence(stage_axes_, is_wrist ? orientation_->nearFrame() : orientation_->farFrame());
  before_ = is_wrist ? Matrix3(others_.base().transpose()) : Matrix3(others_.base().transpose() * home_.R);
  after_ = is_wrist ? Matrix3(home_.R.transpose() * orientation_->farFrame()) : orientation_->nearFrame();
  start_in_tip_ = home_.inverse() * start_;
}

/// The point where the three axes meet is moved by the other three axes only.
ClosedFormPlan::SphericalGoal ClosedFormPlan::sphericalGoal(const Pose& target) const {
  if (shape_ == Shape::kWrist) return {target * start_in_tip_, before_ * target.R * after_};
  return {home_.R * (target.R.transpose() * (start_ - target.p)) + home_.p, before_ * target.R.transpose() * after_};
}

void ClosedFormPlan::solveSpherical(const Pose& target, const double* preferred, PlanSolutions& solutions) const {
  const bool is_wrist = shape_ == Shape::kWrist;
  const SphericalGoal goal = sphericalGoal(target);
  PositionSolutions arms;
  position_->solveInTurns(start_, goal.point, wishedOf(preferred), arms);
  std::array<Matrix3, 4> rest;
  std::array<double, 4> error{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(arms.count); ++i) {
    PositionSolution& arm = arms.solutions[i];
    rest[i] = goal.M;
    others_.undo(arm.turn, rest[i]);
    if (std::abs(rest[i](2, 2)) > kAlmostInLine) {  // Whether axes 1 and 3 are in line is for every digit to say.
      error[i] = position_->refine(start_, goal.point, arm);
      rest[i] = goal.M;
      others_.undo(arm.turn, rest[i]);
    }
    if (!is_wrist) rest[i].transposeInPlace();
  }
  TurnBatch batch;  // Of all arms and wrists.
  position_->addTurns(arms, batch);
  std::array<OrientationTurns, 4> wrists;
  for (std::size_t i = 0; i < static_cast<std::size_t>(arms.count); ++i) {
    wrists[i] = orientation_->turnsInFrames(rest[i], error[i], preferred[spherical_first_], batch);
  }
  batch.takeAngles();
  position_->takeFrom(batch, arms);
  OrientationSolutions turns;
  for (std::size_t i = 0; i < static_cast<std::size_t>(arms.count); ++i) {
    OrientationProblem::takeFrom(batch, wrists[i], preferred[spherical_first_], turns);
    addOrientation(solutionOf(arms.solutions[i]), turns, solutions);
  }
}

void ClosedFormPlan::solveHeading(const Pose& target, const double* preferred, PlanSolutions& solutions) const {
  const Matrix3 whole = target.R * home_.R.transpose();
  const Vector3 x = anyPerpendicular(heading_axis_);
  const Vector3 turned = whole * x;
  const double heading = std::atan2(heading_axis_.cross(x).dot(turned), x.dot(turned));
  if (!position_) {
    solutions.count = 1;
  } else {
    const Matrix3 turn = rotationAbout(heading_axis_, heading);
    const Vector3 goal = target.p - turn * (home_.p - start_);
    if (turning_slides_) {
      solveTurningSlides(turn, goal, preferred, solutions);
    } else {
      solvePosition(goal, preferred, solutions);
    }
  }
  for (int i = 0; i < solutions.count; ++i) {
    PlanSolution& solution = solutions.solutions[static_cast<std::size_t>(i)];
    double rest = heading;
    for (std::size_t j = 0; j < axes_.size(); ++j) {
      if (!axes_[j].prismatic && static_cast<int>(j) != heading_joint_) {
        rest -= std::copysign(1.0, axes_[j].direction.dot(heading_axis_)) * solution.q[j];
      }
    }
    const auto last = static_cast<std::size_t>(heading_joint_);
    solution.q[last] = std::copysign(1.0, axes_[last].direction.dot(heading_axis_)) * rest;
  }
}

/// Slides behind the last turn point where the heading turns them: the position problem is the pose's own.
void ClosedFormPlan::solveTurningSlides(const Matrix3& turn, const Vector3& goal, const double* preferred,
                                        PlanSolutions& solutions) const {
  std::array<Axis, 3> axes = stage_axes_;
  for (std::size_t i = 0; i < 3; ++i) {
    if (stage_joints_[i] > heading_joint_) axes[i].direction = turn * axes[i].direction;
  }
  const std::optional<PositionProblem> problem = PositionProblem::compile(axes, length_);
  if (!problem) return;  // The slides are in line at this heading: nothing but a continuum, or nothing at all.
  PositionSolutions found;
  problem->solve(start_, goal, wishedOf(preferred), found);
  addStage(found, solutions);
}

int ClosedFormPlan::signOf(const BranchPart& branch_part, const PlanSolution& solution) {
  int sign = branch_part.orientation;
  for (std::size_t i = 0; i < 3; ++i) {
    if (branch_part.signs[i]) sign *= solution.sign[i];
  }
  return sign;
}

bool ClosedFormPlan::isDouble(const PlanSolution& solution) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const BranchPart& part) { return signOf(part, solution) == 0; });
}

std::string ClosedFormPlan::branchName(const PlanSolution& solution) const {
  std::string name;
  for (const BranchPart& part : parts_) {
    const int sign = signOf(part, solution);
    name += (name.empty() ? "" : ", ") + (sign > 0 ? part.positive : sign < 0 ? part.negative : part.neutral);
  }
  if (solution.rank > 0) name += ", number " + std::to_string(solution.rank + 1);
  return name;
}

}  // namespace screwline
