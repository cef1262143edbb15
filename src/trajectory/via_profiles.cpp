#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/profile.h"
#include "screwline/trajectory/segment_times.h"

namespace screwline {
namespace {

/// A motion for a duration and the fraction of it at which the via is due.
using ViaBuilder = std::function<JointTrajectory(double duration, double via_tau)>;

/// Nearer to an end the coefficients grow with the third power of the distance, and rounding of them moves the ends.
constexpr double kLeastTau = 0.01;

void requireTau(double tau, const std::string& what) {
  if (tau >= kLeastTau && tau <= 1.0 - kLeastTau) return;
  throw InputError(AnswerCode::kInvalidGoal, what + " is " + number(tau) + ", it must be " + number(kLeastTau) +
                                                 " to " + number(1.0 - kLeastTau));
}

std::optional<double> givenTau(const ProfileContext& context) {
  const auto tau = context.parameter("via_tau");
  if (tau && context.waypoints()[1].time > 0.0) {
    throw InputError(AnswerCode::kInvalidGoal,
                     "parameter 'via_tau' and waypoints[1].time are both given: one of them decides");
  }
  if (tau) requireTau(*tau, "parameter 'via_tau'");
  return tau;
}

[[noreturn]] void refuseViaTime(const ProfileContext& context, const LimitUse& use) {
  throw InputError(AnswerCode::kLimitsInfeasible, "profile '" + context.request.profile + "': " + describe(use) +
                                                      "; no duration is feasible with the via at " +
                                                      number(context.waypoints()[1].time) + " s");
}

/// The via is due at a fixed instant and the duration is free: its fraction changes with the duration, so search.
ProfileDraft searchDuration(const ProfileContext& context, const ViaBuilder& build) {
  const double instant = context.waypoints()[1].time;
  const auto motion = [&](double rest) { return build(instant + rest, instant / (instant + rest)); };
  const double rest = searchShortest([&](double r) { return tightestUse(motion(r), context.limits).stretch; }, instant);
  if (rest == 0.0) refuseViaTime(context, tightestUse(motion(instant), context.limits));
  return {motion(rest), {0.0, instant, instant + rest}, {}};
}

ProfileDraft fitVia(const ProfileContext& context, const ViaBuilder& build) {
  const double instant = context.waypoints()[1].time;
  const std::optional<double> fraction = givenTau(context);
  if (instant > 0.0 && context.duration == 0.0) return searchDuration(context, build);
  const double tau = instant > 0.0 ? instant / context.duration : fraction.value_or(0.5);
  if (instant > 0.0) requireTau(tau, "waypoints[1].time as a fraction of the duration");
  const double shortest = tightestUse(build(1.0, tau), context.limits).stretch;
  if (context.duration == 0.0 && shortest == 0.0 && !nothingMoves(context.waypoints())) {
    throw InputError(AnswerCode::kInvalidGoal, "duration is 0 and no finite limit bounds profile '" +
                                                   context.request.profile + "': give a duration or a limit");
  }
  const double duration = context.duration > 0.0 ? context.duration : noLessThanShortest(shortest);
  ProfileDraft draft{build(duration, tau), {0.0, tau * duration, duration}, {}};
  const LimitUse use = tightestUse(draft.trajectory, context.limits);
  if (use.value > use.bound * (1.0 + kLimitTolerance)) refuseDuration(context, use, shortest);
  return draft;
}

double viaShare(const std::vector<PathPoint>& waypoints) {
  const double travel = waypoints[2].position[0] - waypoints[0].position[0];
  if (travel == 0.0) {
    throw InputError(AnswerCode::kInvalidGoal,
                     "profile 'via_scalar' fits s(tau) to the first joint, which starts and ends at " +
                         number(waypoints[0].position[0]) + ": no S exists (via_per_joint passes any via)");
  }
  return (waypoints[1].position[0] - waypoints[0].position[0]) / travel;
}

void noteReversal(const TimeLaw& scaling, std::vector<std::string>& notes) {
  if (scaling.isMonotone()) return;
  notes.push_back("the motion reverses: s(tau) covers " + number(scaling.extrema().position.lower) + " to " +
                  number(scaling.extrema().position.upper) + " instead of 0 to 1");
}

void noteMiss(const ProfileContext& context, ProfileDraft& draft) {
  TrajectoryPoint point(context.joints());
  draft.trajectory.sample(draft.waypoint_times[1], point);
  const VectorX error = point.position - context.waypoints()[1].position;
  Eigen::Index worst = 0;
  const double largest = error.cwiseAbs().maxCoeff(&worst);
  if (largest <= 1e-9) return;
  draft.notes.push_back("the via is missed: one s(tau) is fitted to the first joint, joint " + std::to_string(worst) +
                        " is off by " + number(error[worst]) + " at " + number(draft.waypoint_times[1]) +
                        " s; via_per_joint passes it");
}

}  // namespace

ProfileDraft buildViaScalar(const ProfileContext& context) {
  const auto& waypoints = context.waypoints();
  const double share = viaShare(waypoints);
  const VectorX delta = waypoints[2].position - waypoints[0].position;
  const auto build = [&](double duration, double tau) {
    return JointTrajectory::scaled(waypoints[0].position, delta, TimeLaw::via6(share, tau), duration);
  };
  ProfileDraft draft = fitVia(context, build);
  draft.notes.push_back("S = " + number(share) + " from the first joint, due at tau = " +
                        number(draft.waypoint_times[1] / draft.trajectory.duration()));
  noteReversal(*draft.trajectory.scaling(), draft.notes);
  noteMiss(context, draft);
  return draft;
}

ProfileDraft buildViaPerJoint(const ProfileContext& context) {
  const auto& waypoints = context.waypoints();
  const auto build = [&](double duration, double tau) {
    const double at_via = TimeLaw::polynomial345().at(tau).s;
    const double lift = std::pow(tau * (1.0 - tau), 3);
    PiecewisePolynomial motion(context.joints(), 6, {0.0, duration}, 2);
    for (int j = 0; j < context.joints(); ++j) {
      const double start = waypoints[0].position[j];
      const double d = waypoints[2].position[j] - start;
      const double k = (waypoints[1].position[j] - start - d * at_via) / lift;
      motion.setPiece(0, j, {{start, 0.0, 0.0, 10.0 * d + k, -15.0 * d - 3.0 * k, 6.0 * d + 3.0 * k, -k}});
    }
    return JointTrajectory::piecewise(std::move(motion));
  };
  return meetingVias(fitVia(context, build));
}

}  // namespace screwline
