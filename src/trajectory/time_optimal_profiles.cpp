#include <algorithm>
#include <cmath>
#include <memory>

#include "screwline/exception.h"
#include "screwline/trajectory/double_s.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/profile.h"
#include "screwline/trajectory/segment_times.h"
#include "screwline/trajectory/state_to_state.h"
#include "screwline/trajectory/waypoint_search.h"

namespace screwline {
namespace {

/// Of the duration: a ramp of the acceleration takes at least this. The instants of shorter ones would be rounded to
/// more than the limits tolerate.
constexpr double kShortestRamp = 1e-6;

/// The joint's limits, the jerk lowered where it would reach full acceleration in less than `ramp` [s].
AxisLimits limitsOf(const ProfileContext& context, int joint, double ramp) {
  if (!std::isfinite(context.limits.jerk[joint])) {
    throw InputError(AnswerCode::kInvalidGoal, indexed("jerk_limits", static_cast<std::size_t>(joint)) +
                                                   " is infinite, profile '" + context.request.profile +
                                                   "' needs a finite one");
  }
  AxisLimits limits = axisLimits(context.limits, joint);
  const double most = std::min(limits.jerk.upper, limits.acceleration.upper / ramp);
  limits.jerk = {-most, most};
  return limits;
}

EndState stateOf(const PathPoint& waypoint, int joint) {
  return {waypoint.position[joint], waypoint.velocity.size() > 0 ? waypoint.velocity[joint] : 0.0,
          waypoint.acceleration.size() > 0 ? waypoint.acceleration[joint] : 0.0};
}

/// A state of which the velocity has to leave its limits is refused here: a plan keeps the limits from its start on.
void requireWayOut(const EndState& state, const AxisLimits& limits, int joint) {
  const StateCheck check = checkState(state, limits, true);
  if (check.fault == StateFault::kNone) return;
  throw InputError(AnswerCode::kLimitsInfeasible,
                   "waypoints[0]: joint " + std::to_string(joint) + " has " +
                       (check.fault == StateFault::kVelocity ? "velocity " : "acceleration ") + number(check.value) +
                       (check.fault == StateFault::kVelocity ? " with its acceleration" : "") + ", feasible is " +
                       number(check.feasible.lower) + " to " + number(check.feasible.upper));
}

void requireJoints(const ProfileContext& context) {
  if (context.joints() > kMaxJoints) {
    throw InputError(AnswerCode::kTooLarge, "the robot has " + std::to_string(context.joints()) +
                                                " joints, profile 'time_optimal' plans at most " +
                                                std::to_string(kMaxJoints));
  }
}

void ask(const ProfileContext& context, double ramp, StateToState& question) {
  question.joints = context.joints();
  for (int joint = 0; joint < question.joints; ++joint) {
    const std::size_t j = static_cast<std::size_t>(joint);
    question.from[j] = stateOf(context.waypoints().front(), joint);
    question.to[j] = stateOf(context.waypoints().back(), joint);
    question.limits[j] = limitsOf(context, joint, ramp);
    requireWayOut(question.from[j], question.limits[j], joint);
  }
}

void answer(const StateToState& question, StateToStateMotion& motion) {
  moveStateToState(question, motion);
  if (motion.status == MotionStatus::kFound) return;
  const bool infeasible = motion.status == MotionStatus::kGoal || motion.status == MotionStatus::kPosition;
  throw InputError(infeasible ? AnswerCode::kLimitsInfeasible : AnswerCode::kInvalidGoal,
                   "profile 'time_optimal': " + describe(motion));
}

std::vector<ViaState> viaStates(const ProfileContext& context) {
  std::vector<ViaState> vias;
  const auto& waypoints = context.waypoints();
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    const bool end = k == 0 || k + 1 == waypoints.size();
    const bool given = waypoints[k].velocity.size() > 0 || waypoints[k].acceleration.size() > 0;
    ViaState via;
    via.free = !end && !given;
    for (int joint = 0; joint < context.joints(); ++joint) {
      via.joints[static_cast<std::size_t>(joint)] = stateOf(waypoints[k], joint);
    }
    // A stop is no less where it is asked for twice.
    if (k > 0 && waypoints[k].position == waypoints[k - 1].position) via.free = vias.back().free = false;
    vias.push_back(via);
  }
  return vias;
}

[[noreturn]] void refuseSegment(const StateToStateMotion& motion, std::size_t k) {
  throw InputError(
      AnswerCode::kLimitsInfeasible,
      "profile 'time_optimal', from " + indexed("waypoints", k) + " to the next: " +
          (motion.status == MotionStatus::kFound ? "its state is bound to leave the limits" : describe(motion)));
}

/// The factor to the given duration: all of the motion slower, where the ends and the given states allow that.
double stretchOf(const ProfileContext& context, double shortest) {
  const double wanted = context.duration;
  if (wanted == 0.0) return 1.0;
  const bool at_rest = std::all_of(context.waypoints().begin(), context.waypoints().end(), [](const PathPoint& w) {
    return w.velocity.isZero(0.0) && w.acceleration.isZero(0.0);
  });
  if (wanted < shortest * (1.0 - kLimitTolerance) || (!at_rest && wanted > shortest * (1.0 + kLimitTolerance))) {
    throw InputError(AnswerCode::kLimitsInfeasible,
                     "profile 'time_optimal' in " + number(wanted) + " s: the shortest motion found takes " +
                         number(shortest) + " s" +
                         (at_rest ? "" : ", and moving waypoints do not let it be stretched"));
  }
  return std::max(1.0, wanted / shortest);
}

std::array<AxisLimits, kMaxJoints> limitsOf(const ProfileContext& context, double ramp) {
  std::array<AxisLimits, kMaxJoints> limits;
  for (int joint = 0; joint < context.joints(); ++joint) {
    const std::size_t j = static_cast<std::size_t>(joint);
    limits[j] = limitsOf(context, joint, ramp);
    requireWayOut(stateOf(context.waypoints().front(), joint), limits[j], joint);
  }
  return limits;
}

/// Of all waypoints: how far a joint goes from one to the next, and the greatest velocity that is given.
void measure(const ProfileContext& context, int joint, double& travel, double& velocity) {
  const auto& waypoints = context.waypoints();
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    velocity = std::max(velocity, std::abs(stateOf(waypoints[k], joint).velocity));
    if (k > 0) travel += std::abs(waypoints[k].position[joint] - waypoints[k - 1].position[joint]);
  }
}

/// The joints' limits, lowered where a joint could go so much faster than the others that what it does is lost in the
/// rounding of their time: no ramp of velocity or acceleration is too short beside a motion with a stop at each
/// waypoint, no way possible in that time too long beside the joint's own.
std::array<AxisLimits, kMaxJoints> limitsThrough(const ProfileContext& context) {
  constexpr double kFarthest = 1e4;
  auto limits = limitsOf(context, kShortestTime);
  const double T = WaypointSearch(context.joints(), limits, viaStates(context)).stopDuration();
  if (!std::isfinite(T)) return limits;
  const double ramp = std::max(kShortestTime, kShortestRamp * T);
  for (int joint = 0; joint < context.joints(); ++joint) {
    AxisLimits& l = limits[static_cast<std::size_t>(joint)];
    double travel = 0.0, given = 0.0;
    measure(context, joint, travel, given);
    const double v = std::min(l.velocity.upper, std::max(kFarthest * std::max(travel, 1.0) / T, 2.0 * given));
    const double a = std::min(l.acceleration.upper, v / ramp);
    const double j = std::min(l.jerk.upper, a / ramp);
    l.velocity = {-v, v};
    l.acceleration = {-a, a};
    l.jerk = {-j, j};
    requireWayOut(stateOf(context.waypoints().front(), joint), l, joint);
  }
  return limits;
}

ProfileDraft throughWaypoints(const ProfileContext& context) {
  WaypointSearch search(context.joints(), limitsThrough(context), viaStates(context));
  const double stretch = search.run() ? stretchOf(context, search.duration()) : 1.0;
  ProfileDraft draft;
  draft.waypoint_times = {0.0};
  PiecewisePolynomial pieces;
  for (std::size_t k = 0; k + 1 < context.waypoints().size(); ++k) {
    const bool feasible = search.feasible(k);
    StateToStateMotion& motion = search.motion();
    if (!feasible) refuseSegment(motion, k);
    if (stretch > 1.0) slowDown(motion, stretch);
    const bool last = k + 2 == context.waypoints().size();
    appendPieces(motion, pieces, stretch > 1.0 && last ? context.duration : 0.0);
    draft.waypoint_times.push_back(pieces.duration());
  }
  draft.notes.push_back("through the intermediate waypoints without a stop; with a stop at each it would take " +
                        number(search.stopDuration()) + " s");
  draft.trajectory = JointTrajectory::piecewise(std::move(pieces));
  return meetingVias(std::move(draft));
}

}  // namespace

ProfileDraft buildTimeOptimal(const ProfileContext& context) {
  if (nothingMoves(context.waypoints())) return holdStill(context);
  requireJoints(context);
  if (context.waypoints().size() > 2) return throughWaypoints(context);
  const auto question = std::make_unique<StateToState>();
  const auto motion = std::make_unique<StateToStateMotion>();
  ask(context, 1e-3 * kShortestTime, *question);
  answer(*question, *motion);
  ask(context, kShortestRamp * std::max(motion->duration, context.duration), *question);
  answer(*question, *motion);
  const double shortest = motion->duration;
  const double wanted = context.duration > 0.0 ? context.duration : noLessThanShortest(shortest);
  if (wanted != shortest) {
    question->least_duration = wanted;
    answer(*question, *motion);
  }
  if (context.duration > 0.0 && motion->duration > wanted * (1.0 + kLimitTolerance)) {
    const std::string blocked =
        wanted > shortest ? "; from the given duration on it is " + number(motion->duration) + " s" : "";
    throw InputError(AnswerCode::kLimitsInfeasible,
                     "profile 'time_optimal' in " + number(wanted) +
                         " s: no motion within the limits; the shortest feasible duration is " + number(shortest) +
                         " s" + blocked);
  }
  ProfileDraft draft;
  draft.trajectory = trajectoryOf(*motion);
  draft.waypoint_times = {0.0, draft.trajectory.duration()};
  return meetingVias(std::move(draft));
}

ProfileDraft buildDoubleS(const ProfileContext& context) {
  constexpr double kNoDisplacement = 1e-60;  // The limits on s would leave the range of a double.
  const VectorX delta = context.waypoints().back().position - context.waypoints().front().position;
  if (delta.isZero(kNoDisplacement)) return scaleBetweenEnds(context, TimeLaw::polynomial345());
  JerkPhases shortest;
  for (double ramp : {1e-3 * kShortestTime, 0.0}) {
    AxisLimits limits;
    for (int joint = 0; joint < context.joints(); ++joint) {
      if (std::abs(delta[joint]) < kNoDisplacement) continue;
      const double least_ramp = ramp > 0.0 ? ramp : kShortestRamp * shortest.duration();
      limits = narrowed(limits, limitsOf(context, joint, least_ramp), delta[joint]);
    }
    shortest = shortestDoubleS(limits);
  }
  return scaleBetweenEnds(context, timeLawOf(shortest));
}

}  // namespace screwline
