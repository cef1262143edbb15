#ifndef SCREWLINE_SRC_IK_REDUNDANT_LOCAL_CONIC_H
#define SCREWLINE_SRC_IK_REDUNDANT_LOCAL_CONIC_H

#include <optional>
#include <vector>

#include "pose_curve.h"

namespace screwline {

/// Beside a singular configuration the curves that solve a pose are conics to second order. Where their bends are
/// shorter than the steps that rounding allows, the conic tells how they run.

/// The curve through a node where it is an ellipse: a loop about a configuration of which it is almost the only one
/// that solves the pose. It may be a thousand times as long as wide. False where it is none, or as large as third-order
/// terms matter.
bool traceSmallLoop(PoseCurve& pose, const SelfMotionNode& start, SelfMotionCurve& curve);

/// The way past a place where two curves cross, or come near to each other and turn off.
struct Passage {
  std::vector<SelfMotionNode> nodes;  ///< Behind the start, tangents the way of the walk; arc goes on from the start's.
  std::optional<Vector7> crossing;    ///< Where they cross, as far as rounding tells.
};

/// From a node whose tangent leads towards such a place, as far behind it as the node is before it. Empty where the
/// curve is no hyperbola, or third-order terms matter.
std::optional<Passage> passCrossing(PoseCurve& pose, const SelfMotionNode& at);

/// Where other curves come near to this one: centres of its hyperbolas, where its gain is least.
std::vector<Vector7> nearCrossings(PoseCurve& pose, const SelfMotionCurve& curve);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_REDUNDANT_LOCAL_CONIC_H
