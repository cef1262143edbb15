#include <algorithm>
#include <cmath>

#include "cartesian_motion.h"
#include "screwline/exception.h"
#include "screwline/trajectory/double_s.h"
#include "screwline/trajectory/format.h"

namespace screwline {
namespace {

/// Limits on s = u / length by time that leave all joints within theirs, if not the widest ones: they only shape a law.
AxisLimits limitsOnS(const JointPath& path, const Limits& limits) {
  constexpr int kPlaces = 4;
  const int n = path.joints();
  const double length = path.length();
  double v = AxisLimits::kNone;
  double a = AxisLimits::kNone;
  double j = AxisLimits::kNone;
  VectorX q(n), first(n), second(n), third(n);
  for (std::size_t k = 0; k + 1 < path.breaks().size(); ++k) {
    for (int place = 0; place <= kPlaces; ++place) {
      const double u = path.breaks()[k] + (path.breaks()[k + 1] - path.breaks()[k]) * place / kPlaces;
      path.at(u, q.data(), first.data(), second.data(), third.data());
      for (int i = 0; i < n; ++i) {
        const double rate = std::abs(first[i]) * length;
        const double bend = std::abs(second[i]) * length * length;
        if (bend > 0.0) v = std::min(v, std::sqrt(0.5 * limits.acceleration[i] / bend));
        if (rate == 0.0) continue;
        v = std::min(v, limits.velocity[i] / rate);
        a = std::min(a, 0.5 * limits.acceleration[i] / rate);
        j = std::min(j, limits.jerk[i] / rate / 3.0);
      }
    }
  }
  return AxisLimits::symmetric(v, a, j);
}

TimeLaw trapezoidOf(const AxisLimits& limits) {
  const double v = limits.velocity.upper;
  const double a = limits.acceleration.upper;
  if (!std::isfinite(v) || !std::isfinite(a)) return TimeLaw::trapezoidal(1.0 / 3.0);
  const double ramp = v / a;
  return TimeLaw::trapezoidal(v * v >= a ? 0.5 : ramp / (1.0 / v + ramp));
}

TimeLaw lawOf(const ProfileContext& context, const JointPath& path) {
  const std::string& name = context.request.time_law;
  if (name == "rectangular") return TimeLaw::rectangular();
  if (name == "cubic") return TimeLaw::cubic();
  if (name == "polynomial_345") return TimeLaw::polynomial345();
  if (name == "polynomial_4567") return TimeLaw::polynomial4567();
  if (name == "cycloidal") return TimeLaw::cycloidal();
  if (name == "minimum_jerk") return TimeLaw::minimumJerk();
  if (name == "trapezoidal") return trapezoidOf(limitsOnS(path, context.limits));
  if (name == "double_s") {
    const AxisLimits limits = limitsOnS(path, context.limits);
    if (!std::isfinite(limits.jerk.upper))
      throw InputError(AnswerCode::kInvalidGoal, "time_law is 'double_s', it needs finite jerk_limits");
    return timeLawOf(shortestDoubleS(limits));
  }
  throw InputError(AnswerCode::kInvalidGoal,
                   "time_law is '" + name +
                       "', it must be empty or one of rectangular, cubic, trapezoidal, polynomial_345, "
                       "polynomial_4567, cycloidal, minimum_jerk, double_s");
}

}  // namespace

TimedPath timeByLaw(const ProfileContext& context, const ToolPath& path, const FollowedPath& followed) {
  constexpr double kTolerance = 1e-9;  // [rad, m]
  if (path.parts() > 1) {
    throw InputError(AnswerCode::kInvalidGoal, "time_law is '" + context.request.time_law + "', the path has " +
                                                   std::to_string(path.parts() - 1) +
                                                   " corners to stop at: give a blend_radius, or leave time_law empty");
  }
  if (context.parameter("tool_speed")) {
    throw InputError(AnswerCode::kInvalidGoal,
                     "parameter 'tool_speed' is not taken with a time_law: give a duration instead");
  }
  const JointPath joints = followed.byU(kTolerance);
  const TimeLaw law = lawOf(context, joints);
  // In unit time the stretch is the shortest duration itself, of the orders that the law has.
  const LimitUse unit = tightestUse(JointTrajectory::alongPath(joints, law, 1.0), context.limits);
  const double shortest = noLessThanShortest(unit.stretch);
  if (shortest == 0.0 && context.duration == 0.0) {
    throw InputError(AnswerCode::kInvalidGoal, "duration is 0 and no finite limit bounds time_law '" +
                                                   context.request.time_law + "': give a duration or a limit");
  }
  const double duration = context.duration > 0.0 ? context.duration : shortest;
  TimedPath result;
  result.trajectory = JointTrajectory::alongPath(joints, law, duration);
  const LimitUse use = tightestUse(result.trajectory, context.limits);
  if (use.value > use.bound * (1.0 + kLimitTolerance)) refuseDuration(context, use, shortest);
  for (const double u : path.waypoints()) {
    result.waypoint_times.push_back(duration * tauAt(law, u / path.length()));
  }
  result.waypoint_times.back() = duration;
  return result;
}

}  // namespace screwline
