#include <cmath>
#include <random>

#include "screwline/ik/closed_form/plan.h"
#include "screwline/ik/task_error.h"
#include "screwline/kinematics/forward.h"
#include "screwline/model/structure.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr int kTrials = 12;               // Configurations that a plan has to reproduce before it is used.
constexpr double kTrialTolerance = 1e-7;  // [m, rad]: a wrong plan misses by far more, an imprecise URDF by far less.

/// A row that the task leaves open: a slide along that base axis costs nothing.
Axis openRow(int row) {
  Axis axis;
  axis.prismatic = true;
  axis.direction = Vector3::Unit(row);
  return axis;
}

bool isParallel(const Vector3& a, const Vector3& b) {
  return a.cross(b).norm() <= kStructureAngleTolerance;
}

const char* nameOf(PositionKind kind) {
  switch (kind) {
    case PositionKind::kArmPlane:
      return "two axes are parallel, across the other";
    case PositionKind::kMeetingAxes:
      return "two axes meet";
    case PositionKind::kParallelAxes:
      return "two axes are parallel";
    case PositionKind::kSkewAxes:
      return "a quartic";
    case PositionKind::kTurnAndSlide:
      return "a turn and a slide along it";
    case PositionKind::kSlideAcross:
      return "a turn and a slide across it";
    case PositionKind::kSlideTurnSlide:
      return "a turn between slides";
    case PositionKind::kThreeSlides:
      return "three slides";
  }
  return "";
}

bool contains(const PlanSolutions& solutions, const SerialChain& chain, const VectorX& q) {
  for (const PlanSolution& solution : solutions) {
    double worst = 0.0;
    for (int i = 0; i < chain.size(); ++i) {
      const double difference = solution.q[static_cast<std::size_t>(i)] - q[i];
      worst = std::max(worst, std::abs(chain.joint(i).isRevolute() ? wrapAngle(difference) : difference));
    }
    if (worst <= kTrialTolerance) return true;
  }
  return false;
}

}  // namespace

std::optional<ClosedFormPlan> ClosedFormPlan::compile(const SerialChain& chain, const Task& task) {
  if (chain.hasMimic() || chain.size() != task.size() || task.usesToolAxes()) return std::nullopt;
  ClosedFormPlan plan;
  plan.home_ = chain.home();
  plan.length_ = chain.characteristicLength();
  plan.axes_ = chain.axes();
  if (!plan.compileShape(chain, task) || !plan.reproduces(chain, task)) return std::nullopt;
  plan.nameBranches(chain);
  return plan;
}

bool ClosedFormPlan::compileShape(const SerialChain& chain, const Task& task) {
  if (task.rotationCount() == 0) return compilePosition(task);
  if (task.rotationCount() == 1) return compileHeading(task);
  if (task.rotationCount() == 2) return false;
  if (task.translationCount() == 0) {
    shape_ = Shape::kOrientation;
    orientation_ = OrientationProblem::compile({axes_[0], axes_[1], axes_[2]});
    method_ = "orientation by three axes";
    return orientation_.has_value();
  }
  if (task.translationCount() != 3) return false;
  const Structure structure = structureOf(chain);
  for (const ConcurrentGroup& group : structure.spherical) {
    start_ = group.center;
    if (group.first + group.count == 6 && compileSpherical(3)) return true;
    if (group.first == 0 && compileSpherical(0)) return true;
  }
  return false;
}

bool ClosedFormPlan::compileStage(const std::vector<int>& joints, const Task& task) {
  std::vector<Axis> axes;
  std::vector<int> sources;
  for (int row = 0; row < 3; ++row) {
    if (task.contains(row)) continue;
    axes.push_back(openRow(row));
    sources.push_back(-1);
  }
  for (int joint : joints) {
    axes.push_back(axes_[static_cast<std::size_t>(joint)]);
    sources.push_back(joint);
  }
  if (axes.size() != 3) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    stage_axes_[i] = axes[i];
    stage_joints_[i] = sources[i];
  }
  position_ = PositionProblem::compile(stage_axes_, length_);
  if (position_) method_ = std::string("position by three axes (") + nameOf(position_->kind()) + ")";
  return position_.has_value();
}

bool ClosedFormPlan::compilePosition(const Task& task) {
  shape_ = Shape::kPosition;
  start_ = home_.p;
  std::vector<int> joints;
  for (int i = 0; i < static_cast<int>(axes_.size()); ++i) joints.push_back(i);
  return compileStage(joints, task);
}

bool ClosedFormPlan::compileSpherical(int first) {
  shape_ = first == 3 ? Shape::kWrist : Shape::kShoulder;
  stage_sign_ = first == 3 ? 1.0 : -1.0;
  spherical_first_ = first;
  const auto i = static_cast<std::size_t>(first);
  orientation_ = OrientationProblem::compile({axes_[i], axes_[i + 1], axes_[i + 2]});
  // A spherical shoulder is a spherical wrist to who stands at the tip: the axes run backwards.
  if (!orientation_ || !compileStage(first == 3 ? std::vector<int>{0, 1, 2} : std::vector<int>{5, 4, 3}, Task()))
    return false;
  foldSpherical();
  method_ += first == 3 ? ", spherical wrist" : ", spherical shoulder";
  return true;
}

bool ClosedFormPlan::compileHeading(const Task& task) {
  shape_ = Shape::kHeading;
  for (int row = 3; row < 6; ++row) {
    if (task.contains(row)) heading_axis_ = Vector3::Unit(row - 3);
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (axes_[i].prismatic) continue;
    if (!isParallel(axes_[i].direction, heading_axis_)) return false;
    heading_joint_ = static_cast<int>(i);
  }
  if (heading_joint_ < 0) return false;
  start_ = axes_[static_cast<std::size_t>(heading_joint_)].point;
  std::vector<int> joints;
  for (std::size_t i = static_cast<std::size_t>(heading_joint_) + 1; i < axes_.size(); ++i) {
    joints.push_back(static_cast<int>(i));
    if (!isParallel(axes_[i].direction, heading_axis_)) turning_slides_ = true;
  }
  for (int i = 0; i < heading_joint_; ++i) joints.push_back(i);
  if (task.translationCount() == 0) {
    method_ = "heading by one axis";
    return joints.empty();
  }
  if (!compileStage(joints, task)) return false;
  method_ = "heading by the last turn, " + method_;
  return true;
}

InverseOutline ClosedFormPlan::outline() const {
  InverseOutline outline;
  switch (shape_) {
    case Shape::kPosition:
      outline.shape = InverseShape::kPosition;
      break;
    case Shape::kOrientation:
      outline.shape = InverseShape::kOrientation;
      break;
    case Shape::kWrist:
      outline.shape = InverseShape::kWrist;
      break;
    case Shape::kShoulder:
      outline.shape = InverseShape::kShoulder;
      break;
    case Shape::kHeading:
      outline.shape = InverseShape::kHeading;
      break;
  }
  outline.has_position = position_.has_value();
  outline.position = stage_joints_;
  outline.spherical_first = spherical_first_;
  outline.heading_joint = heading_joint_;
  Eigen::Index row = 2;
  heading_axis_.maxCoeff(&row);
  outline.heading_row = static_cast<int>(row);
  outline.turning_slides = turning_slides_;
  return outline;
}

bool ClosedFormPlan::reproduces(const SerialChain& chain, const Task& task) const {
  std::mt19937 random(20240229);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  VectorX q(chain.size());
  VectorX found(chain.size());
  for (int trial = 0; trial < kTrials; ++trial) {
    for (int i = 0; i < chain.size(); ++i) {
      q[i] = chain.joint(i).isRevolute() ? kPi * (2.0 * uniform() - 1.0) : length_ * (0.1 + uniform());
    }
    const Pose target = forwardKinematics(chain, q);
    PlanSolutions solutions;
    // Free joints would be given wrong values: a plan that leaves one open in general reproduces nothing.
    const VectorX elsewhere = q.array() + 1.0;
    solve(target, elsewhere.data(), solutions);
    if (!contains(solutions, chain, q)) return false;
    for (const PlanSolution& solution : solutions) {
      for (int i = 0; i < chain.size(); ++i) found[i] = solution.q[static_cast<std::size_t>(i)];
      if (taskError(task, target, forwardKinematics(chain, found)).norm() > kTrialTolerance * (1.0 + length_))
        return false;
    }
  }
  return true;
}

}  // namespace screwline
