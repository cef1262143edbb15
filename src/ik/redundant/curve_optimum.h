#ifndef SCREWLINE_SRC_IK_REDUNDANT_CURVE_OPTIMUM_H
#define SCREWLINE_SRC_IK_REDUNDANT_CURVE_OPTIMUM_H

#include <functional>

#include "pose_curve.h"

namespace screwline {

/// q in the turns within limits nearest to the seed (limits ignored: nearest to it).
Vector7 turnedTo(const SerialChain& chain, const Vector7& q, const Vector7& seed, bool ignore_limits);

/// The node of an interval whose turned configuration is nearest to the seed: of all segments that can hold it, the
/// root of the distance's derivative.
SelfMotionNode nearestNode(PoseCurve& pose, const SelfMotionCurve& curve, const SelfMotionInterval& interval,
                           const Vector7& seed, const Vector7& counts, bool ignore_limits);

/// The node of an interval where `value` is largest: golden section around the best of nodes and half-way points.
SelfMotionNode largestNode(PoseCurve& pose, const SelfMotionCurve& curve, const SelfMotionInterval& interval,
                           const std::function<double(const Vector7&)>& value);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_REDUNDANT_CURVE_OPTIMUM_H
