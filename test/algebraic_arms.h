#ifndef SCREWLINE_TEST_ALGEBRAIC_ARMS_H
#define SCREWLINE_TEST_ALGEBRAIC_ARMS_H

#include <array>
#include <string>
#include <vector>

#include "ik_arms.h"

namespace screwline {
namespace test {

/// One row of a modified DH table (Craig): a_{i-1} [m], alpha_{i-1} [rad], d_i [m].
struct DhRow {
  double a;
  double alpha;
  double d;
};

/// Arms with six turns and no closed form, by their modified DH tables; the tool is Trans(tool_a, 0, 0)
/// Rot_x(tool_alpha).
struct AlgebraicArm {
  std::string name;
  std::array<DhRow, 6> rows;
  double tool_a = 0.0;
  double tool_alpha = 0.0;

  SerialChain chain() const {
    std::vector<Axis> axes;
    Pose X;
    for (const DhRow& row : rows) {
      X = X * Pose{rotationAbout(Vector3::UnitX(), row.alpha), {row.a, 0.0, 0.0}};
      axes.push_back(ArmMaker::turn(X.R.col(2), X.p));
      X = X * Pose{Matrix3::Identity(), {0.0, 0.0, row.d}};
    }
    X = X * Pose{rotationAbout(Vector3::UnitX(), tool_alpha), {tool_a, 0.0, 0.0}};
    return ArmMaker::chain(axes, X, Pose());
  }
};

constexpr double kRight = 0.5 * kPi;
constexpr double kDegree = kPi / 180.0;

/// Has poses with 16 real solutions: shown by search in the test. Its shape (neighbouring axes alternately at a right
/// angle and at one degree) is that of the example in Manocha & Canny, Efficient inverse kinematics for general 6R
/// manipulators, IEEE Transactions on Robotics and Automation 10(5), 1994; the numbers are not checked against the
/// paper.
inline AlgebraicArm sixteenArm() {
  return {"sixteen",
          {{{0.0, 0.0, 0.0},
            {0.3, kRight, 0.0},
            {1.0, kDegree, 0.2},
            {0.0, kRight, 0.0},
            {1.5, kDegree, 0.0},
            {0.0, kRight, 0.0}}},
          1.1353,
          kDegree};
}

/// Offset wrist of the Fanuc CRX kind (upper arm and forearm 0.54 m, wrist offset 0.15 m, flange 0.16 m): up to 16.
inline AlgebraicArm offsetWristArm() {
  return {"offset wrist",
          {{{0.0, 0.0, 0.0},
            {0.0, -kRight, 0.0},
            {0.54, 0.0, 0.0},
            {0.0, -kRight, 0.54},
            {0.0, kRight, -0.15},
            {0.0, -kRight, 0.16}}}};
}

/// Wrist bent by 60 degrees twice, as Kinova's Jaco 2 has (its published classic DH parameters): up to 12.
inline AlgebraicArm bentWristArm() {
  return {"bent wrist",
          {{{0.0, 0.0, 0.2755},
            {0.0, kRight, 0.0},
            {0.41, kPi, -0.0098},
            {0.0, kRight, -0.250197},
            {0.0, kPi / 3.0, -0.085794},
            {0.0, kPi / 3.0, -0.211597}}},
          0.0,
          kPi};
}

/// Universal Robots UR5 (published DH parameters): three parallel axes; has a closed form, and is hard for elimination.
inline AlgebraicArm parallelArm() {
  return {"three parallel axes",
          {{{0.0, 0.0, 0.089159},
            {0.0, kRight, 0.0},
            {-0.425, 0.0, 0.0},
            {-0.39225, 0.0, 0.10915},
            {0.0, kRight, 0.09465},
            {0.0, -kRight, 0.0823}}}};
}

/// Every axis moved and turned by up to `size`.
inline SerialChain perturbed(const SerialChain& chain, double size, unsigned seed) {
  ArmMaker maker(seed);
  std::vector<Axis> axes = chain.axes();
  for (Axis& axis : axes) {
    axis.direction = (axis.direction + maker.vector(size)).normalized();
    axis.point += maker.vector(size);
  }
  return ArmMaker::chain(axes, chain.home(), Pose());
}

/// Six axes in general position; `slide` is prismatic (-1: none).
inline SerialChain generalArm(ArmMaker& maker, int slide) {
  std::vector<Axis> axes;
  for (int i = 0; i < 6; ++i) axes.push_back(ArmMaker::turn(maker.direction(), maker.vector(0.6)));
  if (slide >= 0) axes[static_cast<std::size_t>(slide)].prismatic = true;
  return ArmMaker::chain(axes, maker.pose(), maker.pose());
}

/// An axis along a base axis, of either sense, its point a few steps of 0.1 m from that of the axis before.
inline Axis latticeAxis(ArmMaker& maker, const Axis& before) {
  const Vector3 step(maker.index(5) - 2, maker.index(5) - 2, maker.index(5) - 2);
  return ArmMaker::turn(maker.sign() * Vector3::Unit(maker.index(3)), before.point + 0.1 * step);
}

/// Four turns and two slides in general position.
inline SerialChain twoSlideArm(ArmMaker& maker) {
  std::vector<Axis> axes = generalArm(maker, 1).axes();
  axes[4].prismatic = true;
  return ArmMaker::chain(axes, maker.pose(), Pose());
}

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_ALGEBRAIC_ARMS_H
