#include "arm_circle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../closed_form/eliminant.h"
#include "screwline/model/structure.h"

namespace screwline {
namespace {

constexpr double kSamePoint = 1e-9;  // Of the chain's length.
constexpr double kBeside = 1e-6;     // [rad] of the arm angle.
constexpr double kRounding = 1e-14;  // [rad] of directions; over the sine between axes, of tangents.
constexpr double kSameElbow = 3e-7;  // [rad] Rounding parts a double root by as much.
constexpr double kMostBend = 1e-6;   // [rad] of a straight elbow: changes the distance by 1e-12 of it.
constexpr double kMostGap = 1e-12;   // [rad] left of the line's direction.

Matrix3 someFrameOn(const Vector3& z) {
  return frameOn(z, anyPerpendicular(z));
}

std::optional<ArmCircle::Group> groupAt(const SerialChain& chain, int first) {
  const auto at = [&](int i) { return chain.axes()[static_cast<std::size_t>(first + i)]; };
  const std::array<Axis, 3> axes = {at(0), at(1), at(2)};
  const std::optional<OrientationProblem> problem = OrientationProblem::compile(axes);
  if (!problem || !problem->isAcross()) return std::nullopt;
  return ArmCircle::Group{*problem, {axes[0].direction, axes[1].direction, axes[2].direction}};
}

/// Rates of three turns whose axes make up an angular velocity.
Vector3 made(const Vector3& velocity, const Vector3& a, const Vector3& b, const Vector3& c) {
  const double volume = a.dot(b.cross(c));
  return Vector3(velocity.dot(b.cross(c)), velocity.dot(c.cross(a)), velocity.dot(a.cross(b))) / volume;
}

/// Of the line, seen from the second axis of a group: what turns about the first and the third axis leave between where
/// it is and where the elbow has it (the sine rule in the triangle of the line and the outer axes).
double gapOf(const ArmPose::Side& side, double first, double third) {
  return std::cos(third) * side.behind(2, 0) - std::sin(third) * side.behind(2, 1) -
         std::cos(first) * side.before(0, 2) - std::sin(first) * side.before(1, 2);
}

}  // namespace

ArmCircle::ArmCircle(const SerialChain& chain, const Group& shoulder, const Group& wrist)
    : chain_(chain), groups_{shoulder, wrist} {}

std::optional<ArmCircle> ArmCircle::compile(const SerialChain& chain) {
  if (chain.size() != kRedundantJoints || chain.hasMimic()) return std::nullopt;
  const Structure structure = structureOf(chain);
  const auto center = [&](int first) -> std::optional<Vector3> {
    for (const ConcurrentGroup& group : structure.spherical) {
      if (group.first <= first && group.first + group.count >= first + 3) return group.center;
    }
    return std::nullopt;
  };
  const std::optional<Vector3> shoulder = center(0);
  const std::optional<Vector3> wrist = center(4);
  if (!shoulder || !wrist || chain.axes()[3].prismatic) return std::nullopt;
  const std::optional<Group> first = groupAt(chain, 0);
  const std::optional<Group> last = groupAt(chain, 4);
  if (!first || !last) return std::nullopt;
  ArmCircle arm(chain, *first, *last);
  arm.shoulder_center_ = *shoulder;
  arm.wrist_center_ = *wrist;
  return arm;
}

ArmPose::ArmPose(std::shared_ptr<const ArmCircle> arm, const Pose& target) : arm_(std::move(arm)) {
  const SerialChain& chain = arm_->chain();
  const Pose X = target * chain.home().inverse();
  const Vector3 to_wrist = X * arm_->wristCenter() - arm_->shoulderCenter();
  const double distance = to_wrist.norm();
  const double length = chain.characteristicLength();
  rotation_ = X.R;
  regular_ = distance > kSamePoint * length;
  if (!regular_) return;
  line_ = to_wrist / distance;
  const Axis& axis = chain.axes()[3];
  const CarriedPoint carried(axis, arm_->wristCenter());
  const RealRoots roots = solveForm(carried.squareFrom(arm_->shoulderCenter()) + -distance * distance, false,
                                    length * length + distance * distance);
  if (roots.always) regular_ = false;
  for (const RealRoot& root : roots) {
    elbows_.push_back(elbowAt(root.turn.angle()));
    elbows_.back().straight = root.slope == 0;
  }
  joinElbows();
}

/// Two values that rounding has parted; where a group is almost in line, their middle stands for both.
void ArmPose::joinElbows() {
  if (elbows_.size() != 2) return;
  const double apart = std::remainder(elbows_[1].q - elbows_[0].q, kTwoPi);
  if (std::abs(apart) > kSameElbow) return;
  for (Elbow& elbow : elbows_) elbow.straight = true;
  Elbow middle = elbowAt(elbows_[0].q + 0.5 * apart);
  middle.straight = true;
  if (std::min(middle.shoulder.tilt(), middle.wrist.tilt()) <= kFlat) elbows_ = {middle};
}

ArmPose::Elbow ArmPose::elbowAt(double q) const {
  const ArmCircle::Group& shoulder = arm_->shoulder();
  const ArmCircle::Group& hand = arm_->wrist();
  const Axis& axis = arm_->chain().axes()[3];
  const Matrix3 line = someFrameOn(line_);
  Elbow elbow;
  elbow.q = q;
  elbow.turn = rotationAbout(axis.direction, q);
  const Vector3 wrist = axis.point + elbow.turn * (arm_->wristCenter() - axis.point);
  const Matrix3 align = line * someFrameOn((wrist - arm_->shoulderCenter()).normalized()).transpose();
  elbow.shoulder = {shoulder.problem.nearFrame().transpose() * line,
                    line.transpose() * align * shoulder.problem.farFrame(), 1.0};
  elbow.wrist = {hand.problem.nearFrame().transpose() * elbow.turn.transpose() * align.transpose() * line,
                 line.transpose() * rotation_ * hand.problem.farFrame(), -1.0};
  recentre(elbow);
  return elbow;
}

void ArmPose::recentre(Elbow& elbow) {
  double centre = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const Side* side : {&elbow.shoulder, &elbow.wrist}) {
    for (double angle : extremes(*side)) {
      const double sine = outOfLine(*side, angle);
      if (sine >= least) continue;
      least = sine;
      centre = angle;
    }
  }
  for (Side* side : {&elbow.shoulder, &elbow.wrist})
    side->behind = rotationAbout(Vector3::UnitZ(), side->sense * centre) * side->behind;
}

/// The third axis in the first one's frame: its cosine is a sinusoid of the arm angle.
std::array<double, 2> ArmPose::extremes(const Side& side) {
  const double turn =
      std::atan2(side.before(2, 1), side.before(2, 0)) - std::atan2(side.behind(1, 2), side.behind(0, 2));
  const double angle = wrapAngle(side.sense * turn);
  return {angle, wrapAngle(angle + kPi)};
}

const ArmPose::Elbow& ArmPose::elbowOf(const SelfMotionNode& node) const {
  return *std::min_element(elbows_.begin(), elbows_.end(), [&](const Elbow& a, const Elbow& b) {
    return std::abs(std::remainder(a.q - node.q[3], kTwoPi)) < std::abs(std::remainder(b.q - node.q[3], kTwoPi));
  });
}

double ArmPose::solve(const Elbow& elbow, double angle, const ArmSigns* signs, const Vector7& near, Vector7& q) const {
  const Matrix3 shoulder = elbow.shoulder.at(angle);
  const Matrix3 wrist = elbow.wrist.at(angle);
  TurnBatch batch;
  const OrientationTurns shoulder_turns = arm_->shoulder().problem.turnsInFrames(shoulder, 0.0, near[0], batch);
  const OrientationTurns wrist_turns = arm_->wrist().problem.turnsInFrames(wrist, 0.0, near[4], batch);
  batch.takeAngles();
  const auto take = [&](const OrientationTurns& turns, int first, int wished) {
    OrientationSolutions solutions;
    OrientationProblem::takeFrom(batch, turns, near[first], solutions);
    double least = std::numeric_limits<double>::infinity();
    for (const OrientationSolution& solution : solutions) {
      Vector3 step;
      for (int i = 0; i < 3; ++i)
        step[i] = std::remainder(solution.q[static_cast<std::size_t>(i)] - near[first + i], kTwoPi);
      const bool asked = wished == 0 || solution.sign == 0 || solution.sign == wished;
      if (!asked || step.norm() >= least) continue;
      least = step.norm();
      q.segment<3>(first) = near.segment<3>(first) + step;
    }
  };
  take(shoulder_turns, 0, signs == nullptr ? 0 : signs->shoulder);
  take(wrist_turns, 4, signs == nullptr ? 0 : signs->wrist);
  q[3] = near[3] + std::remainder(elbow.q - near[3], kTwoPi);
  if (shoulder_turns.free || wrist_turns.free) return 0.0;
  return std::min(shoulder.topRightCorner<2, 1>().norm(), wrist.topRightCorner<2, 1>().norm());
}

void ArmPose::at(const Elbow& elbow, double angle, const ArmSigns* signs, const Vector7& near,
                 SelfMotionNode& node) const {
  double sine = solve(elbow, angle, signs, near, node.q);
  Vector7 q = node.q;
  // Where axes are in line the tangent is that beside it.
  if (sine == 0.0) sine = solve(elbow, angle + kBeside, signs, near, q);
  const Vector7 rate = rates(elbow, q);
  const double speed = rate.norm();
  node.angle = angle;
  node.angle_rate = 1.0 / speed;
  node.tangent = rate / speed;
  node.noise = kRounding / std::max(sine, kRounding);
}

double ArmPose::outOfLine(const Side& side, double angle) {
  return side.at(angle).topRightCorner<2, 1>().norm();
}

double ArmPose::angleOf(const Elbow& elbow, bool shoulder, const Vector7& q) const {
  Vector7 member;
  solve(elbow, 0.0, nullptr, q, member);
  const ArmCircle::Group& group = shoulder ? arm_->shoulder() : arm_->wrist();
  const int first = shoulder ? 0 : 4;
  const Matrix3 turned = rotationAbout(group.axis[0], q[first]) * rotationAbout(group.axis[1], member[first + 1]) *
                         rotationAbout(group.axis[2], q[first + 2]);
  const Matrix3 M = group.problem.nearFrame().transpose() * turned * group.problem.farFrame();
  const Side& side = shoulder ? elbow.shoulder : elbow.wrist;
  const Matrix3 turn = side.before.transpose() * M * side.behind.transpose();
  return side.sense * std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1));
}

std::optional<ArmPose::Elbow> ArmPose::bentFor(const Elbow& straight, bool shoulder, const Vector7& q) const {
  const int first = shoulder ? 0 : 4;
  const auto gapAt = [&](const Elbow& elbow) {
    return gapOf(shoulder ? elbow.shoulder : elbow.wrist, q[first], q[first + 2]);
  };
  const double gap = gapAt(straight);
  const double change = gapAt(elbowAt(straight.q + kMostBend)) - gapAt(elbowAt(straight.q - kMostBend));
  const double slope = change / (2.0 * kMostBend);
  const bool enough = std::abs(slope) * kMostBend > std::abs(gap);
  const double bend = enough ? -gap / slope : std::copysign(kMostBend, -gap * slope);
  if (std::abs(gap + slope * bend) > kMostGap) return std::nullopt;
  return elbowAt(straight.q + bend);
}

/// Joint velocities at unit rate of the arm angle: the shoulder turns the arm about the line, the wrist turns back.
Vector7 ArmPose::rates(const Elbow& elbow, const Vector7& q) const {
  // The axes of a group where its base has turned by R, which then is what lies behind the group.
  const auto axesOf = [&](const ArmCircle::Group& group, int first, Matrix3& R) {
    std::array<Vector3, 3> axes;
    for (std::size_t i = 0; i < 3; ++i) {
      axes[i] = R * group.axis[i];
      R = R * rotationAbout(group.axis[i], q[first + static_cast<int>(i)]);
    }
    return axes;
  };
  Matrix3 R = Matrix3::Identity();
  const std::array<Vector3, 3> s = axesOf(arm_->shoulder(), 0, R);
  R = R * elbow.turn;
  const std::array<Vector3, 3> w = axesOf(arm_->wrist(), 4, R);
  Vector7 rate;
  rate << made(line_, s[0], s[1], s[2]), 0.0, made(-line_, w[0], w[1], w[2]);
  return rate;
}

}  // namespace screwline
