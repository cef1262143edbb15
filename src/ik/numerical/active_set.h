#ifndef SCREWLINE_IK_NUMERICAL_ACTIVE_SET_H
#define SCREWLINE_IK_NUMERICAL_ACTIVE_SET_H

#include "joint_box.h"

namespace screwline {

/// Joints that a step may move, and the steps that they then make.
class ActiveSet {
 public:
  explicit ActiveSet(const JointBox& box) : box_(&box) {}

  /// Freezes the joints that press against a bound and lets go those whose gradient leads inwards. Also computes the
  /// cost's gradient.
  void update(const TaskPoint& point);

  const JointVector& gradient() const { return gradient_; }
  int freeCount() const { return free_count_; }
  int freeJoint(int k) const { return free_[static_cast<std::size_t>(k)]; }

  /// Mean square of a free joint's column in scaled units: what one unit of step changes the residual by.
  double columnScale(const TaskPoint& point) const;

  /// Damped least-squares step (J^T J + lambda) dz = J^T e of the free joints, in scaled units z; joints that would
  /// pass their bound stop there, and the others are solved for again. Returns dq.
  const JointVector& step(const TaskPoint& point, double lambda);

 private:
  void gather(const TaskPoint& point);
  void solve(double lambda, const TaskVector& residual);
  bool stopAtBounds(const TaskPoint& point);

  const JointBox* box_;
  JointVector gradient_;
  JointVector step_;
  std::array<int, kMaxJoints> free_{};
  int free_count_ = 0;
  // Of the joints that one step has not stopped yet.
  TaskMatrix J_;
  JointVector scaled_step_;
  std::array<int, kMaxJoints> moving_{};
  int moving_count_ = 0;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_NUMERICAL_ACTIVE_SET_H
