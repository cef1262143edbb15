#ifndef SCREWLINE_MODEL_JOINT_H
#define SCREWLINE_MODEL_JOINT_H

#include <limits>
#include <string>

#include "screwline/spatial/pose.h"

namespace screwline {

enum class JointType { kRevolute, kContinuous, kPrismatic };

/// "revolute", "continuous" or "prismatic".
const char* toString(JointType type);

/// Bounds of one joint, rad or m and per s, s^2, s^3. Infinite position bounds mean none.
struct JointLimits {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double velocity = std::numeric_limits<double>::infinity();
  double acceleration = std::numeric_limits<double>::infinity();
  double jerk = std::numeric_limits<double>::infinity();
  bool velocity_assumed = false;      ///< The robot description gives none.
  bool acceleration_assumed = false;  ///< Full speed within kAssumedAccelerationTime.
  bool jerk_assumed = false;          ///< Full acceleration within kAssumedJerkTime.
};

constexpr double kAssumedVelocity = 1.0;           ///< rad/s or m/s, where a description gives none.
constexpr double kAssumedAccelerationTime = 0.25;  ///< s from rest to full speed.
constexpr double kAssumedJerkTime = 0.05;          ///< s from none to full acceleration.

/// One degree of freedom of a chain: its name, type, limits.
struct Joint {
  std::string name;
  JointType type = JointType::kRevolute;
  JointLimits limits;

  bool isRevolute() const { return type != JointType::kPrismatic; }
};

/// A joint that moves in the chain, base to tip: an axis at the zero configuration, driven by one degree of freedom.
/// Usually joint i drives axis i; a mimic joint is one more axis, driven by the joint it mimics.
struct Axis {
  bool prismatic = false;
  Vector3 direction = Vector3::UnitZ();  ///< Unit vector, base frame, zero configuration.
  Vector3 point = Vector3::Zero();       ///< [m] a point on the axis, base frame, zero configuration.
  int source = 0;                        ///< Index of the joint that drives it.
  double multiplier = 1.0;               ///< Its displacement is multiplier * q[source].
};

}  // namespace screwline

#endif  // SCREWLINE_MODEL_JOINT_H
