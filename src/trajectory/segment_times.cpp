#include "screwline/trajectory/segment_times.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "segment_search.h"

namespace screwline {
namespace {

constexpr std::size_t kMostSearchedWaypoints = 5000;

TimeFrame frameOf(const ProfileContext& context) {
  std::vector<double> given;
  for (const PathPoint& waypoint : context.waypoints()) given.push_back(waypoint.time);
  given.front() = 0.0;
  given.back() = context.duration;
  return TimeFrame(std::move(given));
}

/// Where only the duration is given and the motion scales with it, the search is the one for the shortest motion: so a
/// longer duration than that is always feasible.
TimeFrame searchedFrame(const ProfileContext& context, bool homogeneous) {
  const auto& waypoints = context.waypoints();
  const bool via_times =
      std::any_of(waypoints.begin(), waypoints.end() - 1, [](const PathPoint& w) { return w.time > 0.0; });
  if (via_times || !homogeneous) return frameOf(context);
  return TimeFrame(std::vector<double>(waypoints.size(), 0.0));
}

std::vector<double> stretched(std::vector<double> times, double factor) {
  for (double& t : times) t *= factor;
  return times;
}

void requireSearchable(const ProfileContext& context) {
  if (context.waypoints().size() <= kMostSearchedWaypoints) return;
  throw InputError(AnswerCode::kTooLarge,
                   "waypoints has " + std::to_string(context.waypoints().size()) +
                       " entries; with velocities or times fixed, durations are searched for at most " +
                       std::to_string(kMostSearchedWaypoints) + ": give every time");
}

[[noreturn]] void refuseUnbounded(const ProfileContext& context) {
  throw InputError(AnswerCode::kInvalidGoal, "duration is 0 and no finite limit bounds profile '" +
                                                 context.request.profile + "': give a duration or a limit");
}

[[noreturn]] void refuseAlways(const ProfileContext& context, const LimitUse& use) {
  throw InputError(AnswerCode::kLimitsInfeasible,
                   "profile '" + context.request.profile + "': " + describe(use) +
                       "; no duration is feasible with the given times, velocities and accelerations");
}

/// Every instant is fixed: the motion keeps the limits, or the answer names what would.
void requireFeasible(const ProfileContext& context, const TimedBuilder& build, const std::vector<double>& times,
                     const JointTrajectory& trajectory, bool homogeneous) {
  const LimitUse use = tightestUse(trajectory, context.limits);
  if (use.value <= use.bound * (1.0 + kLimitTolerance)) return;
  const double duration = times.back();
  if (homogeneous) refuseDuration(context, use, duration * use.stretch);
  requireSearchable(context);
  const auto stretch = [&](double factor) {
    return tightestUse(build(stretched(times, factor)), context.limits).stretch;
  };
  const double factor = searchShortest(stretch, 50.0);  // From 1: a shorter one cannot be the answer.
  if (factor == 0.0) refuseAlways(context, use);
  refuseDuration(context, use, duration * factor);
}

/// [s] The shortest tail by given weights, exactly: 0 where none is feasible.
double shortestTail(const ProfileContext& context, const TimedBuilder& build, const TimeFrame& frame,
                    const std::vector<double>& weights, bool homogeneous) {
  const double total = std::accumulate(weights.begin() + static_cast<long>(frame.tail()), weights.end(), 0.0);
  const auto stretch = [&](double tail) {
    return tightestUse(build(frame.instants(weights, tail / total)), context.limits).stretch;
  };
  if (frame.allOpen() && homogeneous) return noLessThanShortest(total * stretch(total));
  requireSearchable(context);
  return searchShortest(stretch, total);
}

/// What tells one choice of weights from another: the duration, or, where that is given, how much of the limits is used
/// (as the factor of time that would bring the motion to them). Infinite where no duration is feasible.
double outcome(const ProfileContext& context, const TimedBuilder& build, const TimeFrame& frame,
               const std::vector<double>& weights, bool homogeneous) {
  if (!frame.openEnd()) return tightestUse(build(frame.instants(weights)), context.limits).stretch;
  const double tail = shortestTail(context, build, frame, weights, homogeneous);
  return tail > 0.0 ? frame.tailStart() + tail : std::numeric_limits<double>::infinity();
}

void noteSearch(const TimeFrame& frame, double before, double after, std::vector<std::string>& notes) {
  char text[160];
  if (frame.openEnd() && std::isfinite(before)) {
    std::snprintf(text, sizeof text,
                  "times of the segments are searched: %.3g %% shorter than in proportion to each one's own shortest",
                  100.0 * (1.0 - after / before));
  } else if (frame.openEnd()) {
    std::snprintf(text, sizeof text,
                  "times of the segments are searched: in proportion to each one's own shortest none would do");
  } else {
    std::snprintf(
        text, sizeof text,
        "times of the segments are searched: limits allow %.4g of the given time; in proportion to each one's "
        "own shortest %.4g",
        after, before);
  }
  notes.push_back(text);
}

}  // namespace

MatrixX positionsOf(const std::vector<PathPoint>& waypoints) {
  MatrixX positions(waypoints.front().position.size(), static_cast<Eigen::Index>(waypoints.size()));
  for (std::size_t k = 0; k < waypoints.size(); ++k)
    positions.col(static_cast<Eigen::Index>(k)) = waypoints[k].position;
  return positions;
}

bool nothingMoves(const std::vector<PathPoint>& waypoints) {
  return std::all_of(waypoints.begin(), waypoints.end(), [&](const PathPoint& waypoint) {
    const bool still = waypoint.velocity.isZero(0.0) && waypoint.acceleration.isZero(0.0);
    return still && waypoint.position == waypoints.front().position;
  });
}

std::vector<double> segmentWeights(const std::vector<PathPoint>& waypoints, const Limits& limits) {
  std::vector<double> weights;
  for (std::size_t k = 1; k < waypoints.size(); ++k) {
    const VectorX delta = waypoints[k].position - waypoints[k - 1].position;
    const auto unit = JointTrajectory::scaled(waypoints[k - 1].position, delta, TimeLaw::polynomial345(), 1.0);
    weights.push_back(tightestUse(unit, limits).stretch);
  }
  if (std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0.0; })) {
    for (std::size_t k = 1; k < waypoints.size(); ++k)
      weights[k - 1] = (waypoints[k].position - waypoints[k - 1].position).norm();
  }
  const double most = *std::max_element(weights.begin(), weights.end());
  double least = most > 0.0 ? most : 1.0;
  for (double w : weights) least = w > 1e-3 * most && w < least ? w : least;
  for (double& w : weights) w = std::max(w, least);
  return weights;
}

double searchShortest(const std::function<double(double)>& stretch, double guess) {
  constexpr double kStep = 1.05;
  constexpr int kMostSteps = 300;
  const auto feasible = [&](double duration) { return stretch(duration) <= 1.0; };
  double upper = 0.02 * guess;
  int step = 0;
  while (!feasible(upper)) {
    if (++step > kMostSteps) return 0.0;
    upper *= kStep;
  }
  double lower = upper / kStep;
  while (upper - lower > 1e-12 * upper) {
    const double middle = 0.5 * (lower + upper);
    (feasible(middle) ? upper : lower) = middle;
  }
  return upper;
}

ProfileDraft fitTimes(const ProfileContext& context, const TimedBuilder& build, const std::vector<double>& weights,
                      bool homogeneous) {
  const TimeFrame frame = frameOf(context);
  if (!frame.openEnd()) {
    const std::vector<double> times = frame.instants(weights);
    ProfileDraft draft{build(times), times, {}};
    requireFeasible(context, build, times, draft.trajectory, homogeneous);
    return draft;
  }
  const double tail = shortestTail(context, build, frame, weights, homogeneous);
  if (tail == 0.0 && frame.allOpen() && homogeneous) refuseUnbounded(context);
  if (tail == 0.0) refuseAlways(context, tightestUse(build(frame.instants(weights)), context.limits));
  const double total = std::accumulate(weights.begin() + static_cast<long>(frame.tail()), weights.end(), 0.0);
  const std::vector<double> times = frame.instants(weights, tail / total);
  return {build(times), times, {}};
}

ProfileDraft fitShape(const ProfileContext& context, const ShapeBuilder& build, bool homogeneous) {
  constexpr Eigen::Index kMostEntries = 400;  // Of a tail that does not scale: each look at it is a search of its own.
  const MatrixX positions = positionsOf(context.waypoints());
  const TimedBuilder timed = [&](const std::vector<double>& times) {
    return JointTrajectory::piecewise(build(positions, times));
  };
  const TimeFrame frame = frameOf(context);
  const std::vector<double> weights = segmentWeights(context.waypoints(), context.limits);
  const bool scales = !frame.openEnd() || (frame.allOpen() && homogeneous);
  if (weights.size() < 2 || frame.allGiven() || (!scales && positions.size() > kMostEntries))
    return fitTimes(context, timed, weights, homogeneous);
  const std::vector<double> found =
      searchedWeights(build, positions, context.limits, searchedFrame(context, homogeneous), homogeneous, weights);
  const double before = outcome(context, timed, frame, weights, homogeneous);
  const double after = outcome(context, timed, frame, found, homogeneous);
  if (!(after < before)) return fitTimes(context, timed, weights, homogeneous);
  ProfileDraft draft = fitTimes(context, timed, found, homogeneous);
  noteSearch(frame, before, after, draft.notes);
  return draft;
}

ProfileDraft holdStill(const ProfileContext& context) {
  const VectorX& position = context.waypoints().front().position;
  PiecewisePolynomial rest(context.joints(), 0, {0.0, context.duration}, 3);
  for (int j = 0; j < context.joints(); ++j) rest.at(0, 0, j) = position[j];
  ProfileDraft draft{JointTrajectory::piecewise(rest), {}, {"no waypoint differs from the first: nothing moves"}};
  const std::size_t last = context.waypoints().size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    draft.waypoint_times.push_back(last > 0 ? context.duration * static_cast<double>(k) / static_cast<double>(last)
                                            : 0.0);
  }
  return draft;
}

}  // namespace screwline
