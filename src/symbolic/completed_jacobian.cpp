#include "completed_jacobian.h"

#include <vector>

namespace screwline {
namespace {

/// Rows first..first+2 that the task leaves out, from 0.
std::vector<int> leftOut(const Task& task, int first) {
  std::vector<int> missing;
  for (int k = 0; k < 3; ++k) {
    if (!task.contains(first + k)) missing.push_back(k);
  }
  return missing;
}

}  // namespace

TrigMatrix completedJacobian(const ExactChain& exact, const Task& task, int axes, int point) {
  const int tip = exact.size + 1;
  TrigMatrix J(exact.ring, 6, exact.joints + 6 - task.size());
  J.setBlock(0, 0, exact.jacobian(axes, point));
  int column = exact.joints;
  const TrigMatrix identity = TrigMatrix::identity(exact.ring, 3);
  // All three together fill the same space in any axes.
  const std::vector<int> slides = leftOut(task, 0);
  const TrigMatrix along = slides.size() == 3 ? identity : exact.pose(axes, 0).R;
  for (const int k : slides) J.setBlock(0, column++, along.column(k));
  const std::vector<int> turns = leftOut(task, task.usesToolAxes() ? Task::kFirstToolRow : 3);
  const TrigMatrix about = turns.size() == 3 ? identity : exact.pose(axes, task.usesToolAxes() ? tip : 0).R;
  const TrigMatrix from_tip = exact.pose(axes, point).p - exact.pose(axes, tip).p;
  for (const int k : turns) {
    J.setBlock(0, column, cross(about.column(k), from_tip));
    J.setBlock(3, column++, about.column(k));
  }
  return J;
}

}  // namespace screwline
