#ifndef SCREWLINE_SRC_IK_REDUNDANT_CURVE_TRACER_H
#define SCREWLINE_SRC_IK_REDUNDANT_CURVE_TRACER_H

#include "pose_curve.h"

namespace screwline {

constexpr std::size_t kMaxCurveNodes = 5000;

/// Follows the curve from a configuration on it, both ways where it does not close, by predictor and corrector along
/// the null space. Steps turn the tangent by 0.25 rad at most and never flip its orientation; where they would be
/// shorter than 1e-5 rad, the conic of second order tells whether curves cross or turn off. An open curve ends where a
/// prismatic joint leaves its limits or runs away, where it comes round to another place than its start, or at
/// kMaxCurveNodes. False where the start is no solution, or singular.
bool traceCurve(PoseCurve& pose, const Vector7& start, SelfMotionCurve& curve);

/// Inserts nodes so that every joint value is monotone between neighbours: at its extrema, to 1e-12 in the tangent.
/// A pair of extrema closer than kNodeResolution may be missed; what a joint value does between them is then less than
/// about 1e-9 rad.
void splitAtExtrema(PoseCurve& pose, SelfMotionCurve& curve);

/// [lengths] Of a slide, whatever its limits: a curve that goes so far is open.
constexpr double kFarthestSlide = 100.0;
constexpr double kNodeResolution = 1e-5;  ///< [rad] of arc length.

/// Node at share in (0, 1) between two nodes where f, of opposite signs at them, is zero.
template <typename Function>
bool nodeAtZero(PoseCurve& pose, const SelfMotionNode& a, const SelfMotionNode& b, Function&& f, SelfMotionNode& node) {
  double low = 0.0;
  double high = 1.0;
  double f_low = f(a);
  double f_high = f(b);
  int side = 0;
  for (int i = 0; i < 80; ++i) {
    // Regula falsi (Illinois), a bisection now and then.
    double share = i % 8 == 7 ? 0.5 * (low + high) : (low * f_high - high * f_low) / (f_high - f_low);
    if (!(share > low && share < high)) share = 0.5 * (low + high);
    if (share <= low || share >= high) return true;
    if (!pose.between(a, b, share, node)) return false;
    const double value = f(node);
    if (std::abs(value) <= 2e-15 || high - low <= 1e-15) return true;
    if ((value < 0.0) == (f_low < 0.0)) {
      low = share;
      f_low = value;
      if (side == -1) f_high *= 0.5;
      side = -1;
    } else {
      high = share;
      f_high = value;
      if (side == 1) f_low *= 0.5;
      side = 1;
    }
  }
  return true;
}

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_REDUNDANT_CURVE_TRACER_H
