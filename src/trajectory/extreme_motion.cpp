#include "screwline/trajectory/extreme_motion.h"

#include <algorithm>
#include <cmath>

namespace screwline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-12;    ///< A boundary case is taken as inside, whatever the last bits say.
constexpr double kResolution = 1e-14;  ///< Of a given number, a few steps of the last place.

EndState turned(const EndState& state) {
  return {-state.position, -state.velocity, -state.acceleration};
}

Range turned(const Range& range) {
  return {-range.upper, -range.lower};
}

double root(double radicand) {
  return std::sqrt(std::max(0.0, radicand));
}

}  // namespace

ExtremeMotion::ExtremeMotion(const EndState& first, const EndState& last, const AxisLimits& limits)
    : v0_(first.velocity),
      a0_(first.acceleration),
      v1_(last.velocity),
      a1_(last.acceleration),
      vmax_(limits.velocity.upper),
      amax_(limits.acceleration.upper),
      amin_(limits.acceleration.lower),
      ju_(limits.jerk.upper),
      jd_(-limits.jerk.lower) {
  iju_ = 1.0 / ju_;
  ijd_ = 1.0 / jd_;
  m_ = iju_ + ijd_;
  inverse_m_ = 1.0 / m_;
  sum_scale_ = (2.0 * (v1_ - v0_) + (a0_ - a1_) * (a0_ + a1_) * iju_) * inverse_m_;
  prepare();
}

ExtremeMotion ExtremeMotion::downward(const EndState& first, const EndState& last, const AxisLimits& limits) {
  const AxisLimits other{turned(limits.velocity), turned(limits.acceleration), turned(limits.jerk), {}};
  return ExtremeMotion(turned(first), turned(last), other);
}

/// From the start to the velocity limit in the shortest time, and from there to the end.
void ExtremeMotion::prepare() {
  cruise_from_ = kInfinity;
  if (!std::isfinite(vmax_)) return;
  const double peak_squared = (2.0 * (vmax_ - v0_) + a0_ * a0_ * iju_) * inverse_m_;
  const double trough_squared = (2.0 * (vmax_ - v1_) + a1_ * a1_ * iju_) * inverse_m_;
  double peak = root(peak_squared);
  double trough = -root(trough_squared);
  double top = 0.0;
  double bottom = 0.0;
  if (peak > amax_) {
    top = (peak_squared - amax_ * amax_) * m_ / (2.0 * amax_);
    peak = amax_;
  }
  if (trough < amin_) {
    bottom = (trough_squared - amin_ * amin_) * m_ / (-2.0 * amin_);
    trough = amin_;
  }
  peak = std::max(peak, a0_);
  trough = std::min(trough, a1_);
  fastest_.length = {(peak - a0_) * iju_, top, peak * ijd_, 0.0, -trough * ijd_, bottom, (a1_ - trough) * iju_};
  finish(fastest_);
  cruise_from_ = 0.0;
  for (double length : fastest_.length) cruise_from_ += length;
}

/// Displacement and slope of the arc without cruise. The slope is Pontryagin's Hamiltonian: v + a (length of the
/// falling phase) / 2 where that phase begins.
void ExtremeMotion::finish(Arc& arc) const {
  const auto& t = arc.length;
  EndState state = advanced({0.0, v0_, a0_}, ju_, t[0]);
  state = advanced(state, 0.0, t[1]);
  const double falling = t[2] + t[4];
  arc.slope = state.velocity + 0.5 * state.acceleration * falling;
  state = advanced(state, -jd_, falling);
  state = advanced(state, 0.0, t[5]);
  arc.displacement = advanced(state, ju_, t[6]).position;
}

double ExtremeMotion::least() const {
  return a1_ > a0_ ? (a1_ - a0_) * iju_ : (a0_ - a1_) * ijd_;
}

ExtremeMotion::Window ExtremeMotion::window() const {
  // With jerk up, then down, the change of velocity is m (A^2 - R^2) / 2 more than asked for, A the peak between.
  const double squared = (2.0 * (v1_ - v0_) + a0_ * a0_ * iju_ + a1_ * a1_ * ijd_) * inverse_m_;
  const double least_peak = std::max(a0_, a1_);
  // Rounding of the velocities becomes its square root in R: it is weighed as a square.
  const double negligible =
      kRounding * (a0_ * a0_ + a1_ * a1_) + kResolution * (std::abs(v0_) + std::abs(v1_)) * inverse_m_;
  const bool inside = squared <= least_peak * least_peak + negligible;
  if (squared <= negligible || (least_peak >= 0.0 && inside)) return {};
  const double needed = std::sqrt(squared);
  const auto lengthWith = [&](double peak) { return peak * m_ - a0_ * iju_ - a1_ * ijd_; };
  Window window;
  window.next =
      needed <= amax_ ? lengthWith(needed) : lengthWith(amax_) + (squared - amax_ * amax_) * m_ / (2.0 * amax_);
  // Both accelerations point down: a short T leaves them little time to pull, a long one must come up through zero.
  window.last = inside ? std::max(least(), lengthWith(-needed)) + kRounding * least() : -1.0;
  return window;
}

ExtremeMotion::Arc ExtremeMotion::at(double T) const {
  if (T >= cruise_from_) {
    Arc arc = fastest_;
    arc.length[3] = T - cruise_from_;
    arc.displacement += vmax_ * arc.length[3];
    arc.slope = vmax_;
    return arc;
  }
  // Peak and trough without plateaus: their difference from T, their sum from the change of velocity.
  const double difference = std::max(0.0, (T + (a0_ - a1_) * iju_) * inverse_m_);
  const double sum = difference > 0.0 ? sum_scale_ / difference : 0.0;
  double peak = std::max(a0_, 0.5 * (sum + difference));
  double trough = peak - difference;
  if (trough > a1_) {
    trough = a1_;
    peak = a1_ + difference;
  }
  if (peak > amax_ || trough < amin_) return withPlateaus(T, peak, trough);
  return arcOf(peak, 0.0, trough, 0.0);
}

/// A plateau at one limit or at both; whichever motion keeps both limits is the one (it is unique).
ExtremeMotion::Arc ExtremeMotion::withPlateaus(double T, double peak, double trough) const {
  const double dv = v1_ - v0_;
  const auto square = [](double x) { return x * x; };
  if (peak > amax_) {
    peak = amax_;
    const double excess = 2.0 * (peak * T - dv) + (square(peak - a1_) - square(peak - a0_)) * iju_;
    trough = std::min(a1_, peak - root(excess * inverse_m_));
  }
  if (trough < amin_) {
    trough = amin_;
    const double excess = 2.0 * (dv - trough * T) + (square(a0_ - trough) - square(a1_ - trough)) * iju_;
    peak = std::min(amax_, std::max(a0_, trough + root(excess * inverse_m_)));
  }
  const double left = std::max(0.0, T - (peak - a0_) * iju_ - (peak - trough) * ijd_ - (a1_ - trough) * iju_);
  if (trough > amin_) return arcOf(peak, left, trough, 0.0);
  if (peak < amax_) return arcOf(peak, 0.0, trough, left);
  const double missing =
      peak * T - dv - 0.5 * (square(peak - a0_) - square(peak - a1_)) * iju_ - 0.5 * square(peak - trough) * m_;
  const double bottom = std::min(left, std::max(0.0, missing / (peak - trough)));
  return arcOf(peak, left - bottom, trough, bottom);
}

ExtremeMotion::Arc ExtremeMotion::arcOf(double peak, double top, double trough, double bottom) const {
  Arc arc;
  arc.length = {(peak - a0_) * iju_, top, (peak - trough) * ijd_, 0.0, 0.0, bottom, (a1_ - trough) * iju_};
  finish(arc);
  return arc;
}

double ExtremeMotion::bracketEnd(double from, double distance, Arc& arc) const {
  // No velocity limit: doubled until it is far enough. The displacement then grows at least with T.
  const double pause = (std::abs(v0_) + std::abs(v1_)) / std::min(amax_, -amin_);
  double step = from + least() + (std::isfinite(pause) ? pause : 0.0) + std::cbrt(std::abs(distance) * m_);
  for (int i = 0; i < 200; ++i, step *= 2.0) {
    arc = at(from + step);
    if (arc.displacement >= distance) break;
  }
  return from + step;
}

/// The displacement is concave in T up to here and convex from here to the first cruise: where the second derivative, a
/// closed form in the difference of peak and trough, changes its sign.
double ExtremeMotion::inflection() const {
  const double share = 1.0 + 2.0 * ju_ * ijd_;
  double difference = std::sqrt(std::abs(sum_scale_) / std::sqrt(share));
  if (difference <= 0.0) return 0.0;
  const double sum = sum_scale_ / difference;
  const double held = sum > 0.0 ? amax_ : amin_;
  if (0.5 * (sum + difference) <= amax_ && 0.5 * (sum - difference) >= amin_) {
    return difference * m_ + (a1_ - a0_) * iju_;
  }
  difference = std::abs(held) * (1.0 - 0.5 * ijd_ * inverse_m_);
  const double ends = (a0_ - a1_) * (a0_ + a1_ - 2.0 * held) * iju_;  // (a0 - held)^2 - (a1 - held)^2, over ju
  return (v1_ - v0_) / held + 0.5 * (difference * difference * m_ + (held > 0.0 ? ends : -ends)) / std::abs(held);
}

/// Where the displacement is greatest between a rising and a falling one. @pre concave between.
double ExtremeMotion::crest(double rising, double falling, Arc& arc) const {
  for (int i = 0; i < 60 && falling - rising > 1e-15 * falling; ++i) {
    const double middle = 0.5 * (rising + falling);
    arc = at(middle);
    (arc.slope > 0.0 ? rising : falling) = middle;
  }
  arc = at(rising);
  return rising;
}

double ExtremeMotion::reach(double distance, double from, Arc at_from, double end) const {
  if (from >= cruise_from_) return from + (distance - at_from.displacement) / vmax_;
  double high = std::min(cruise_from_, end);
  const double bend = std::min(inflection(), high);
  if (from < bend) {
    double peak = bend;
    Arc at_peak = at(bend);
    const Arc at_bend = at_peak;
    if (at_from.slope > 0.0 && at_bend.slope < 0.0) peak = crest(from, bend, at_peak);
    if (at_peak.displacement >= distance) return solve(distance, from, at_from, peak, at_peak);
    from = bend;
    at_from = at_bend;
  }
  Arc at_high;
  if (std::isfinite(high)) {
    at_high = high == cruise_from_ ? fastest_ : at(high);
  } else {
    high = bracketEnd(from, distance, at_high);
  }
  if (at_high.displacement < distance) {
    return high == end ? kInfinity : cruise_from_ + (distance - fastest_.displacement) / vmax_;
  }
  return solve(distance, from, at_from, high, at_high);
}

double ExtremeMotion::solve(double distance, double low, Arc at_low, double high, Arc at_high) const {
  const double scale = std::abs(distance) + std::max(std::abs(v0_), std::abs(v1_)) * high;
  for (int i = 0; i < 80; ++i) {
    const double below = at_low.displacement - distance;   // < 0
    const double above = at_high.displacement - distance;  // >= 0
    if (above <= 2e-16 * scale || high - low <= 4e-16 * high) return high;
    // Where the curve does not bend the other way, the root lies between the chord and the tangent.
    const double tangent = at_high.slope > 0.0 ? high - above / at_high.slope : low;
    const double chord = low - below * (high - low) / (above - below);
    double next = tangent;
    if (at_low.slope > 0.0 && at_high.slope > 0.0) {
      // T as a cubic of the displacement, with values and slopes at both ends.
      const double width = above - below;
      const double w = -below / width;
      const double s0 = width / at_low.slope;
      const double s1 = width / at_high.slope;
      const double span = high - low;
      next = low + w * (s0 + w * ((3.0 * span - 2.0 * s0 - s1) + w * (s0 + s1 - 2.0 * span)));
    }
    if (!(next >= std::min(chord, tangent) && next <= std::max(chord, tangent))) next = tangent;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (!(next > low && next < high)) return high;
    const Arc arc = at(next);
    if (std::abs(arc.displacement - distance) <= 2e-16 * scale) return next;
    if (arc.displacement < distance) {
      low = next;
      at_low = arc;
    } else {
      high = next;
      at_high = arc;
    }
  }
  return high;
}

}  // namespace screwline
