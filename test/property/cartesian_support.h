#ifndef SCREWLINE_TEST_PROPERTY_CARTESIAN_SUPPORT_H
#define SCREWLINE_TEST_PROPERTY_CARTESIAN_SUPPORT_H

#include <algorithm>
#include <string>
#include <vector>

#include "property/trajectory_random.h"
#include "screwline/ik/task_error.h"
#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/task_selection.h"
#include "screwline/model/urdf_reader.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace trajectory_test {

/// A shipped robot with its inverse kinematics.
struct Arm {
  explicit Arm(const std::string& robot)
      : chain(readUrdfFile(std::string(SCREWLINE_SOURCE_DIR) + "/urdf/" + robot + ".urdf")),
        task(deriveTask(chain)),
        kinematics(chain, task) {}

  Limits limits() const {
    Limits limits{VectorX::Constant(chain.size(), 2.0), VectorX::Constant(chain.size(), 8.0),
                  VectorX::Constant(chain.size(), 100.0), chain.lower(), chain.upper()};
    return limits;
  }

  PlanRequest request(const std::string& profile, const std::vector<Pose>& poses, const VectorX& present) const {
    PlanRequest result;
    result.profile = profile;
    result.limits = limits();
    result.kinematics = &kinematics;
    result.present = present;
    for (const Pose& pose : poses) {
      PathPoint waypoint;
      waypoint.pose = pose;
      result.waypoints.push_back(waypoint);
    }
    return result;
  }

  VectorX random(Random& random_source) const {
    VectorX q(chain.size());
    for (int i = 0; i < q.size(); ++i) {
      q[i] = random_source.uniform(std::max(chain.lower()[i], -2.9), std::min(chain.upper()[i], 2.9));
    }
    return q;
  }

  SerialChain chain;
  Task task;
  InverseKinematics kinematics;
};

/// How far (m + rad over the task) a pose is off the straight line with slerp from A to B, at its nearest place: an own
/// computation, from the projection of the position, or of the angle where the position stays.
inline double offLine(const Task& task, const Pose& A, const Pose& B, const Pose& X) {
  Vector3 way = B.p - A.p;
  for (int row = 0; row < 3; ++row) {
    if (!task.contains(row)) way[row] = 0.0;
  }
  const Vector3 turn = rotationVector(A.R.transpose() * B.R);
  const double angle = turn.norm();
  double s = 0.0;
  if (way.norm() > 1e-9) {
    s = way.dot(X.p - A.p) / way.squaredNorm();
  } else if (angle > 0.0) {
    s = turn.dot(rotationVector(A.R.transpose() * X.R)) / (angle * angle);
  }
  Pose target;
  target.p = A.p + s * (B.p - A.p);
  target.R = angle > 0.0 ? Matrix3(A.R * rotationAbout(turn / angle, s * angle)) : A.R;
  const TaskError error = taskError(task, target, X);
  return error.position + error.orientation + std::max(0.0, std::max(-s, s - 1.0));
}

/// Largest excess over limits of samples and of the steps between them, as a factor; at most 1 where all is kept.
inline double largestUse(const JointTrajectory& trajectory, const Limits& limits, int samples) {
  TrajectoryPoint point(trajectory.joints());
  VectorX before;
  double use = 0.0;
  for (int k = 0; k <= samples; ++k) {
    trajectory.sample(trajectory.duration() * k / samples, point);
    use = std::max(use, point.velocity.cwiseQuotient(limits.velocity).cwiseAbs().maxCoeff());
    use = std::max(use, point.acceleration.cwiseQuotient(limits.acceleration).cwiseAbs().maxCoeff());
    if (k > 0) {
      const VectorX step = (point.position - before) * (samples / trajectory.duration());
      use = std::max(use, step.cwiseQuotient(limits.velocity).cwiseAbs().maxCoeff());
    }
    before = point.position;
    for (int i = 0; i < point.position.size(); ++i) {
      if (point.position[i] < limits.lower[i] - 1e-9 || point.position[i] > limits.upper[i] + 1e-9) use = 99.0;
    }
  }
  return use;
}

inline std::string joined(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += note + "; ";
  return text;
}

}  // namespace trajectory_test
}  // namespace screwline

#endif  // SCREWLINE_TEST_PROPERTY_CARTESIAN_SUPPORT_H
