#include "screwline/ik/task_error.h"

#include "pointing.h"
#include "screwline/spatial/screw.h"

namespace screwline {

TaskError taskError(const Task& task, const Pose& target, const Pose& actual) {
  TaskError error;
  Vector6 difference = Vector6::Zero();
  const int pointing = task.pointingAxis();
  if (pointing >= 0 || task.rotationCount() == 0) {
    difference.head<3>() = target.p - actual.p;
    if (pointing >= 0) difference.tail<3>() = pointingTurn(target.R, actual.R, pointing);
  } else {
    difference = poseDifference(target, actual);
  }
  for (int i = 0; i < task.size(); ++i) {
    const int row = task.row(i);
    if (row < Task::kFirstToolRow) {
      error.twist[row] = difference[row];
    } else {
      const Vector3 axis = task.axisOf(i, actual.R);
      error.twist.tail<3>() += axis.dot(difference.tail<3>()) * axis;
    }
  }
  error.position = error.twist.head<3>().norm();
  error.orientation = error.twist.tail<3>().norm();
  return error;
}

}  // namespace screwline
