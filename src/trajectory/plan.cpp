#include "screwline/trajectory/plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/profile.h"
#include "screwline/trajectory/verify.h"
#include "time_ranges.h"

namespace screwline {
namespace {

constexpr double kDefaultPeriod = 0.01;
constexpr double kMostSamples = 1e6;

/// @param why what makes it so long; asked only where it is too long.
void requireSampleCount(double duration, double period, const std::function<std::string()>& why = {}) {
  if (duration / period <= kMostSamples) return;
  throw InputError(AnswerCode::kTooLarge, "a duration of " + number(duration) + " s at sample_period " +
                                              number(period) + " s makes more than 1000000 samples" +
                                              (why ? why() : std::string()));
}

/// The limit that asks for a motion's length, where one does.
std::string tightestLimit(const JointTrajectory& trajectory, const Limits& limits) {
  const LimitUse use = tightestUse(trajectory, limits);
  return use.stretch > 0.999 ? "; the tightest limit: " + describe(use) : "";
}

/// An overshoot past a joint's range is the request's, not ours: no duration mends it, other waypoints do.
void requirePositionBounds(const JointTrajectory& trajectory, const Limits& limits, const std::string& profile) {
  if (limits.lower.size() == 0) return;
  for (int j = 0; j < trajectory.joints(); ++j) {
    const Range range = trajectory.extrema(j).position;
    const bool low = range.lower < limits.lower[j] - kLimitTolerance;
    if (!low && range.upper <= limits.upper[j] + kLimitTolerance) continue;
    throw InputError(AnswerCode::kLimitsInfeasible, "profile '" + profile + "': joint " + std::to_string(j) +
                                                        " would reach position " +
                                                        number(low ? range.lower : range.upper) + ", its limits are " +
                                                        number(limits.lower[j]) + " to " + number(limits.upper[j]));
  }
}

void noteInfiniteOrders(const JointTrajectory& trajectory, const std::string& profile,
                        std::vector<std::string>& notes) {
  double velocity_step = 0.0;
  double acceleration_step = 0.0;
  for (int j = 0; j < trajectory.joints(); ++j) {
    const JointExtrema extrema = trajectory.extrema(j);
    if (std::isinf(extrema.peak(2))) velocity_step = std::max(velocity_step, extrema.velocity_step);
    if (std::isinf(extrema.peak(3))) acceleration_step = std::max(acceleration_step, extrema.acceleration_step);
  }
  if (velocity_step > 0.0) {
    notes.push_back("profile '" + profile + "' steps in velocity (by up to " + number(velocity_step) +
                    "): acceleration and jerk are infinite there and their limits are not held");
  } else if (acceleration_step > 0.0) {
    notes.push_back("profile '" + profile + "' steps in acceleration (by up to " + number(acceleration_step) +
                    "): jerk is infinite there and its limits are not held");
  }
}

/// What a controller that follows the motion asks first: how smooth it is and how near it comes to what was given.
void noteContinuity(const JointTrajectory& trajectory, const MatrixX& via_errors, std::vector<std::string>& notes) {
  if (via_errors.rows() == 0) return;
  notes.push_back("continuity class C" + std::to_string(trajectory.continuity()) +
                  "; largest joint deviation from an intermediate waypoint " +
                  number(via_errors.cwiseAbs().maxCoeff()));
}

MatrixX viaErrors(const ProfileDraft& draft, const std::vector<VectorX>& waypoints) {
  const Eigen::Index vias = waypoints.size() > 2 ? static_cast<Eigen::Index>(waypoints.size()) - 2 : 0;
  MatrixX errors(vias, draft.trajectory.joints());
  TrajectoryPoint point(draft.trajectory.joints());
  for (Eigen::Index i = 0; i < vias; ++i) {
    const std::size_t waypoint = static_cast<std::size_t>(i) + 1;
    draft.trajectory.sample(draft.waypoint_times[waypoint], point);
    errors.row(i) = (point.position - waypoints[waypoint]).transpose();
  }
  return errors;
}

/// The ends, with the velocities and accelerations that are given there, and the vias where the profile meets them.
std::vector<Checkpoint> checkpointsOf(const ProfileContext& context, const ProfileDraft& draft) {
  std::vector<Checkpoint> checkpoints;
  const std::size_t count = draft.waypoints.size();
  const int continuity = draft.trajectory.continuity();
  for (std::size_t k = 0; count >= 2 && k < count; ++k) {
    const PathPoint& waypoint = context.waypoints()[k];
    const bool end = k == 0 || k + 1 == count;
    if (!end && !draft.meets_vias) continue;
    const double time = k == 0 ? 0.0 : end ? draft.trajectory.duration() : draft.waypoint_times[k];
    checkpoints.emplace_back(time, draft.waypoints[k]);
    // A zero given at an end where the derivative steps is that of the rest before or after it.
    if (draft.meets_vias && continuity >= 1) checkpoints.back().velocity = waypoint.velocity;
    if (draft.meets_vias && continuity >= 2) checkpoints.back().acceleration = waypoint.acceleration;
  }
  return checkpoints;
}

void verifyDraft(const ProfileContext& context, const ProfileDraft& draft) {
  const std::vector<Checkpoint> ends = checkpointsOf(context, draft);
  if (const auto broken = verifyTrajectory(draft.trajectory, context.limits, ends)) {
    throw Exception("internal error: profile '" + context.request.profile + "' failed its check: " + *broken);
  }
}

PlanResult planAsGiven(const PlanRequest& request, const Profile& profile) {
  const ProfileContext context = validateRequest(request, profile);
  const double period = request.sample_period > 0.0 ? request.sample_period : kDefaultPeriod;
  requireSampleCount(context.duration, period);

  ProfileDraft draft = profile.build(context);
  if (draft.waypoints.empty()) {
    for (const PathPoint& waypoint : request.waypoints) draft.waypoints.push_back(waypoint.position);
  }
  requireSampleCount(draft.trajectory.duration(), period,
                     [&] { return tightestLimit(draft.trajectory, context.limits); });
  requirePositionBounds(draft.trajectory, context.limits, request.profile);
  verifyDraft(context, draft);
  noteInfiniteOrders(draft.trajectory, request.profile, draft.notes);

  PlanResult result;
  result.sample_period = period;
  result.via_joint_errors = viaErrors(draft, draft.waypoints);
  noteContinuity(draft.trajectory, result.via_joint_errors, draft.notes);
  result.trajectory = std::move(draft.trajectory);
  result.waypoint_times = std::move(draft.waypoint_times);
  result.waypoints = std::move(draft.waypoints);
  result.notes = std::move(draft.notes);
  return result;
}

/// The result, or nothing where the limits allow none.
std::optional<PlanResult> planIfFeasible(const PlanRequest& request, const Profile& profile) {
  try {
    return planAsGiven(request, profile);
  } catch (const InputError& error) {
    if (error.code() != AnswerCode::kLimitsInfeasible) throw;
    return std::nullopt;
  }
}

bool isFeasible(const PlanRequest& request, const Profile& profile) {
  try {
    planAsGiven(request, profile);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

PlanRequest slowed(PlanRequest request, double factor) {
  request.duration *= factor;
  for (PathPoint& waypoint : request.waypoints) waypoint.time *= factor;
  return request;
}

/// All given times longer by one factor, the least found: upwards in steps of 5 %, then halved.
std::optional<PlanResult> planSlowed(const PlanRequest& request, const Profile& profile) {
  constexpr double kStep = 1.05;
  constexpr double kSlowest = 1e4;
  double upper = kStep;
  std::optional<PlanResult> best = planIfFeasible(slowed(request, upper), profile);
  while (!best && upper < kSlowest) best = planIfFeasible(slowed(request, upper *= kStep), profile);
  double lower = upper / kStep;
  while (best && upper - lower > 1e-9 * upper) {
    const double middle = 0.5 * (lower + upper);
    std::optional<PlanResult> result = planIfFeasible(slowed(request, middle), profile);
    (result ? upper : lower) = middle;
    if (result) best = std::move(result);
  }
  return best;
}

PlanResult planStretched(const PlanRequest& request, const Profile& profile, const InputError& why) {
  const double given = std::max(request.duration, request.waypoints.empty() ? 0.0 : request.waypoints.back().time);
  const bool via_times = std::any_of(request.waypoints.begin(), request.waypoints.end(), [&](const PathPoint& w) {
    return w.time > 0.0 && &w != &request.waypoints.back();
  });
  if (given == 0.0 && !via_times) throw why;
  std::optional<PlanResult> result;
  if (!via_times) {
    result = planIfFeasible(slowed(request, 0.0), profile);
    if (!result) throw why;
    if (result->trajectory.duration() < given) result.reset();  // Feasible are shorter and longer ones.
  }
  if (!result) result = planSlowed(request, profile);
  if (!result) throw why;
  result->notes.insert(result->notes.begin(),
                       "stretched to " + number(result->trajectory.duration()) + " s, as asked for: " + why.what());
  return std::move(*result);
}

PlanResult planOrStretch(const PlanRequest& request, const Profile& profile, bool stretch) {
  try {
    return planAsGiven(request, profile);
  } catch (const InputError& error) {
    if (error.code() != AnswerCode::kLimitsInfeasible) throw;
    if (stretch) return planStretched(request, profile, error);
    const auto feasible = [&](const PlanRequest& other) { return isFeasible(other, profile); };
    throw InputError(error.code(), error.what() + feasibleTimes(request, feasible));
  }
}

}  // namespace

PlanResult plan(const PlanRequest& request) {
  const Profile& profile = findProfile(request.profile);
  const ProfileContext context = validateRequest(request, profile);
  const bool stretch = context.flag(kStretchParameter, false);
  if (profile.cartesian || request.continuous.empty() || context.flag(kKeepTurnsParameter, false)) {
    return planOrStretch(request, profile, stretch);
  }
  std::vector<std::string> notes;
  const PlanRequest short_ways = onShortWays(request, notes);
  PlanResult result = planOrStretch(short_ways, profile, stretch);
  result.notes.insert(result.notes.begin(), notes.begin(), notes.end());
  return result;
}

}  // namespace screwline
