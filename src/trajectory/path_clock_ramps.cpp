#include <algorithm>
#include <cmath>
#include <limits>

#include "clock_ramps.h"
#include "screwline/trajectory/axis_motion.h"
#include "screwline/trajectory/enclosure.h"

namespace screwline {
namespace {

constexpr double kMostChange = 50.0;  ///< [1/s] The clock's own limits, where the path sets none:
constexpr double kMostBend = 2500.0;  ///< [1/s^2] from a standstill to full rate in 40 ms.
constexpr double kSameRate = 1e-9;    ///< Rates that differ by less are one.
constexpr double kFirstWait = 0.01;   ///< [s] Of path time, until a ramp is tried again;
constexpr double kWaitGrowth = 1.1;   ///< each time longer.
constexpr int kMostTries = 1000;

Range sum(const Range& a, const Range& b) {
  return {a.lower + b.lower, a.upper + b.upper};
}

Range product(const Range& a, const Range& b) {
  const double ends[] = {a.lower * b.lower, a.lower * b.upper, a.upper * b.lower, a.upper * b.upper};
  return {*std::min_element(ends, ends + 4), *std::max_element(ends, ends + 4)};
}

Range product(double factor, const Range& range) {
  return product(Range{factor, factor}, range);
}

/// The path with what it has to keep; derivatives by path time, held at its end.
class BoundedPath {
 public:
  BoundedPath(const Path& path, const Limits& bounds)
      : path_(path), bounds_(bounds), duration_(durationOf(path)), point_(bounds.joints()) {}

  double duration() const { return duration_; }
  int joints() const { return bounds_.joints(); }
  double most(int joint, int order) const { return bounds_.bound(joint, order) * (1.0 + kLimitTolerance); }

  Range over(int joint, int order, double from, double to) const {
    double begin = 0.0;
    bool found = false;
    Range range;
    for (const JointTrajectory* part : path_) {
      const double end = begin + part->duration();
      if (part->duration() > 0.0 && from < end && (to > begin || from == begin)) {
        const Range here =
            enclosure(*part, joint, order, std::max(from - begin, 0.0), std::min(to - begin, end - begin));
        range = found ? hull(range, here) : here;
        found = true;
      }
      begin = end;
    }
    return found && to > duration_ ? hull(range, {0.0, 0.0}) : range;
  }

  const TrajectoryPoint& at(double time) const {
    std::size_t k = 0;
    for (; k + 1 < path_.size() && time >= path_[k]->duration(); ++k) time -= path_[k]->duration();
    path_[k]->sample(time, point_);
    return point_;
  }

 private:
  const Path& path_;
  const Limits& bounds_;
  double duration_;
  mutable TrajectoryPoint point_;
};

/// What the clock does over a stretch of one phase.
struct ClockRange {
  Range time, rate, change;
  double bend = 0.0;
};

ClockRange clockOver(const EndState& state, const JerkPhase& phase, double from, double to) {
  const EndState first = advanced(state, phase, from);
  const EndState last = advanced(state, phase, to);
  ClockRange clock{{first.position, last.position},
                   hull({first.velocity, first.velocity}, {last.velocity, last.velocity}),
                   hull({first.acceleration, first.acceleration}, {last.acceleration, last.acceleration}),
                   phase.jerk};
  const double level = phase.jerk != 0.0 ? -state.acceleration / phase.jerk : -1.0;
  if (level > from && level < to) {
    const double extreme = advanced(state, phase, level).velocity;
    clock.rate = hull(clock.rate, {extreme, extreme});
  }
  return clock;
}

bool keepsJoint(const BoundedPath& path, int joint, const ClockRange& clock) {
  const Range velocity = path.over(joint, 1, clock.time.lower, clock.time.upper);
  const Range acceleration = path.over(joint, 2, clock.time.lower, clock.time.upper);
  const Range rate2{clock.rate.lower * clock.rate.lower, clock.rate.upper * clock.rate.upper};
  const Range reached = sum(product(acceleration, rate2), product(velocity, clock.change));
  if (!(reached.peak() <= path.most(joint, 2))) return false;
  if (std::isinf(path.most(joint, 3))) return true;
  const Range rate3{rate2.lower * clock.rate.lower, rate2.upper * clock.rate.upper};
  const Range jerk = path.over(joint, 3, clock.time.lower, clock.time.upper);
  const Range turning = product(3.0, product(acceleration, product(clock.rate, clock.change)));
  const Range jerked = sum(product(jerk, rate3), sum(turning, product(clock.bend, velocity)));
  return jerked.peak() <= path.most(joint, 3);
}

/// At one instant: what no finer stretch could mend.
bool keepsAt(const BoundedPath& path, const EndState& now, double bend) {
  if (now.position >= path.duration()) return true;
  TrajectoryPoint point = path.at(now.position);
  pace({now.position, now.velocity, now.acceleration, bend}, point);
  for (int j = 0; j < path.joints(); ++j) {
    if (!(std::abs(point.acceleration[j]) <= path.most(j, 2) && std::abs(point.jerk[j]) <= path.most(j, 3)))
      return false;
  }
  return true;
}

bool keepsOver(const BoundedPath& path, const EndState& state, const JerkPhase& phase, double from, double to,
               int depth) {
  ClockRange clock = clockOver(state, phase, from, to);
  if (clock.rate.lower < -kSameRate || clock.rate.upper > 1.0 + kSameRate) return false;
  clock.rate = {std::max(clock.rate.lower, 0.0), std::min(clock.rate.upper, 1.0)};
  if (clock.time.lower >= path.duration()) return true;
  bool keeps = true;
  for (int j = 0; j < path.joints() && keeps; ++j) keeps = keepsJoint(path, j, clock);
  if (keeps) return true;
  const double middle = 0.5 * (from + to);
  if (depth == 0 || !keepsAt(path, advanced(state, phase, middle), phase.jerk)) return false;
  return keepsOver(path, state, phase, from, middle, depth - 1) && keepsOver(path, state, phase, middle, to, depth - 1);
}

bool keeps(const BoundedPath& path, const JerkPhases& ramp) {
  constexpr int kParts = 4;
  constexpr int kDepth = 5;
  EndState state = ramp.start;
  for (std::size_t k = 0; k < ramp.count; ++k) {
    const JerkPhase& phase = ramp.phases[k];
    for (int i = 0; i < kParts; ++i) {
      if (!keepsOver(path, state, phase, phase.length * i / kParts, phase.length * (i + 1) / kParts, kDepth))
        return false;
    }
    state = advanced(state, phase, phase.length);
  }
  return true;
}

/// The change and bend of the rate at which some joint's bound is used up where the clock is, were the path straight.
AxisLimits scaleAt(const BoundedPath& path, double time) {
  const TrajectoryPoint& point = path.at(time);
  double change = kMostChange;
  double bend = kMostBend;
  for (int j = 0; j < path.joints(); ++j) {
    const double speed = std::abs(point.velocity[j]);
    if (speed * change > path.most(j, 2)) change = path.most(j, 2) / (1.0 + kLimitTolerance) / speed;
    if (speed * bend > path.most(j, 3)) bend = path.most(j, 3) / (1.0 + kLimitTolerance) / speed;
  }
  return AxisLimits::symmetric(AxisLimits::kNone, change, bend);
}

/// The quickest ramp to a rate that keeps the bounds, among some that are quicker and many that are slower than a
/// straight path would allow. From a standstill one is always found, however slow.
bool quickestRamp(const BoundedPath& path, const EndState& state, double rate, JerkPhases& ramp) {
  constexpr double kShares[] = {2.0, 1.4, 1.0};  // Then each 0.8 of the one before.
  const double least = state.velocity > 0.01 ? 0.02 : 1e-5;
  const AxisLimits scale = scaleAt(path, std::min(state.position, path.duration()));
  double share = kShares[0];
  for (std::size_t i = 0; share > least; ++i) {
    share = i < 3 ? kShares[i] : 0.8 * share;
    const double change =
        std::max(std::min(share * scale.acceleration.upper, kMostChange), std::abs(state.acceleration));
    const double bend = std::min(share * scale.jerk.upper, kMostBend);
    const AxisLimits limits = AxisLimits::symmetric(AxisLimits::kNone, change, bend);
    ramp.start = state;
    ramp.count = 0;
    appendChange(state, rate, limits, ramp);
    if (keeps(path, ramp)) return true;
  }
  return false;
}

/// The whole way to the rate if that can be, else some of it.
bool nextRamp(const BoundedPath& path, const EndState& state, double rate, JerkPhases& ramp) {
  for (double part : {1.0, 0.8, 0.5, 0.25, 0.1}) {
    if (quickestRamp(path, state, state.velocity + part * (rate - state.velocity), ramp)) return true;
  }
  return false;
}

}  // namespace

std::vector<JerkPhase> rampsTo(double rate, const EndState& from, const Path& path, const Limits& bounds) {
  const BoundedPath bounded(path, bounds);
  std::vector<JerkPhase> phases;
  EndState state = from;
  JerkPhases ramp;
  double wait = kFirstWait;
  for (int i = 0; i < kMostTries && state.position < bounded.duration(); ++i) {
    if (state.acceleration == 0.0 && std::abs(state.velocity - rate) <= kSameRate) return phases;
    if (nextRamp(bounded, state, rate, ramp)) {
      phases.insert(phases.end(), ramp.phases.begin(), ramp.phases.begin() + static_cast<long>(ramp.count));
      state = ramp.end();
      state.acceleration = 0.0;
      wait = kFirstWait;
      continue;
    }
    if (state.acceleration != 0.0) return {};
    phases.push_back({wait / std::max(state.velocity, 1e-3), 0.0, true});
    state = advanced(state, phases.back(), phases.back().length);
    wait *= kWaitGrowth;
  }
  return phases;
}

}  // namespace screwline
