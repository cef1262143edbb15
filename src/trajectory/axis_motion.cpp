#include "screwline/trajectory/axis_motion.h"

#include <algorithm>
#include <cmath>

namespace screwline {
namespace {

constexpr double kRounding = 1e-12;
constexpr double kResolution = 1e-15;  ///< Of a given position.
constexpr std::size_t kCruise = 3;     ///< Of an arc's phases.

struct Weighted {
  const ExtremeMotion::Arc* arc;
  std::array<double, 7> jerks;
};

/// Both arcs' phases, cut at the breakpoints of either, with the weighted sum of their jerks. What rounding
/// leaves of the longer one at the end is dropped.
void appendCombined(const Weighted& up, double weight, const Weighted& down, JerkPhases& phases) {
  std::size_t i = 0;
  std::size_t k = 0;
  double left_up = up.arc->length[0];
  double left_down = down.arc->length[0];
  for (;;) {
    while (left_up <= 0.0 && i + 1 < 7) left_up += up.arc->length[++i];
    while (left_down <= 0.0 && k + 1 < 7) left_down += down.arc->length[++k];
    const double step = std::min(left_up, left_down);
    if (step <= 0.0) break;
    phases.append(step, weight * up.jerks[i] + (1.0 - weight) * down.jerks[k], i == kCruise && k == kCruise);
    left_up -= step;
    left_down -= step;
  }
}

void appendScaled(const Weighted& arc, double weight, JerkPhases& phases) {
  for (std::size_t i = 0; i < 7; ++i) phases.append(arc.arc->length[i], weight * arc.jerks[i], i == kCruise);
}

}  // namespace

AxisMotion::AxisMotion(const EndState& first, const EndState& last, const AxisLimits& limits)
    : displacement_(last.position - first.position),
      grain_(kResolution * (std::abs(first.position) + std::abs(last.position))),
      speed_(std::max(std::abs(first.velocity), std::abs(last.velocity))),
      settling_((std::abs(first.acceleration) + std::abs(last.acceleration)) *
                (1.0 / limits.jerk.upper - 1.0 / limits.jerk.lower)),
      rests_(speed_ == 0.0 && first.acceleration == 0.0 && last.acceleration == 0.0),
      up_(first, last, limits),
      down_(ExtremeMotion::downward(first, last, limits)) {}

double AxisMotion::nextDuration(double T) const {
  T = std::max(T, up_.least());
  const ExtremeMotion::Window above = up_.window();
  const ExtremeMotion::Window below = down_.window();
  for (int i = 0; i < 4; ++i) {
    for (const auto& window : {above, below, above}) {
      if (T > window.last) T = std::max(T, window.next);
    }
    double end = std::numeric_limits<double>::infinity();
    double after = end;
    for (const auto& window : {above, below}) {
      if (T > window.last || window.last >= end) continue;
      end = window.last;
      after = window.next;
    }
    const double tolerance = grain_ + kRounding * (std::abs(displacement_) + speed_ * (T + settling_));
    const ExtremeMotion::Arc highest = up_.at(T);
    const ExtremeMotion::Arc lowest = down_.at(T);
    double reached = T;
    if (highest.displacement < displacement_ - tolerance) {
      reached = up_.reach(displacement_, T, highest, end);
    } else if (lowest.displacement < -displacement_ - tolerance) {
      reached = down_.reach(-displacement_, T, lowest, end);
    }
    if (std::isfinite(reached)) return reached;
    T = after;
  }
  return T;
}

void AxisMotion::appendPhases(double T, JerkPhases& phases) const {
  const ExtremeMotion::Arc highest = up_.at(T);
  const ExtremeMotion::Arc lowest = down_.at(T);
  const Weighted up{&highest, up_.jerks()};
  std::array<double, 7> jerks = down_.jerks();
  for (double& jerk : jerks) jerk = -jerk;
  const Weighted down{&lowest, jerks};
  if (rests_) {
    // Rest is a motion too: between it and an extreme one the joint never turns back.
    const Weighted& extreme = displacement_ >= 0.0 ? up : down;
    const double reach = extreme.arc->displacement;
    appendScaled(extreme, reach > 0.0 ? std::min(1.0, std::abs(displacement_) / reach) : 0.0, phases);
    return;
  }
  const double range = highest.displacement + lowest.displacement;
  const double scale = std::abs(displacement_) + speed_ * T;
  const double share = range > 1e-15 * scale ? (displacement_ + lowest.displacement) / range : 1.0;
  constexpr double kWhole = 1e-14;
  if (share > 1.0 - kWhole) return appendScaled(up, 1.0, phases);
  if (share < kWhole) return appendScaled(down, 1.0, phases);
  appendCombined(up, share, down, phases);
}

}  // namespace screwline
