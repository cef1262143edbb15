#ifndef SCREWLINE_SRC_IK_REDUNDANT_ARM_CURVES_H
#define SCREWLINE_SRC_IK_REDUNDANT_ARM_CURVES_H

#include "arm_circle.h"
#include "pose_curve.h"

namespace screwline {

/// All solutions of an S-R-S arm's pose: for each elbow and each way of the shoulder and of the wrist the circle of the
/// arm angle; where axes come into line on it, two ways change over and the circle of their counter-rotation crosses;
/// axes in line all along it, or of both groups at once, are sheets. Curves without folds, arcs and intervals.
/// @pre `arm` is regular and is the one that `pose` follows.
void addArmCurves(PoseCurve& pose, const std::shared_ptr<const ArmPose>& arm, SelfMotionSet& set);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_REDUNDANT_ARM_CURVES_H
