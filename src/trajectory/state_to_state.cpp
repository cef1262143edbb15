#include "screwline/trajectory/state_to_state.h"

#include <algorithm>
#include <cmath>

#include "position_bounds.h"

namespace screwline {
namespace {

bool refuse(StateToStateMotion& motion, MotionStatus status, int joint, const StateCheck& check) {
  motion.status = status;
  motion.joint = joint;
  motion.check = check;
  return false;
}

bool checkJoint(const StateToState& question, int joint, StateToStateMotion& motion) {
  const std::size_t j = static_cast<std::size_t>(joint);
  const AxisLimits& limits = question.limits[j];
  const StateCheck goal = checkState(question.to[j], limits, false);
  if (goal.fault == StateFault::kLimits) return refuse(motion, MotionStatus::kLimits, joint, goal);
  if (goal.fault != StateFault::kNone) return refuse(motion, MotionStatus::kGoal, joint, goal);
  const double position = question.to[j].position;
  if (position < limits.position.lower || position > limits.position.upper) {
    return refuse(motion, MotionStatus::kGoal, joint, {StateFault::kPosition, position, limits.position});
  }
  const StateCheck start = checkState(question.from[j], limits, true);
  if (start.fault == StateFault::kNotFinite) return refuse(motion, MotionStatus::kStart, joint, start);
  return true;
}

bool check(const StateToState& question, StateToStateMotion& motion) {
  if (question.joints < 1 || question.joints > kMaxJoints) {
    return refuse(motion, MotionStatus::kJoints, 0, {StateFault::kNotFinite, double(question.joints), {1, kMaxJoints}});
  }
  if (!(question.least_duration >= 0.0 && std::isfinite(question.least_duration))) {
    return refuse(motion, MotionStatus::kDuration, 0, {StateFault::kNotFinite, question.least_duration, {0.0, 1e6}});
  }
  for (int joint = 0; joint < question.joints; ++joint) {
    if (!checkJoint(question, joint, motion)) return false;
  }
  return true;
}

void layPhases(StateToStateMotion& motion, std::size_t j, double T) {
  JerkPhases& phases = motion.phases[j];
  phases.count = motion.braking_phases[j];  // Whatever was laid after them goes.
  motion.axes[j].appendPhases(T - motion.braking[j], phases);
}

bool within(const Range& range, double factor, const Range& bound) {
  constexpr double kSlack = 1e-12;
  const double ends[] = {range.lower * factor, range.upper * factor};
  return std::min(ends[0], ends[1]) >= bound.lower - kSlack * std::abs(bound.lower) &&
         std::max(ends[0], ends[1]) <= bound.upper + kSlack * std::abs(bound.upper);
}

bool proportional(double value, double leader, double factor) {
  return std::abs(value - factor * leader) <= 1e-12 * std::abs(value);
}

/// Whether every joint can follow the leader's motion in proportion; then all do.
bool layStraight(const StateToState& question, std::size_t leader, StateToStateMotion& motion) {
  const auto& from = question.from;
  const auto& to = question.to;
  const double way = to[leader].position - from[leader].position;
  if (way == 0.0) return false;
  const JerkPhases& lead = motion.phases[leader];
  const AxisLimits extent = lead.extent();
  const std::size_t n = static_cast<std::size_t>(question.joints);
  for (std::size_t j = 0; j < n; ++j) {
    const double factor = (to[j].position - from[j].position) / way;
    const AxisLimits& limits = question.limits[j];
    if (!proportional(from[j].velocity, from[leader].velocity, factor) ||
        !proportional(to[j].velocity, to[leader].velocity, factor) ||
        !proportional(from[j].acceleration, from[leader].acceleration, factor) ||
        !proportional(to[j].acceleration, to[leader].acceleration, factor) ||
        !within(extent.velocity, factor, limits.velocity) || !within(extent.jerk, factor, limits.jerk) ||
        !within(extent.acceleration, factor, limits.acceleration)) {
      return false;
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    if (j == leader) continue;
    const double factor = (to[j].position - from[j].position) / way;
    motion.phases[j].start = from[j];
    motion.phases[j].count = lead.count;
    for (std::size_t k = 0; k < lead.count; ++k) {
      motion.phases[j].phases[k] = {lead.phases[k].length, lead.phases[k].jerk * factor, lead.phases[k].cruise};
    }
  }
  return true;
}

}  // namespace

double commonDuration(const StateToStateMotion& motion, double T) {
  // Each joint moves it up to its own next feasible duration until none does: the least common one.
  const int n = motion.joints;
  int agreed = 0;
  for (int j = 0; agreed < n; j = (j + 1) % n) {
    const std::size_t i = static_cast<std::size_t>(j);
    const double next =
        T == motion.shortest[i] ? T : motion.braking[i] + motion.axes[i].nextDuration(T - motion.braking[i]);
    agreed = next > T ? 1 : agreed + 1;
    T = std::max(T, next);
  }
  return T;
}

void moveStateToState(const StateToState& question, StateToStateMotion& motion) {
  motion.status = MotionStatus::kFound;
  motion.straight = false;
  motion.joints = question.joints;
  if (!check(question, motion)) return;
  const std::size_t n = static_cast<std::size_t>(question.joints);
  std::size_t leader = 0;
  double T = question.least_duration;
  bool brakes = false;
  for (std::size_t j = 0; j < n; ++j) {
    motion.phases[j].start = question.from[j];
    motion.phases[j].count = 0;
    const EndState from = brakePhases(question.from[j], question.limits[j], motion.phases[j]);
    motion.goal_rests[j] = question.to[j].velocity == 0.0 && question.to[j].acceleration == 0.0;
    motion.braking[j] = motion.phases[j].duration();
    motion.braking_phases[j] = motion.phases[j].count;
    brakes = brakes || motion.phases[j].count > 0;
    motion.axes[j] = AxisMotion(from, question.to[j], question.limits[j]);
    motion.shortest[j] = motion.braking[j] + motion.axes[j].nextDuration(0.0);
    if (motion.shortest[j] > motion.shortest[leader]) leader = j;
    T = std::max(T, motion.shortest[j]);
  }
  motion.duration = commonDuration(motion, T);
  if (question.straight && !brakes) {
    layPhases(motion, leader, motion.duration);
    motion.straight = layStraight(question, leader, motion);
  }
  for (std::size_t j = 0; j < n && !motion.straight; ++j) layPhases(motion, j, motion.duration);
  keepPositions(question, motion);
}

}  // namespace screwline
