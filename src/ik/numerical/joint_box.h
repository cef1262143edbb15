#ifndef SCREWLINE_IK_NUMERICAL_JOINT_BOX_H
#define SCREWLINE_IK_NUMERICAL_JOINT_BOX_H

#include "task_residual.h"

namespace screwline {

/// What a unit of length is for the chain [m]: its characteristic length, or where all axes and the tip meet in one
/// point the longest slide within limits, else 1.
double lengthUnit(const SerialChain& chain);

/// The joint space of a search: bounds, which joints go round, what a step of one unit is.
class JointBox {
 public:
  /// Without `honour_limits` no joint is bounded. `reach` [m] is how far a slide without bounds may have to go.
  JointBox(const SerialChain& chain, bool honour_limits, double reach);

  int size() const { return static_cast<int>(lower_.size()); }
  double lower(int i) const { return lower_[i]; }
  double upper(int i) const { return upper_[i]; }

  /// True where q[i] and q[i] + 2 pi give the same pose (not for a joint that a mimic follows at half speed).
  bool isPeriodic(int i) const { return periodic_[static_cast<std::size_t>(i)]; }

  /// True where a step of the joint is never stopped: no bound, or a full turn within the bounds, so that what leaves
  /// on one side comes in on the other.
  bool isFree(int i) const { return free_[static_cast<std::size_t>(i)]; }

  /// What one unit of the scaled step is: 1 rad, or lengthUnit().
  double unit(int i) const { return unit_[i]; }

  /// Into the bounds: joints that go round by full turns, the others clamped. Joints without bounds keep their turn.
  void confine(JointVector& q) const;

  /// Joints without bounds that go round: to (-pi, pi].
  void wrapUnbounded(VectorX& q) const;

  /// Largest difference of two configurations in scaled units, full turns of periodic joints apart.
  double distance(const ConstVectorRef& a, const ConstVectorRef& b) const;

  /// Point `index` >= 1 of a fixed quasi-random sequence in the box, where a joint without bounds has one full turn,
  /// or twice the unit of length or the reach to both sides (Richtmyer's sequence: multiples of the square roots of
  /// the primes).
  VectorX restart(int index) const;

 private:
  JointVector lower_;
  JointVector upper_;
  JointVector unit_;
  JointVector half_span_;  ///< Of restarts where there is no bound.
  std::array<bool, kMaxJoints> periodic_{};
  std::array<bool, kMaxJoints> free_{};
};

}  // namespace screwline

#endif  // SCREWLINE_IK_NUMERICAL_JOINT_BOX_H
