#include <algorithm>
#include <numeric>
#include <optional>

#include "screwline/exception.h"
#include "screwline/trajectory/blend.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/hermite.h"
#include "screwline/trajectory/profile.h"
#include "screwline/trajectory/segment_times.h"

namespace screwline {
namespace {

VectorX orZero(const VectorX& values, int joints) {
  return values.size() > 0 ? values : VectorX(VectorX::Zero(joints));
}

bool movesAtEnds(const std::vector<PathPoint>& waypoints) {
  return !waypoints.front().velocity.isZero(0.0) || !waypoints.back().velocity.isZero(0.0);
}

/// Nothing but positions decides the motion: then it scales with time as a whole.
bool positionsDecide(const std::vector<PathPoint>& waypoints) {
  return std::all_of(waypoints.begin(), waypoints.end(), [](const PathPoint& waypoint) {
    return waypoint.velocity.isZero(0.0) && waypoint.acceleration.isZero(0.0);
  });
}

MatrixX c2Velocities(const std::vector<PathPoint>& waypoints, const MatrixX& positions,
                     const std::vector<double>& times) {
  const int joints = static_cast<int>(positions.rows());
  return splineVelocities(times, positions, orZero(waypoints.front().velocity, joints),
                          orZero(waypoints.back().velocity, joints));
}

PiecewisePolynomial quinticMotion(const std::vector<PathPoint>& waypoints, const MatrixX& positions,
                                  const std::vector<double>& times) {
  MatrixX velocities = c2Velocities(waypoints, positions, times);
  MatrixX accelerations = splineAccelerations(times, positions, velocities);
  accelerations.col(0).setZero();
  accelerations.col(accelerations.cols() - 1).setZero();
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    const Eigen::Index column = static_cast<Eigen::Index>(k);
    if (waypoints[k].velocity.size() > 0) velocities.col(column) = waypoints[k].velocity;
    if (waypoints[k].acceleration.size() > 0) accelerations.col(column) = waypoints[k].acceleration;
  }
  return quinticsThrough(times, positions, velocities, accelerations);
}

/// Adds the pieces of one trapezoid; a segment that takes no time (a repeated waypoint) adds none.
void appendTrapezoid(std::vector<double>& breaks, std::vector<PiecewisePolynomial>& moves, const VectorX& start,
                     const VectorX& delta, double blend, double length) {
  if (length <= 0.0) return;
  const TimeLaw scaling = TimeLaw::trapezoidal(blend);
  const PiecewisePolynomial& s = scaling.pieces();
  PiecewisePolynomial move(static_cast<int>(start.size()), 2, s.breaks, 1);
  for (std::size_t k = 0; k < move.segments(); ++k) {
    const Polynomial piece = s.piece(k, 0);
    for (int j = 0; j < move.joints; ++j) {
      for (int power = 0; power <= 2; ++power)
        move.at(k, power, j) = delta[j] * piece.c[static_cast<std::size_t>(power)];
      move.at(k, 0, j) += start[j];
    }
  }
  const double begin = breaks.back();
  for (std::size_t k = 1; k < s.breaks.size(); ++k)
    breaks.push_back(k + 1 == s.breaks.size() ? begin + length : begin + length * s.breaks[k]);
  moves.push_back(std::move(move));
}

JointTrajectory trapezoidsThrough(const ProfileContext& context, const std::vector<double>& times) {
  const auto& waypoints = context.waypoints();
  std::vector<double> breaks{0.0};
  std::vector<PiecewisePolynomial> moves;
  for (std::size_t k = 1; k < waypoints.size(); ++k) {
    const VectorX delta = waypoints[k].position - waypoints[k - 1].position;
    const double length = times[k] - times[k - 1];
    const BlendedMove shortest = shortestTrapezoid(delta, context.limits);
    const bool feasible = length >= shortest.duration * (1.0 - kLimitTolerance);
    const double blend = feasible ? blendWithin(delta, context.limits, length) : shortest.blend_fraction;
    appendTrapezoid(breaks, moves, waypoints[k - 1].position, delta, blend, length);
  }
  PiecewisePolynomial motion(context.joints(), 2, std::move(breaks), 1);
  motion.coefficients.clear();
  for (const auto& move : moves) {
    motion.coefficients.insert(motion.coefficients.end(), move.coefficients.begin(), move.coefficients.end());
  }
  return JointTrajectory::piecewise(std::move(motion));
}

/// The radius asked for; 0: a stop at each waypoint.
double blendRadius(const ProfileContext& context) {
  const double radius = context.blendRadius();
  for (std::size_t k = 1; radius > 0.0 && k + 1 < context.waypoints().size(); ++k) {
    if (context.waypoints()[k].time == 0.0) continue;
    throw InputError(AnswerCode::kInvalidGoal, indexed("waypoints", k) + ".time is " +
                                                   number(context.waypoints()[k].time) +
                                                   " s: with a blend_radius instants of intermediate waypoints are "
                                                   "chosen, give none or a duration");
  }
  return radius;
}

void lengthen(BlendedLines& lines, double duration) {
  const double factor = duration / lines.motion.duration();
  for (double& t : lines.motion.breaks) t *= factor;
  for (double& t : lines.times) t *= factor;
  lines.motion.breaks.back() = lines.times.back() = duration;
}

/// Instants are rounded to the resolution of the whole duration, which a very short blend may feel: longer by some
/// parts in 1e8 then, until the limits hold.
void holdLimits(BlendedLines& lines, const Limits& limits) {
  constexpr int kMostRounds = 30;
  lengthen(lines, noLessThanShortest(lines.motion.duration()));
  for (int round = 0; round < kMostRounds; ++round) {
    const double excess = tightestUse(JointTrajectory::piecewise(lines.motion), limits).stretch - 1.0;
    if (excess <= 0.1 * kLimitTolerance) return;
    lengthen(lines, lines.motion.duration() * (1.0 + 2.0 * excess));
  }
}

/// Whether rounding has left the blends what they are for: waypoints that all but coincide make pieces that are too
/// short to be timed.
bool isSound(const BlendedLines& lines, double with_stops) {
  constexpr double kSlower = 1e-5;
  constexpr double kStep = 1e-8;
  for (int j = 0; j < lines.motion.joints; ++j) {
    if (!(stepInside(lines.motion, j, 1) <= kStep)) return false;
  }
  return lines.motion.duration() <= with_stops * (1.0 + kSlower);
}

/// The shortest blended motion, all of it slower where a longer duration is given. Nothing where it is not sound.
std::optional<ProfileDraft> blendedTrapezoids(const ProfileContext& context, double radius, double with_stops) {
  BlendedLines lines = blendLines(positionsOf(context.waypoints()), context.limits, radius);
  holdLimits(lines, context.limits);
  if (!isSound(lines, with_stops)) return std::nullopt;
  const double shortest = lines.motion.duration();
  if (context.duration > 0.0 && context.duration < shortest * (1.0 - kLimitTolerance)) {
    throw InputError(AnswerCode::kLimitsInfeasible,
                     "profile 'multipoint_trapezoidal' in " + number(context.duration) + " s with blend_radius " +
                         number(radius) + ": the shortest feasible duration is " + number(shortest) + " s");
  }
  if (context.duration > 0.0) lengthen(lines, context.duration);
  ProfileDraft draft{JointTrajectory::piecewise(std::move(lines.motion)), std::move(lines.times), {}};
  noteCorners(lines.corners, radius, "", draft.notes);
  return draft;
}

}  // namespace

ProfileDraft buildMultipointTrapezoidal(const ProfileContext& context) {
  const double radius = blendRadius(context);
  if (nothingMoves(context.waypoints())) return holdStill(context);
  const auto& waypoints = context.waypoints();
  std::vector<double> shortest;
  std::size_t last_given = 0;
  for (std::size_t k = 1; k < waypoints.size(); ++k) {
    shortest.push_back(shortestTrapezoid(waypoints[k].position - waypoints[k - 1].position, context.limits).duration);
    if (waypoints[k].time > 0.0) last_given = k;
  }
  if (radius > 0.0) {
    const double with_stops = std::accumulate(shortest.begin(), shortest.end(), 0.0);
    if (auto draft = blendedTrapezoids(context, radius, with_stops)) return std::move(*draft);
  }
  // Each segment knows its own shortest time, so a free tail takes their sum: nothing to scale or to search.
  ProfileContext timed = context;
  if (context.duration == 0.0) {
    timed.duration =
        std::accumulate(shortest.begin() + static_cast<long>(last_given), shortest.end(), waypoints[last_given].time);
  }
  const auto build = [&](const std::vector<double>& times) { return trapezoidsThrough(context, times); };
  ProfileDraft draft = fitTimes(timed, build, shortest, true);
  if (radius > 0.0)
    draft.notes.push_back("waypoints all but coincide, blends would be too short to be timed: at rest in each instead");
  return meetingVias(std::move(draft));
}

ProfileDraft buildMultipointCubic(const ProfileContext& context) {
  if (nothingMoves(context.waypoints())) return holdStill(context);
  const auto build = [&](const MatrixX& positions, const std::vector<double>& times) {
    PiecewisePolynomial motion = cubicsThrough(times, positions, c2Velocities(context.waypoints(), positions, times));
    motion.continuity = 2;
    motion.rest_continuity = 1;
    return motion;
  };
  return meetingVias(fitShape(context, build, !movesAtEnds(context.waypoints())));
}

ProfileDraft buildMultipointQuintic(const ProfileContext& context) {
  if (nothingMoves(context.waypoints())) return holdStill(context);
  const auto build = [&](const MatrixX& positions, const std::vector<double>& times) {
    return quinticMotion(context.waypoints(), positions, times);
  };
  return meetingVias(fitShape(context, build, positionsDecide(context.waypoints())));
}

}  // namespace screwline
