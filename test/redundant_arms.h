#ifndef SCREWLINE_TEST_REDUNDANT_ARMS_H
#define SCREWLINE_TEST_REDUNDANT_ARMS_H

#include <algorithm>
#include <array>

#include "ik_arms.h"

namespace screwline {
namespace test {

using Table = std::array<std::array<double, 3>, 7>;  ///< a_{i-1}, alpha_{i-1}, d_i of each joint.

/// A chain from modified Denavit-Hartenberg rows, the last frame's pose, and limits.
inline SerialChain chainOf(const Table& table, const Pose& tool, const std::array<double, 7>& lower,
                           const std::array<double, 7>& upper) {
  ChainDescription description;
  description.name = "arm";
  description.base_link = "base_link";
  description.tip_link = "tool0";
  Pose X;
  for (std::size_t i = 0; i < 7; ++i) {
    X = X * Pose{rotationAbout(Vector3::UnitX(), table[i][1]), Vector3(table[i][0], 0, 0)};
    X = X * Pose{Matrix3::Identity(), Vector3(0, 0, table[i][2])};
    Axis axis;
    axis.direction = X.R.col(2).normalized();
    axis.point = X.p;
    axis.source = static_cast<int>(i);
    Joint joint;
    joint.name = "joint" + std::to_string(i + 1);
    joint.limits.lower = lower[i];
    joint.limits.upper = upper[i];
    description.axes.push_back(axis);
    description.joints.push_back(joint);
  }
  description.home = X * tool;
  description.links = {{"tool0", 7, description.home}};
  return SerialChain(description);
}

/// Lengths and ranges of the KUKA LBR iiwa 14 R820 (its data sheet): 0.36, 0.42, 0.4, 0.126 m; 170, 120 and 175
/// degrees.
inline SerialChain iiwa14() {
  const double h = 0.5 * kPi;
  const double degree = kPi / 180.0;
  const std::array<double, 7> upper{
      {170 * degree, 120 * degree, 170 * degree, 120 * degree, 170 * degree, 120 * degree, 175 * degree}};
  std::array<double, 7> lower{};
  for (std::size_t i = 0; i < 7; ++i) lower[i] = -upper[i];
  const Table table{
      {{{0, 0, 0.36}}, {{0, -h, 0}}, {{0, h, 0.42}}, {{0, h, 0}}, {{0, -h, 0.4}}, {{0, -h, 0}}, {{0, h, 0}}}};
  return chainOf(table, {Matrix3::Identity(), Vector3(0, 0, 0.126)}, lower, upper);
}

/// Denavit-Hartenberg parameters and limits of the Franka Emika Panda (Franka Control Interface documentation).
inline SerialChain panda() {
  const double h = 0.5 * kPi;
  const Table table{{{{0, 0, 0.333}},
                     {{0, -h, 0}},
                     {{0, h, 0.316}},
                     {{0.0825, h, 0}},
                     {{-0.0825, -h, 0.384}},
                     {{0, h, 0}},
                     {{0.088, h, 0}}}};
  return chainOf(table, {Matrix3::Identity(), Vector3(0, 0, 0.107)},
                 {{-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973}},
                 {{2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973}});
}

/// Random arms of seven joints.
class RedundantArmMaker : public ArmMaker {
 public:
  using ArmMaker::ArmMaker;

  static constexpr int kGeneral = 4;
  static constexpr int kParallelOnRail = 5;
  static constexpr int kClasses = 6;

  /// 0: spherical wrist, any four turns before it; 1: spherical shoulder; 2: S-R-S; 3: a rail under six joints with a
  /// wrist; 4: no two axes meet; 5: three parallel axes, and two that meet, on a rail.
  SerialChain makeArm(int kind, bool limited) {
    std::vector<Axis> axes;
    const Vector3 center = vector(0.7);
    const auto sphere = [&](const Vector3& at) {
      const Vector3 first = direction();
      const Vector3 second = anyPerpendicular(first);
      for (const Vector3& d : {first, second, first}) axes.push_back(turn(d, at));
    };
    if (kind == 0) {
      for (int i = 0; i < 4; ++i) axes.push_back(turn(direction(), vector(0.5)));
      sphere(center);
    } else if (kind == 1) {
      sphere(vector(0.2));
      for (int i = 0; i < 4; ++i) axes.push_back(turn(direction(), vector(0.5)));
    } else if (kind == 2) {
      sphere(Vector3::Zero());
      axes.push_back(turn(Vector3::UnitY(), {0, 0, length()}));
      sphere({0, 0, 1.0 + length()});
    } else if (kind == 3) {
      const double a = length();
      const double b = length();
      axes = {slide(direction()), turn(Vector3::UnitZ(), {0, 0, 0}), turn(Vector3::UnitY(), {0, 0, a}),
              turn(Vector3::UnitY(), {b, 0, a})};
      sphere({b + length(), 0.1, a});
    } else if (kind == kGeneral) {
      for (int i = 0; i < 7; ++i) axes.push_back(turn(direction(), vector(0.5)));
    } else {
      // Of the kind of Universal Robots' arms, on a rail.
      const double a = length();
      const double b = length();
      const double h = 0.3 * length();
      axes = {slide(direction()), turn(Vector3::UnitZ(), {0, 0, 0}), turn(Vector3::UnitY(), {0, 0, a}),
              turn(Vector3::UnitY(), {b, 0, a}), turn(Vector3::UnitY(), {b + length(), 0, a})};
      axes.push_back(turn(Vector3::UnitZ(), axes.back().point + Vector3(0, h, 0)));
      axes.push_back(turn(Vector3::UnitY(), axes.back().point + Vector3(0, 0, h)));
    }
    const SerialChain free = chain(axes, {pose().R, center + vector(0.4)}, pose());
    return limited ? withLimits(free) : free;
  }

 private:
  SerialChain withLimits(const SerialChain& free) {
    ChainDescription description;
    description.name = free.name();
    description.base_link = free.baseLink();
    description.tip_link = free.tipLink();
    description.joints = free.joints();
    for (Joint& joint : description.joints) {
      if (joint.isRevolute()) joint.type = JointType::kRevolute;
      const double size = joint.isRevolute() ? 1.0 : 0.3;
      joint.limits.lower = -size * uniform(1.5, 3.1);
      joint.limits.upper = size * uniform(1.5, 3.1);
    }
    description.axes = free.axes();
    description.home = free.home();
    description.links = free.links();
    return SerialChain(description);
  }
};

/// A configuration within limits (of joints without: of one turn).
inline VectorX randomWithin(ArmMaker& maker, const SerialChain& chain) {
  VectorX q(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    const double size = chain.joint(i).isRevolute() ? kPi : 0.3;
    q[i] = maker.uniform(std::max(-size, chain.joint(i).limits.lower), std::min(size, chain.joint(i).limits.upper));
  }
  return q;
}

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_REDUNDANT_ARMS_H
