#include <cmath>
#include <random>

#include "screwline/ik/closed_form/plan.h"
#include "screwline/kinematics/forward.h"
#include "screwline/spatial/rotation.h"
#include "screwline/spatial/screw.h"

namespace screwline {
namespace {

constexpr int kSamples = 40;

BranchPart part(const std::string& what, const char* positive, const char* negative, const char* neutral,
                std::array<bool, 3> signs) {
  return {signs, 1, what + " " + positive, what + " " + negative, what + " " + neutral};
}

/// An axis of the chain, and a point moved by all of them, at a configuration.
Axis axisAt(const std::vector<Axis>& axes, const double* q, int index) {
  Pose X;
  for (int i = 0; i < index; ++i) {
    const Axis& axis = axes[static_cast<std::size_t>(i)];
    X = X * screwExponential(
                axis.prismatic ? prismaticScrew(axis.direction) : revoluteScrew(axis.direction, axis.point), q[i]);
  }
  Axis moved = axes[static_cast<std::size_t>(index)];
  moved.direction = X.R * moved.direction;
  moved.point = X * moved.point;
  return moved;
}

/// Which way "up" is for an elbow that turns about `axis`: for a horizontal arm that reaches forward (x, else y), the
/// elbow above (z, else y) the line from shoulder to hand.
double upwards(const Vector3& axis) {
  Eigen::Index dominant = 0;
  axis.cwiseAbs().maxCoeff(&dominant);
  return (dominant == 1 ? 1.0 : -1.0) * std::copysign(1.0, axis[dominant]);
}

}  // namespace

/// The parts of the name that the geometry gives signs for; what "up" and "front" mean is decided by orient().
void ClosedFormPlan::nameBranches(const SerialChain& chain) {
  constexpr std::array<bool, 3> kFirst{{true, false, false}};
  constexpr std::array<bool, 3> kSecond{{false, true, false}};
  constexpr std::array<bool, 3> kBoth{{true, true, false}};
  if (position_ && !turning_slides_) {
    const PositionGeometry& g = position_->geometry();
    const bool third_turns = !g.axes[2].prismatic;
    const std::string side = shape_ == Shape::kShoulder ? "wrist" : "shoulder";
    switch (g.kind) {
      case PositionKind::kArmPlane:
      case PositionKind::kMeetingAxes:
        parts_.push_back(part(side, "front", "back", "centred", kSecond));
        parts_.push_back(third_turns ? part("elbow", "up", "down", "straight", kBoth)
                                     : part("slide", "forward", "backward", "centred", kFirst));
        break;
      case PositionKind::kParallelAxes:
        parts_.push_back(part("elbow", "up", "down", "straight", kSecond));
        if (third_turns) parts_.push_back(part("forearm", "front", "back", "straight", kFirst));
        break;
      case PositionKind::kSkewAxes:
        parts_.push_back(part("aspect", "plus", "minus", "between", kFirst));
        break;
      case PositionKind::kTurnAndSlide:
        parts_.push_back(third_turns ? part("elbow", "up", "down", "straight", kFirst)
                                     : part("slide", "forward", "backward", "centred", kFirst));
        break;
      case PositionKind::kSlideAcross:
        if (third_turns) parts_.push_back(part("elbow", "up", "down", "straight", kFirst));
        parts_.push_back(part("slide", "forward", "backward", "centred", kSecond));
        break;
      case PositionKind::kSlideTurnSlide:
        parts_.push_back(part("slide", "forward", "backward", "centred", kFirst));
        break;
      case PositionKind::kThreeSlides:
        break;
    }
  }
  if (orientation_) {
    parts_.push_back(
        part(shape_ == Shape::kShoulder ? "shoulder" : "wrist", "no flip", "flip", "aligned", {{false, false, true}}));
  }
  for (BranchPart& branch_part : parts_) orient(chain, branch_part);
}

/// Sets the orientation of a part from configurations where both the geometric meaning and the solver's signs are
/// clear.
void ClosedFormPlan::orient(const SerialChain& chain, BranchPart& branch_part) const {
  if (branch_part.signs[2]) return;  // The sine of the wrist's middle angle needs no convention.
  std::mt19937 random(7);
  VectorX q = VectorX::Zero(chain.size());
  double clearest = 0.0;
  for (int sample = 0; sample < kSamples; ++sample) {
    const double meaning = meaningOf(branch_part, q.data());
    PlanSolutions solutions;
    solve(forwardKinematics(chain, q), q.data(), solutions);
    for (const PlanSolution& solution : solutions) {
      double distance = 0.0;
      for (int i = 0; i < chain.size(); ++i) {
        const double difference = solution.q[static_cast<std::size_t>(i)] - q[i];
        distance = std::max(distance, std::abs(chain.joint(i).isRevolute() ? wrapAngle(difference) : difference));
      }
      int sign = 1;
      for (std::size_t i = 0; i < 3; ++i) sign *= branch_part.signs[i] ? solution.sign[i] : 1;
      if (distance > 1e-6 || sign == 0 || std::abs(meaning) <= clearest) continue;
      clearest = std::abs(meaning);
      branch_part.orientation = meaning * sign > 0.0 ? 1 : -1;
    }
    // A part without a geometric meaning is positive at zero, where it has a sign there, else where it is met first.
    if (clearest == 1.0) return;
    for (int i = 0; i < chain.size(); ++i) {
      const double unit = static_cast<double>(random()) / 4294967296.0;
      q[i] = chain.joint(i).isRevolute() ? kPi * (2.0 * unit - 1.0) : length_ * (0.1 + unit);
    }
  }
}

/// Positive where the part's `positive` name is right; 1 where the name means nothing but "as at zero".
double ClosedFormPlan::meaningOf(const BranchPart& branch_part, const double* q) const {
  std::array<int, 2> turns{{-1, -1}};  // First two turns of the stage, base to tip.
  int count = 0;
  for (int i = 0; i < static_cast<int>(axes_.size()) && count < 2; ++i) {
    const bool staged = i == stage_joints_[0] || i == stage_joints_[1] || i == stage_joints_[2];
    if (staged && !axes_[static_cast<std::size_t>(i)].prismatic) turns[static_cast<std::size_t>(count++)] = i;
  }
  const bool is_elbow = branch_part.positive == "elbow up";
  const bool is_shoulder = branch_part.positive == "shoulder front";
  if (count < 2 || shape_ == Shape::kShoulder || (!is_elbow && !is_shoulder)) return 1.0;
  const auto pointAt = [&](const double* values) {
    const int last = shape_ == Shape::kWrist     ? 3
                     : shape_ == Shape::kHeading ? heading_joint_
                                                 : static_cast<int>(axes_.size());
    std::vector<Axis> axes(axes_.begin(), axes_.begin() + last);
    Axis carrier;
    carrier.point = start_;
    axes.push_back(carrier);
    return axisAt(axes, values, last).point;
  };
  const auto front = [&](const double* values) {
    const Axis first = axisAt(axes_, values, turns[0]);
    const Axis second = axisAt(axes_, values, turns[1]);
    return (pointAt(values) - first.point).dot(second.direction.cross(first.direction));
  };
  const bool has_shoulder =
      position_->kind() == PositionKind::kMeetingAxes || position_->kind() == PositionKind::kArmPlane;
  if (is_shoulder) {
    const std::array<double, kMaxPlanJoints> zero{};
    const double at_zero = front(zero.data());
    return front(q) * (std::abs(at_zero) > 1e-6 * length_ ? std::copysign(1.0, at_zero) : 1.0);
  }
  // Two turns and a point make the elbow; behind a shoulder they are the second and the third.
  int lower = turns[0];
  int upper = turns[1];
  if (has_shoulder) {
    lower = turns[1];
    for (int joint : stage_joints_) {
      if (joint > lower) upper = joint;
    }
  }
  const Axis base = axisAt(axes_, q, lower);
  const Axis elbow = axisAt(axes_, q, upper);
  const double bend = base.direction.dot((elbow.point - base.point).cross(pointAt(q) - elbow.point));
  if (!has_shoulder) return bend * upwards(base.direction);
  const double up = axisAt(axes_, q, turns[0]).direction.z();
  return bend * front(q) * (std::abs(up) > 1e-6 ? std::copysign(1.0, up) : 1.0);
}

}  // namespace screwline
