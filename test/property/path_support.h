#ifndef SCREWLINE_TEST_PROPERTY_PATH_SUPPORT_H
#define SCREWLINE_TEST_PROPERTY_PATH_SUPPORT_H

#include <algorithm>
#include <vector>

#include "property/trajectory_random.h"
#include "screwline/trajectory/joint_trajectory.h"
#include "screwline/trajectory/path.h"

namespace screwline {
namespace trajectory_test {

inline std::vector<double> uniformKnots(Eigen::Index count) {
  std::vector<double> knots;
  for (Eigen::Index k = 0; k < count; ++k) knots.push_back(static_cast<double>(k) / static_cast<double>(count - 1));
  return knots;
}

inline MatrixX randomWay(Random& random, int joints, int count) {
  MatrixX way(joints, count);
  for (int k = 0; k < count; ++k) way.col(k) = random.vector(joints, -2.0, 2.0);
  return way;
}

inline JointPath randomSpline(Random& random, int joints, int count) {
  return naturalSplinePath(uniformKnots(count), randomWay(random, joints, count));
}

/// The largest share of a limit that is used, up to the order (2: accelerations, 3: jerks), by samples alone: between
/// them and at them.
inline double denseUse(const JointTrajectory& motion, const Limits& limits, int steps, int orders) {
  TrajectoryPoint point(motion.joints());
  double use = 0.0;
  for (int i = 0; i <= steps; ++i) {
    motion.sample(motion.duration() * i / steps, point);
    use = std::max(use, (point.velocity.array().abs() / limits.velocity.array()).maxCoeff());
    use = std::max(use, (point.acceleration.array().abs() / limits.acceleration.array()).maxCoeff());
    if (orders > 2) use = std::max(use, (point.jerk.array().abs() / limits.jerk.array()).maxCoeff());
  }
  return use;
}

}  // namespace trajectory_test
}  // namespace screwline

#endif  // SCREWLINE_TEST_PROPERTY_PATH_SUPPORT_H
