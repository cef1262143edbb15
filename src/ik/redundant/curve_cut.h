#ifndef SCREWLINE_SRC_IK_REDUNDANT_CURVE_CUT_H
#define SCREWLINE_SRC_IK_REDUNDANT_CURVE_CUT_H

#include "pose_curve.h"

namespace screwline {

/// Inserts nodes where a joint passes a limit (modulo full turns), to 1e-12, and fills `intervals`. A revolute joint
/// whose limits leave more than a full turn cuts nothing. @pre splitAtExtrema() was done.
void cutByLimits(PoseCurve& pose, SelfMotionCurve& curve);

/// One interval: the whole curve.
void keepWhole(SelfMotionCurve& curve);

/// Fills folds and arcs (without names) for the parameter joint; -1: one arc.
void splitAtFolds(SelfMotionCurve& curve, int parameter);

/// Whether a joint value is within limits, revolute joints modulo full turns.
bool isWithin(const Joint& joint, double value, double band);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_REDUNDANT_CURVE_CUT_H
