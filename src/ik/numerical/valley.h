#ifndef SCREWLINE_IK_NUMERICAL_VALLEY_H
#define SCREWLINE_IK_NUMERICAL_VALLEY_H

#include <cstddef>
#include <vector>

#include "joint_box.h"

namespace screwline {

/// The curve on which solutions lie that are about to meet, of a chain with as many joints as the task has rows: where
/// the residual has no part but that along the direction u which the Jacobian is about to lose. What is left of it, the
/// depth g = u . residual, is a function of one variable along the curve; its zeros are the solutions, however close
/// they are to each other (Lyapunov-Schmidt reduction). A fold is crossed, a ring (an aligned wrist) goes round.
class Valley {
 public:
  /// `bound`: of |g| within which the curve is followed.
  Valley(TaskResidual& residual, const JointBox& box, double bound);

  /// Follows the curve through the point next to `start` to both ends, or round. False where it could not be followed
  /// (two directions are about to be lost at once).
  bool trace(const ConstVectorRef& start);

  /// Next to the zeros found by all traces, and where g touches zero within rounding.
  const std::vector<JointVector>& roots() const { return roots_; }

  /// Whether the last trace met nothing but zeros: the curve is a continuum of solutions. It has no roots then.
  bool isContinuum() const { return continuum_; }
  /// Of the last trace, a continuum: its member with the joint that parametrises it at the preferred value.
  JointVector memberNear(const ConstVectorRef& preferred);
  /// That joint: the one that moves most there.
  int freeJoint() const { return free_joint_; }

  /// Points of the last trace.
  std::vector<JointVector> lastPath() const {
    return {path_.begin() + static_cast<std::ptrdiff_t>(last_path_), path_.end()};
  }

  /// Whether a curve that was followed passes there.
  bool passes(const ConstVectorRef& q) const { return isNearAny(box_, path_, q); }
  static bool isNearAny(const JointBox& box, const std::vector<JointVector>& path, const ConstVectorRef& q);

 private:
  struct Node {
    JointVector q;
    JointVector tangent;  ///< Scaled, unit length.
    TaskVector lost;      ///< u.
    double depth = 0.0;   ///< g.
    int corrections = 0;
  };

  bool settle(Node& node, const Node* reference);
  bool follow(const Node& origin, double direction);
  bool stepFrom(const Node& from, double length, Node& to);
  bool between(const Node& a, const Node& b, double fraction, Node& middle);
  bool hasPassed(const Node& origin, const Node& node, double direction) const;
  JointVector difference(const JointVector& a, const JointVector& b) const;
  void bracket(Node a, Node b);
  void touch(Node a, Node b, Node c);

  TaskResidual& residual_;
  const JointBox& box_;
  double bound_;
  double rounding_;
  bool continuum_ = false;
  JointVector foot_;
  int free_joint_ = 0;
  double deepest_ = 0.0;
  TaskPoint point_;
  std::vector<JointVector> roots_;
  std::vector<JointVector> path_;
  std::size_t last_path_ = 0;
};

}  // namespace screwline

#endif  // SCREWLINE_IK_NUMERICAL_VALLEY_H
