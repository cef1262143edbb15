#include <algorithm>
#include <cmath>
#include <utility>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/profile.h"
#include "screwline/trajectory/trapezoid.h"

namespace screwline {
namespace {

VectorX displacement(const ProfileContext& context) {
  return context.waypoints().back().position - context.waypoints().front().position;
}

/// Smallest limit / |displacement|: the bound on the derivative of s by time; infinite where nothing bounds it.
double scalarBound(const VectorX& bounds, const VectorX& delta) {
  double bound = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < delta.size(); ++i) {
    if (delta[i] != 0.0) bound = std::min(bound, bounds[i] / std::abs(delta[i]));
  }
  return bound;
}

}  // namespace

void refuseDuration(const ProfileContext& context, const LimitUse& use, double shortest) {
  throw InputError(AnswerCode::kLimitsInfeasible, "profile '" + context.request.profile + "' in " +
                                                      number(context.duration) + " s: " + describe(use) +
                                                      "; the shortest feasible duration is " + number(shortest) + " s");
}

ProfileDraft scaleBetweenEnds(const ProfileContext& context, const TimeLaw& scaling) {
  const VectorX& start = context.waypoints().front().position;
  const VectorX delta = displacement(context);
  // In unit time the stretch to the limits is the shortest duration itself: peaks scale with 1/T, 1/T^2, 1/T^3.
  const double shortest = tightestUse(JointTrajectory::scaled(start, delta, scaling, 1.0), context.limits).stretch;
  if (context.duration == 0.0 && shortest == 0.0 && !delta.isZero(0.0)) {
    throw InputError(AnswerCode::kInvalidGoal, "duration is 0 and no finite limit bounds profile '" +
                                                   context.request.profile + "': give a duration or a limit");
  }
  const double duration = context.duration > 0.0 ? context.duration : noLessThanShortest(shortest);
  ProfileDraft draft;
  draft.trajectory = JointTrajectory::scaled(start, delta, scaling, duration);
  const LimitUse use = tightestUse(draft.trajectory, context.limits);
  if (use.value > use.bound * (1.0 + kLimitTolerance)) refuseDuration(context, use, shortest);
  draft.waypoint_times = {0.0, duration};
  return draft;
}

BlendedMove shortestTrapezoid(const VectorX& delta, const Limits& limits) {
  const double v = scalarBound(limits.velocity, delta);
  const double a = scalarBound(limits.acceleration, delta);
  if (delta.isZero(0.0)) return {1.0 / 3.0, 0.0};
  if (std::isinf(a)) return {1.0 / 3.0, std::isinf(v) ? 1.0 : noLessThanShortest(1.5 / v)};
  if (v * v >= a) return {0.5, noLessThanShortest(2.0 / std::sqrt(a))};
  constexpr double kShortestRamp = 1e-6;  // Of the duration: shorter ones are lost in the rounding of their instants.
  const double ramp = std::max(v / a, kShortestRamp / v);
  const double duration = 1.0 / v + ramp;
  return {ramp / duration, noLessThanShortest(duration)};
}

double blendWithin(const VectorX& delta, const Limits& limits, double duration) {
  if (delta.isZero(0.0)) return 1.0 / 3.0;
  const double v = scalarBound(limits.velocity, delta) * duration;
  const double a = scalarBound(limits.acceleration, delta) * duration * duration;
  const double most = std::min(0.5, 1.0 - 1.0 / v);
  // Least root of b (1 - b) = 1/a, written without cancellation.
  const double least = 2.0 / a / (1.0 + std::sqrt(std::max(0.0, 1.0 - 4.0 / a)));
  return std::min(0.5, std::max(least, std::min(1.0 / 3.0, most)));
}

ProfileDraft buildRectangular(const ProfileContext& context) {
  return scaleBetweenEnds(context, TimeLaw::rectangular());
}
ProfileDraft buildCubic(const ProfileContext& context) {
  return scaleBetweenEnds(context, TimeLaw::cubic());
}
ProfileDraft buildPolynomial345(const ProfileContext& context) {
  return scaleBetweenEnds(context, TimeLaw::polynomial345());
}
ProfileDraft buildPolynomial4567(const ProfileContext& context) {
  return scaleBetweenEnds(context, TimeLaw::polynomial4567());
}
ProfileDraft buildCycloidal(const ProfileContext& context) {
  return scaleBetweenEnds(context, TimeLaw::cycloidal());
}

ProfileDraft buildTrapezoidal(const ProfileContext& context) {
  const VectorX delta = displacement(context);
  const BlendedMove shortest = shortestTrapezoid(delta, context.limits);
  BlendedMove move = shortest;
  TrapezoidSpec spec{context.parameter("peak_velocity"),
                     context.parameter("acceleration"),
                     {},
                     context.parameter("acceleration_time")};
  if (spec.peak_velocity || spec.acceleration || spec.acceleration_time) {
    if (context.duration > 0.0) spec.duration = context.duration;
    const Trapezoid trapezoid = resolveTrapezoid(delta.cwiseAbs().maxCoeff(), spec);
    move = {std::min(0.5, trapezoid.blendFraction()), trapezoid.duration};
  } else if (context.duration > 0.0) {
    const bool feasible = context.duration >= shortest.duration * (1.0 - kLimitTolerance);
    move = {feasible ? blendWithin(delta, context.limits, context.duration) : shortest.blend_fraction,
            context.duration};
  }
  ProfileDraft draft;
  const TimeLaw scaling = TimeLaw::trapezoidal(move.blend_fraction);
  draft.trajectory = JointTrajectory::scaled(context.waypoints().front().position, delta, scaling, move.duration);
  const LimitUse use = tightestUse(draft.trajectory, context.limits);
  if (use.value > use.bound * (1.0 + kLimitTolerance)) {
    ProfileContext resolved = context;
    resolved.duration = move.duration;
    refuseDuration(resolved, use, shortest.duration);
  }
  draft.waypoint_times = {0.0, move.duration};
  return draft;
}

ProfileDraft buildSinusoidal(const ProfileContext& context) {
  if (context.duration == 0.0) {
    throw InputError(AnswerCode::kInvalidGoal,
                     "duration is 0: a sinusoidal motion has no end of its own, give a duration");
  }
  const int n = context.joints();
  Sinusoid motion{VectorX::Zero(n), VectorX::Zero(n), VectorX::Zero(n), VectorX::Zero(n)};
  for (int i = 0; i < n; ++i) {
    const std::string suffix = "_" + std::to_string(i);
    const auto offset = context.parameter("offset" + suffix);
    if (offset && !context.waypoints().empty()) {
      throw InputError(AnswerCode::kInvalidGoal,
                       "offset" + suffix + " is given and so is a waypoint: the offsets come from one of them");
    }
    motion.offset[i] = offset ? *offset : context.waypoints().empty() ? 0.0 : context.waypoints().front().position[i];
    motion.amplitude[i] = context.parameter("amplitude" + suffix, 0.0);
    motion.omega[i] = context.parameter("omega" + suffix, 0.0);
    motion.phase[i] = context.parameter("phase" + suffix, 0.0);
  }
  ProfileDraft draft;
  draft.trajectory = JointTrajectory::sinusoidal(motion, context.duration);
  const LimitUse use = tightestUse(draft.trajectory, context.limits);
  if (use.value > use.bound * (1.0 + kLimitTolerance)) {
    throw InputError(AnswerCode::kLimitsInfeasible,
                     "profile 'sinusoidal': " + describe(use) + "; lower its omega or amplitude");
  }
  draft.waypoint_times.assign(context.waypoints().size(), 0.0);
  const VectorX first_velocity =
      motion.amplitude.cwiseProduct(motion.omega).cwiseProduct(motion.phase.array().cos().matrix());
  if (first_velocity.cwiseAbs().maxCoeff() > 0.0) {
    draft.notes.push_back("the motion starts with velocity " + number(first_velocity.cwiseAbs().maxCoeff()) +
                          ": it is the state of a running sinusoid, not a start from rest");
  }
  return draft;
}

}  // namespace screwline
