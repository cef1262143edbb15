#include "screwline/ik/task_error.h"

#include "screwline/spatial/screw.h"

namespace screwline {

TaskError taskError(const Task& task, const Pose& target, const Pose& actual) {
  TaskError error;
  Vector6 difference = Vector6::Zero();
  if (task.rotationCount() > 0) {
    difference = poseDifference(target, actual);
  } else {
    difference.head<3>() = target.p - actual.p;
  }
  for (int i = 0; i < task.size(); ++i) error.twist[task.row(i)] = difference[task.row(i)];
  error.position = error.twist.head<3>().norm();
  error.orientation = error.twist.tail<3>().norm();
  return error;
}

}  // namespace screwline
