#include "screwline/ik/closed_form/plan.h"

#include <algorithm>
#include <cmath>

#include "screwline/spatial/rotation.h"

namespace screwline {

void ClosedFormPlan::solve(const Pose& target, const double* preferred, PlanSolutions& solutions) const {
  solutions.count = 0;
  switch (shape_) {
    case Shape::kPosition:
      solvePosition(target.p, preferred, solutions);
      break;
    case Shape::kOrientation:
    case Shape::kWrist:
    case Shape::kShoulder:
      solveSpherical(target, preferred, solutions);
      break;
    case Shape::kHeading:
      solveHeading(target, preferred, solutions);
      break;
  }
}

void ClosedFormPlan::solvePosition(const Vector3& goal, const double* preferred, PlanSolutions& solutions) const {
  std::array<double, 3> wished{};
  for (std::size_t i = 0; i < 3; ++i)
    wished[i] = stage_joints_[i] < 0 ? 0.0 : stage_sign_ * preferred[stage_joints_[i]];
  PositionSolutions found;
  position_->solve(start_, goal, wished, found);
  addStage(found, solutions);
}

void ClosedFormPlan::addStage(const PositionSolutions& found, PlanSolutions& solutions) const {
  for (const PositionSolution& position : found) {
    PlanSolution solution;
    solution.sign = {position.sign[0], position.sign[1], 0};
    solution.rank = position.rank;
    for (std::size_t i = 0; i < 3; ++i) {
      if (stage_joints_[i] < 0) continue;
      const auto joint = static_cast<std::size_t>(stage_joints_[i]);
      solution.q[joint] = stage_sign_ * position.q[i];
      if (position.free[i]) solution.free |= 1U << joint;
    }
    solutions.solutions[static_cast<std::size_t>(solutions.count++)] = solution;
  }
}

void ClosedFormPlan::solveSpherical(const Pose& target, const double* preferred, PlanSolutions& solutions) const {
  PlanSolutions arms;
  if (shape_ == Shape::kOrientation) {
    arms.count = 1;
  } else {
    // The point where the three axes meet is moved by the other three axes only.
    const Vector3 goal =
        shape_ == Shape::kWrist ? target * (home_.inverse() * start_) : home_ * (target.inverse() * start_);
    solvePosition(goal, preferred, arms);
  }
  const Matrix3 whole = target.R * home_.R.transpose();
  for (const PlanSolution& arm : arms) {
    const Matrix3 others =
        shape_ == Shape::kOrientation ? Matrix3::Identity() : turnOf(3 - spherical_first_, arm.q.data());
    const Matrix3 spherical =
        shape_ == Shape::kShoulder ? Matrix3(whole * others.transpose()) : Matrix3(others.transpose() * whole);
    OrientationSolutions turns;
    const auto first = static_cast<std::size_t>(spherical_first_);
    orientation_->solve(spherical, preferred[first], turns);
    for (const OrientationSolution& turn : turns) {
      PlanSolution solution = arm;
      for (std::size_t i = 0; i < 3; ++i) solution.q[first + i] = turn.q[i];
      solution.sign[2] = turn.sign;
      if (turn.free) solution.free |= 1U << first;
      solutions.solutions[static_cast<std::size_t>(solutions.count++)] = solution;
    }
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
  std::array<double, 3> wished{};
  for (std::size_t i = 0; i < 3; ++i) wished[i] = stage_joints_[i] < 0 ? 0.0 : preferred[stage_joints_[i]];
  PositionSolutions found;
  problem->solve(start_, goal, wished, found);
  addStage(found, solutions);
}

Matrix3 ClosedFormPlan::turnOf(int first_joint, const double* q) const {
  Matrix3 R = Matrix3::Identity();
  for (int i = first_joint; i < first_joint + 3; ++i) {
    const Axis& axis = axes_[static_cast<std::size_t>(i)];
    if (!axis.prismatic) R = R * rotationAbout(axis.direction, q[i]);
  }
  return R;
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
