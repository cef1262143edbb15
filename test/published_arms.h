#ifndef SCREWLINE_TEST_PUBLISHED_ARMS_H
#define SCREWLINE_TEST_PUBLISHED_ARMS_H

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "screwline/kinematics/forward.h"
#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace test {

/// One joint of a modified Denavit-Hartenberg table, with limits: rad, m.
struct ArmJoint {
  double alpha;
  double a;
  double d;
  double theta;
  double lower;
  double upper;
  bool prismatic = false;
};

struct PublishedArm {
  std::string name;
  std::vector<ArmJoint> joints;
  double tool;  ///< [m] along the last axis.
};

/// What is put between a joint's nominal place and its real one.
using Misplacement = std::function<Pose()>;

inline SerialChain chainOf(const PublishedArm& arm, const Misplacement& misplacement = nullptr) {
  ChainDescription description;
  description.name = arm.name;
  description.base_link = "base_link";
  description.tip_link = "tool0";
  Pose X;
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const ArmJoint& row = arm.joints[i];
    X = X * Pose{rotationAbout(Vector3::UnitX(), row.alpha), {row.a, 0.0, 0.0}} *
        Pose{rotationAbout(Vector3::UnitZ(), row.theta), {0.0, 0.0, row.d}};
    if (misplacement) X = X * misplacement();
    Axis axis;
    axis.prismatic = row.prismatic;
    axis.direction = X.R.col(2).normalized();
    axis.point = X.p;
    axis.source = static_cast<int>(i);
    description.axes.push_back(axis);
    Joint joint;
    joint.name = "joint" + std::to_string(i + 1);
    joint.type = row.prismatic ? JointType::kPrismatic : JointType::kRevolute;
    joint.limits.lower = row.lower;
    joint.limits.upper = row.upper;
    description.joints.push_back(joint);
  }
  description.home = X * Pose{Matrix3::Identity(), {0.0, 0.0, arm.tool}};
  description.links = {{"tool0", static_cast<int>(arm.joints.size()), description.home}};
  return SerialChain(std::move(description));
}

/// Random errors of every joint's place, up to `angle` about and `length` along each axis.
inline Misplacement calibrationErrors(unsigned seed, double angle, double length) {
  return [random = std::mt19937(seed), angle, length]() mutable {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const Vector3 turn(unit(random), unit(random), unit(random));
    const Vector3 move(unit(random), unit(random), unit(random));
    const Matrix3 R = rotationAbout(Vector3::UnitX(), angle * turn.x()) *
                      rotationAbout(Vector3::UnitY(), angle * turn.y()) *
                      rotationAbout(Vector3::UnitZ(), angle * turn.z());
    return Pose{R, length * move};
  };
}

/// The arm with pi as someone wrote it down: angles that are multiples of pi/2 with few digits.
inline PublishedArm withRoundedPi(PublishedArm arm, double pi) {
  for (ArmJoint& joint : arm.joints) {
    joint.alpha *= pi / kPi;
    joint.theta *= pi / kPi;
  }
  return arm;
}

constexpr double kDegree = kPi / 180.0;

/// Craig, Introduction to Robotics, table 3.6; limits of Corke & Armstrong-Helouvry 1994.
inline PublishedArm puma560() {
  const double d = kDegree;
  return {"puma560",
          {{0, 0, 0, 0, -160 * d, 160 * d},
           {-90 * d, 0, 0, 0, -225 * d, 45 * d},
           {0, 0.4318, 0.15005, 0, -45 * d, 225 * d},
           {-90 * d, 0.0203, 0.4318, 0, -110 * d, 170 * d},
           {90 * d, 0, 0, 0, -100 * d, 100 * d},
           {-90 * d, 0, 0, 0, -266 * d, 266 * d}},
          0.05625};
}

/// KUKA KR 6 R900 sixx, data sheet.
inline PublishedArm kr6() {
  const double d = kDegree;
  return {"kr6_r900",
          {{0, 0, 0.4, 0, -170 * d, 170 * d},
           {-90 * d, 0.025, 0, 0, -190 * d, 45 * d},
           {0, 0.455, 0, -90 * d, -120 * d, 156 * d},
           {-90 * d, 0.035, 0.42, 0, -185 * d, 185 * d},
           {90 * d, 0, 0, 0, -120 * d, 120 * d},
           {-90 * d, 0, 0, 0, -350 * d, 350 * d}},
          0.08};
}

/// Universal Robots, "DH parameters for calculations of kinematics and dynamics".
inline PublishedArm ur5() {
  const double d = kDegree;
  return {"ur5",
          {{0, 0, 0.089159, 0, -kTwoPi, kTwoPi},
           {90 * d, 0, 0, 0, -kTwoPi, kTwoPi},
           {0, -0.425, 0, 0, -kPi, kPi},
           {0, -0.39225, 0.10915, 0, -kTwoPi, kTwoPi},
           {90 * d, 0, 0.09465, 0, -kTwoPi, kTwoPi},
           {-90 * d, 0, 0, 0, -kTwoPi, kTwoPi}},
          0.0823};
}

/// Franka Emika, "Robot and interface specifications".
inline PublishedArm panda() {
  const double d = kDegree;
  return {"panda",
          {{0, 0, 0.333, 0, -2.8973, 2.8973},
           {-90 * d, 0, 0, 0, -1.7628, 1.7628},
           {90 * d, 0, 0.316, 0, -2.8973, 2.8973},
           {90 * d, 0.0825, 0, 0, -3.0718, -0.0698},
           {-90 * d, -0.0825, 0.384, 0, -2.8973, 2.8973},
           {90 * d, 0, 0, 0, -0.0175, 3.7525},
           {90 * d, 0.088, 0, 0, -2.8973, 2.8973}},
          0.107};
}

/// KUKA LBR iiwa 14 R820, data sheet.
inline PublishedArm iiwa14() {
  const double d = kDegree;
  return {"iiwa14",
          {{0, 0, 0.36, 0, -170 * d, 170 * d},
           {-90 * d, 0, 0, 0, -120 * d, 120 * d},
           {90 * d, 0, 0.42, 0, -170 * d, 170 * d},
           {90 * d, 0, 0, 0, -120 * d, 120 * d},
           {-90 * d, 0, 0.4, 0, -170 * d, 170 * d},
           {-90 * d, 0, 0, 0, -120 * d, 120 * d},
           {90 * d, 0, 0, 0, -175 * d, 175 * d}},
          0.126};
}

/// KUKA youBot arm, five joints, data sheet.
inline PublishedArm youbot() {
  const double d = kDegree;
  return {"youbot",
          {{0, 0, 0.147, 0, -169 * d, 169 * d},
           {-90 * d, 0.033, 0, -90 * d, -65 * d, 90 * d},
           {0, 0.155, 0, 0, -151 * d, 146 * d},
           {0, 0.135, 0, -90 * d, -102.5 * d, 102.5 * d},
           {-90 * d, 0, 0, 0, -167.5 * d, 167.5 * d}},
          0.2175};
}

/// Nobody's: no two axes parallel, at right angles or meeting.
inline PublishedArm general6() {
  return {"general_6r",
          {{0, 0, 0.3, 0, -2.9, 2.9},
           {-1.4, 0.12, 0.05, 0, -2.0, 2.0},
           {0.25, 0.38, -0.08, -0.5, -2.4, 2.4},
           {-1.2, 0.07, 0.35, 0, -2.9, 2.9},
           {1.1, -0.05, 0.06, 0, -2.1, 2.1},
           {-1.3, 0.06, 0.04, 0, -3.1, 3.1}},
          0.12};
}

/// An iiwa 14 on a rail of 2 m.
inline PublishedArm iiwaOnRail() {
  PublishedArm arm = iiwa14();
  arm.name = "iiwa14_on_rail";
  arm.joints.front().alpha = -90 * kDegree;
  arm.joints.insert(arm.joints.begin(), {90 * kDegree, 0, 0, 0, -1.0, 1.0, true});
  return arm;
}

/// A Panda on a platform that moves in a square of 2 m and turns.
inline PublishedArm pandaOnPlatform() {
  const double d = kDegree;
  PublishedArm arm = panda();
  arm.name = "panda_on_platform";
  arm.joints.front().a = 0.1;
  const std::vector<ArmJoint> platform = {
      {90 * d, 0, 0, 90 * d, -1.0, 1.0, true}, {90 * d, 0, 0, 90 * d, -1.0, 1.0, true}, {90 * d, 0, 0.2, 0, -kPi, kPi}};
  arm.joints.insert(arm.joints.begin(), platform.begin(), platform.end());
  return arm;
}

/// A configuration within the chain's limits.
inline VectorX randomWithinLimits(const SerialChain& chain, std::mt19937& random) {
  VectorX q(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    const JointLimits& limits = chain.joint(i).limits;
    q[i] = std::uniform_real_distribution<double>(limits.lower, limits.upper)(random);
  }
  return q;
}

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_PUBLISHED_ARMS_H
