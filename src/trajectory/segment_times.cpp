#include "screwline/trajectory/segment_times.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "segment_search.h"

namespace screwline {
namespace {

constexpr std::size_t kMostSearchedWaypoints = 5000;

/// Instants as far as they are known: given ones, and those between two given ones, shared by weight. Returns the index
/// of the last known one; the others are filled relative to it, per unit of the free scale.
std::size_t knownTimes(const ProfileContext& context, const std::vector<double>& weights, std::vector<double>& times) {
  const std::size_t count = context.waypoints().size();
  times.assign(count, 0.0);
  std::size_t known = 0;
  for (std::size_t k = 1; k < count; ++k) {
    const double given = k + 1 == count ? context.duration : context.waypoints()[k].time;
    if (given == 0.0) continue;
    const auto begin = weights.begin();
    const double total = std::accumulate(begin + static_cast<long>(known), begin + static_cast<long>(k), 0.0);
    const double start = times[known];
    double passed = 0.0;
    for (std::size_t i = known + 1; i <= k; ++i) {
      passed += weights[i - 1];
      // Repeated waypoints weigh nothing where they may take no time: those at the end of a run coincide with its end.
      times[i] = i == k || passed >= total ? given : start + (given - start) * passed / total;
    }
    known = k;
  }
  return known;
}

std::vector<double> withTail(std::vector<double> times, std::size_t known, const std::vector<double>& weights,
                             double scale) {
  for (std::size_t k = known + 1; k < times.size(); ++k) times[k] = times[k - 1] + scale * weights[k - 1];
  return times;
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

/// In units of the shortest durations.
struct Ratios {
  std::vector<double> weights;
  double duration = 0.0;
};

std::vector<double> scaledTo(std::vector<double> lengths, double duration) {
  const double total = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  for (double& length : lengths) length *= duration / total;
  return lengths;
}

std::vector<double> instantsOf(const std::vector<double>& lengths) {
  std::vector<double> times{0.0};
  for (const double length : lengths) times.push_back(times.back() + length);
  return times;
}

/// Where velocities are fixed each duration has its own shape: the shortest of a few balanced ones.
Ratios searchedRatios(const ProfileContext& context, const ShapeBuilder& build, const TimedBuilder& timed,
                      const MatrixX& positions, std::vector<double> weights, double shortest) {
  constexpr int kRounds = 8;
  constexpr Eigen::Index kMostEntries = 400;
  Ratios best{weights, shortest};
  if (positions.size() > kMostEntries || shortest == 0.0) return best;
  double duration = shortest;
  for (int round = 0; round < kRounds && duration > 0.0; ++round) {
    weights = balancedOnce(build, positions, context.limits, scaledTo(weights, duration));
    const auto stretch = [&](double whole) {
      return tightestUse(timed(instantsOf(scaledTo(weights, whole))), context.limits).stretch;
    };
    duration = searchShortest(stretch, best.duration);
    if (duration > 0.0 && duration < best.duration) best = {weights, duration};
  }
  return best;
}

void noteRatios(double before, double after, std::vector<std::string>& notes) {
  if (!(after < before)) return;
  char text[128];
  std::snprintf(text, sizeof text,
                "times of the segments are searched: %.3g %% shorter than in proportion to each one's own shortest",
                100.0 * (1.0 - after / before));
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
  std::vector<double> times;
  const std::size_t known = knownTimes(context, weights, times);
  const double total = std::accumulate(weights.begin() + static_cast<long>(known), weights.end(), 0.0);
  if (known + 1 == times.size()) {
    ProfileDraft draft{build(times), times, {}};
    requireFeasible(context, build, times, draft.trajectory, homogeneous);
    return draft;
  }
  const bool scalable = known == 0 && homogeneous;
  if (!scalable) requireSearchable(context);
  const auto stretch = [&](double tail) {
    return tightestUse(build(withTail(times, known, weights, tail / total)), context.limits).stretch;
  };
  const double tail = scalable ? noLessThanShortest(total * stretch(total)) : searchShortest(stretch, total);
  if (scalable && tail == 0.0) refuseUnbounded(context);
  if (tail == 0.0) refuseAlways(context, tightestUse(build(withTail(times, known, weights, 1.0)), context.limits));
  times = withTail(times, known, weights, tail / total);
  return {build(times), times, {}};
}

ProfileDraft fitShape(const ProfileContext& context, const ShapeBuilder& build, bool homogeneous) {
  const auto& waypoints = context.waypoints();
  const MatrixX positions = positionsOf(waypoints);
  const TimedBuilder timed = [&](const std::vector<double>& times) {
    return JointTrajectory::piecewise(build(positions, times));
  };
  const std::vector<double> weights = segmentWeights(waypoints, context.limits);
  const bool free = std::all_of(waypoints.begin(), waypoints.end() - 1, [](const auto& w) { return w.time == 0.0; });
  if (!free || waypoints.size() < 3) return fitTimes(context, timed, weights, homogeneous);
  const auto stretch = [&](const std::vector<double>& lengths) {
    return tightestUse(timed(instantsOf(lengths)), context.limits).stretch;
  };
  Ratios before{weights, 0.0};
  Ratios after;
  if (homogeneous) {
    const auto shortest = [&](const std::vector<double>& w) {
      return stretch(w) * std::accumulate(w.begin(), w.end(), 0.0);
    };
    before.duration = shortest(weights);
    after.weights = shortestRatios(build, positions, context.limits, weights);
    after.duration = shortest(after.weights);
  } else {
    requireSearchable(context);
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    before.duration = searchShortest([&](double whole) { return stretch(scaledTo(weights, whole)); }, total);
    after = searchedRatios(context, build, timed, positions, weights, before.duration);
  }
  const bool shorter = after.duration < before.duration;
  ProfileDraft draft = fitTimes(context, timed, shorter ? after.weights : weights, homogeneous);
  noteRatios(before.duration, after.duration, draft.notes);
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
