#ifndef SCREWLINE_IK_REDUNDANT_SELF_MOTION_H
#define SCREWLINE_IK_REDUNDANT_SELF_MOTION_H

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "screwline/ik/redundant/redundant_solver.h"

namespace screwline {

/// A configuration on a self-motion. Arc length is the Euclidean norm in rad, prismatic joints divided by the chain's
/// characteristic length.
struct SelfMotionNode {
  Vector7 q;           ///< [rad or m] follows on from the nodes before: not wrapped.
  Vector7 tangent;     ///< dq / d arc, the way of the curve.
  double arc = 0.0;    ///< Arc length from the curve's first node (by chords' cubics, to 1e-3 of a step).
  double gain = 0.0;   ///< Least pivot of the Jacobian: near the smallest singular value; 0 where curves cross.
  double noise = 0.0;  ///< Of the tangent: what is below it may be rounding.
  /// [rad] Arm angle, where the curve is a closed form of it; else no number.
  double angle = std::numeric_limits<double>::quiet_NaN();
  double angle_rate = 0.0;  ///< d angle / d arc
};

/// Part of a curve along which the parameter joint moves one way: one branch over an interval of the parameter.
struct SelfMotionArc {
  int first = 0;  ///< Index of the first node; the arc ends at `last`.
  int last = 0;
  std::string branch;  ///< Empty where no closed form names it.
};

/// A stretch of a curve within joint limits. On a closed curve `last` may lie beyond its end: node indices go round.
struct SelfMotionInterval {
  int first = 0;
  int last = 0;        ///< Equal to first: the curve touches the limits' box in one point.
  bool whole = false;  ///< The whole curve is within limits.
};

/// One connected piece of the solution set: a curve through nodes between which every joint value is monotone.
struct SelfMotionCurve {
  std::vector<SelfMotionNode> nodes;  ///< A closed curve's last node is its first, some full turns on.
  bool closed = false;
  std::vector<Vector7> crossings;             ///< Points where solution curves cross [rad or m], to about 1e-4.
  std::vector<int> folds;                     ///< Nodes where the parameter joint turns back: two branches meet.
  std::vector<SelfMotionArc> arcs;            ///< Between folds; a closed curve's last arc may end beyond its end.
  std::vector<SelfMotionInterval> intervals;  ///< Within limits.
};

/// A piece of the solution set that the Jacobian does not see as a curve: at each value of the parameter (or at one
/// value alone, as with a straight arm) further joints are free.
struct SelfMotionSheet {
  Vector7 member;  ///< One configuration [rad or m].
  /// Joints whose values give the others': as many as dimensions, the parameter joint first where it moves. Empty: a
  /// point so near to a singularity that no curve can be followed.
  std::vector<int> free;
  bool parameter_moves = false;
  std::string branch;
  /// The member with wished values of `free`; false where it has none. Holds what it needs.
  std::function<bool(const VectorX& wished, VectorX& q)> member_at;
};

struct SelfMotionSet {
  std::vector<SelfMotionCurve> curves;
  std::vector<SelfMotionSheet> sheets;
  bool complete = false;  ///< No curve is missing, down to the stated resolution.
  std::string note;       ///< One line.
};

/// Node by index; on a closed curve indices beyond its end go on with full turns added.
SelfMotionNode nodeAt(const SelfMotionCurve& curve, int index);

}  // namespace screwline

#endif  // SCREWLINE_IK_REDUNDANT_SELF_MOTION_H
