#ifndef SCREWLINE_SRC_IK_REDUNDANT_SMALL_LOOP_H
#define SCREWLINE_SRC_IK_REDUNDANT_SMALL_LOOP_H

#include "pose_curve.h"

namespace screwline {

/// The curve through a node where it is an ellipse to second order: a loop about a configuration of which it is almost
/// the only one that solves the pose. It may be a thousand times as long as wide, and its bends shorter than any step
/// that rounding allows. False where it is none, or as large as third-order terms matter.
bool traceSmallLoop(PoseCurve& pose, const SelfMotionNode& start, SelfMotionCurve& curve);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_REDUNDANT_SMALL_LOOP_H
