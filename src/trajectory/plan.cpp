#include "screwline/trajectory/plan.h"

#include <cmath>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/profile.h"
#include "screwline/trajectory/verify.h"

namespace screwline {
namespace {

constexpr double kDefaultPeriod = 0.01;
constexpr double kMostSamples = 1e6;

void requireSampleCount(double duration, double period) {
  if (duration / period <= kMostSamples) return;
  throw InputError(AnswerCode::kTooLarge, "a duration of " + number(duration) + " s at sample_period " +
                                              number(period) + " s makes more than 1000000 samples");
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

MatrixX viaErrors(const ProfileDraft& draft, const std::vector<PathPoint>& waypoints) {
  const Eigen::Index vias = waypoints.size() > 2 ? static_cast<Eigen::Index>(waypoints.size()) - 2 : 0;
  MatrixX errors(vias, draft.trajectory.joints());
  TrajectoryPoint point(draft.trajectory.joints());
  for (Eigen::Index i = 0; i < vias; ++i) {
    const std::size_t waypoint = static_cast<std::size_t>(i) + 1;
    draft.trajectory.sample(draft.waypoint_times[waypoint], point);
    errors.row(i) = (point.position - waypoints[waypoint].position).transpose();
  }
  return errors;
}

void verifyDraft(const ProfileContext& context, const ProfileDraft& draft) {
  std::vector<Checkpoint> ends;
  if (context.waypoints().size() >= 2) {
    ends.push_back({0.0, context.waypoints().front().position});
    ends.push_back({draft.trajectory.duration(), context.waypoints().back().position});
  }
  if (const auto broken = verifyTrajectory(draft.trajectory, context.limits, ends)) {
    throw Exception("internal error: profile '" + context.request.profile + "' failed its check: " + *broken);
  }
}

}  // namespace

PlanResult plan(const PlanRequest& request) {
  const Profile& profile = findProfile(request.profile);
  const ProfileContext context = validateRequest(request, profile);
  const double period = request.sample_period > 0.0 ? request.sample_period : kDefaultPeriod;
  requireSampleCount(context.duration, period);

  ProfileDraft draft = profile.build(context);
  requireSampleCount(draft.trajectory.duration(), period);
  requirePositionBounds(draft.trajectory, context.limits, request.profile);
  verifyDraft(context, draft);
  noteInfiniteOrders(draft.trajectory, request.profile, draft.notes);

  PlanResult result;
  result.sample_period = period;
  result.via_joint_errors = viaErrors(draft, request.waypoints);
  noteContinuity(draft.trajectory, result.via_joint_errors, draft.notes);
  result.trajectory = std::move(draft.trajectory);
  result.waypoint_times = std::move(draft.waypoint_times);
  result.notes = std::move(draft.notes);
  return result;
}

}  // namespace screwline
