#ifndef SCREWLINE_TEST_UNIT_KINEMATICS_ARMS_H
#define SCREWLINE_TEST_UNIT_KINEMATICS_ARMS_H

#include <string>
#include <utility>
#include <vector>

#include "screwline/model/serial_chain.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace arms {

inline Axis turning(const Vector3& direction, const Vector3& point) {
  Axis axis;
  axis.direction = direction;
  axis.point = point;
  return axis;
}

inline Axis sliding(const Vector3& direction) {
  Axis axis;
  axis.prismatic = true;
  axis.direction = direction;
  return axis;
}

/// A chain of joints q1..qn without limits, tip at `tip`, axes parallel to the base's at zero.
inline SerialChain chainOf(std::vector<Axis> axes, const Vector3& tip, const JointLimits& limits = {}) {
  ChainDescription d;
  d.name = "arm";
  d.base_link = "base";
  d.tip_link = "tip";
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i].source = static_cast<int>(i);
    Joint joint;
    joint.name = "q" + std::to_string(i + 1);
    joint.type = axes[i].prismatic ? JointType::kPrismatic : JointType::kRevolute;
    joint.limits = limits;
    d.joints.push_back(joint);
  }
  d.axes = std::move(axes);
  d.home.p = tip;
  d.links = {{"base", 0, {}}, {"tip", static_cast<int>(d.axes.size()), d.home}};
  return SerialChain(d);
}

inline const Vector3 kX = Vector3::UnitX();
inline const Vector3 kY = Vector3::UnitY();
inline const Vector3 kZ = Vector3::UnitZ();

/// Yaw, pitch, pitch with a sideways offset at the elbow, and a spherical wrist with the tip beyond it: 6R.
inline SerialChain offsetArmWithWrist(const JointLimits& limits = {}) {
  const Vector3 shoulder(0.1, 0.15, 0.4);
  const Vector3 elbow = shoulder + 0.43 * kX;
  const Vector3 wrist = elbow + Vector3(0.38, 0.0, 0.02);
  return chainOf({turning(kZ, Vector3::Zero()), turning(kY, shoulder), turning(kY, elbow), turning(kX, wrist),
                  turning(kY, wrist), turning(kX, wrist)},
                 wrist + 0.1 * kX, limits);
}

/// Three parallel pitch axes and two offset wrist axes: 6R without a spherical wrist.
inline SerialChain parallelArm() {
  return chainOf({turning(kZ, Vector3::Zero()), turning(kY, 0.09 * kZ), turning(kY, {0.42, 0.0, 0.09}),
                  turning(kY, {0.81, 0.0, 0.09}), turning(-kZ, {0.81, 0.11, 0.0}), turning(kY, {0.81, 0.0, -0.01})},
                 {0.81, 0.19, -0.01});
}

/// Shoulder and wrist spherical, elbow between them: 7R.
inline SerialChain anthropomorphicArm() {
  const Vector3 shoulder = 0.3 * kZ;
  const Vector3 elbow = 0.7 * kZ;
  const Vector3 wrist = 1.1 * kZ;
  return chainOf({turning(kZ, shoulder), turning(kY, shoulder), turning(kZ, shoulder), turning(-kY, elbow),
                  turning(kZ, wrist), turning(kY, wrist), turning(kZ, wrist)},
                 1.2 * kZ);
}

/// Planar arm of `count` links of the given length.
inline SerialChain planarArm(int count, double length = 0.5) {
  std::vector<Axis> axes;
  for (int i = 0; i < count; ++i) axes.push_back(turning(kZ, i * length * kX));
  return chainOf(std::move(axes), count * length * kX);
}

}  // namespace arms
}  // namespace screwline

#endif  // SCREWLINE_TEST_UNIT_KINEMATICS_ARMS_H
