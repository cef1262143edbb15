#ifndef SCREWLINE_TEST_PROPERTY_MODEL_RANDOM_H
#define SCREWLINE_TEST_PROPERTY_MODEL_RANDOM_H

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "screwline/model/serial_chain.h"
#include "screwline/spatial/rotation.h"

namespace screwline {

/// Random chains whose neighbouring axes have every special relation, in random places.
class RandomModel {
 public:
  explicit RandomModel(unsigned seed) : engine_(seed) {}

  double uniform(double lower, double upper) { return std::uniform_real_distribution<double>(lower, upper)(engine_); }
  int integer(int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(engine_); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  Vector3 point() { return {uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-1.0, 1.0)}; }

  Vector3 direction() {
    Vector3 v = point();
    while (v.norm() < 0.1) v = point();
    return v.normalized();
  }

  Pose pose() { return {rotationAbout(direction(), uniform(-kPi, kPi)), point()}; }

  VectorX configuration(int size) {
    VectorX q(size);
    for (int i = 0; i < size; ++i) q[i] = uniform(-3.0, 3.0);
    return q;
  }

  /// An axis related to `previous` in one of the special ways, or in none.
  Axis axisAfter(const Axis& previous) {
    Axis axis;
    axis.prismatic = chance(0.3);
    const Vector3& u = previous.direction;
    const Vector3 across = rotationAbout(u, uniform(-kPi, kPi)) * anyPerpendicular(u);
    const double along = chance(0.5) ? 0.0 : uniform(-1.0, 1.0);
    axis.point = previous.point + along * u;
    switch (integer(0, 7)) {
      case 0:  // Parallel or antiparallel.
        axis.direction = chance(0.5) ? u : Vector3(-u);
        axis.point += uniform(0.1, 1.0) * across;
        break;
      case 1:  // Coincident.
        axis.direction = chance(0.5) ? u : Vector3(-u);
        break;
      case 2:  // Meeting at a right angle.
        axis.direction = across;
        break;
      case 3:  // Meeting at some angle.
        axis.direction = (across + uniform(-2.0, 2.0) * u).normalized();
        break;
      case 4:  // At a right angle, not meeting.
        axis.direction = across;
        axis.point += uniform(0.1, 1.0) * u.cross(across);
        break;
      case 5:  // Along an axis of the base.
        axis.direction = Vector3::Unit(integer(0, 2)) * (chance(0.5) ? 1.0 : -1.0);
        break;
      default:
        axis.direction = direction();
        axis.point = point();
    }
    // What is neither parallel nor clearly skewed has its own tests.
    return nearlyParallel(u, axis.direction) ? axisAfter(previous) : axis;
  }

  std::vector<Axis> axes(int count) {
    Axis base;
    if (chance(0.5)) base.point = point();
    std::vector<Axis> result;
    for (int i = 0; i < count; ++i) {
      result.push_back(axisAfter(i == 0 ? base : result.back()));
      result.back().source = i;
    }
    return result;
  }

  /// A chain of `count` axes, with links for all of them; with mimic, about one in four is driven by another axis'
  /// joint.
  SerialChain chain(int count, bool mimic = false) {
    ChainDescription d;
    d.name = "random";
    d.base_link = "base";
    d.tip_link = "tip";
    d.axes = axes(count);
    d.home = pose();
    d.links.push_back({"base", 0, {}});
    for (int i = 0; i < count; ++i) {
      Axis& axis = d.axes[static_cast<std::size_t>(i)];
      if (mimic && i > 0 && chance(0.25)) {
        axis.source = integer(0, static_cast<int>(d.joints.size()) - 1);
        axis.multiplier = uniform(0.3, 1.7) * (chance(0.5) ? 1.0 : -1.0);
      } else {
        axis.source = static_cast<int>(d.joints.size());
        d.joints.push_back(joint(axis.prismatic));
        d.joints.back().name = "joint" + std::to_string(axis.source);
      }
      Pose X = pose();
      X.p = axis.point;
      d.links.push_back({"link" + std::to_string(i), i + 1, X});
      if (chance(0.2)) d.links.push_back({"beside" + std::to_string(i), i + 1, pose()});
    }
    d.links.push_back({"tip", count, d.home});
    return SerialChain(d);
  }

 private:
  static bool nearlyParallel(const Vector3& a, const Vector3& b) {
    const double sine = a.cross(b).norm();
    return sine > 1e-13 && sine < 1e-2;
  }

  Joint joint(bool prismatic) {
    Joint result;
    result.type = prismatic ? JointType::kPrismatic : chance(0.3) ? JointType::kContinuous : JointType::kRevolute;
    if (result.type != JointType::kContinuous) {
      result.limits.lower = uniform(-3.0, 0.0);
      result.limits.upper = uniform(0.0, 3.0);
    }
    result.limits.velocity = uniform(0.1, 3.0);
    result.limits.acceleration = uniform(0.1, 9.0);
    result.limits.jerk = uniform(1.0, 90.0);
    return result;
  }

  std::mt19937 engine_;
};

}  // namespace screwline

#endif  // SCREWLINE_TEST_PROPERTY_MODEL_RANDOM_H
