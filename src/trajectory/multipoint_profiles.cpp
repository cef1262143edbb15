#include <algorithm>
#include <numeric>

#include "screwline/exception.h"
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

JointTrajectory quinticMotion(const std::vector<PathPoint>& waypoints, const MatrixX& positions,
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
  return JointTrajectory::piecewise(quinticsThrough(times, positions, velocities, accelerations));
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

}  // namespace

ProfileDraft buildMultipointTrapezoidal(const ProfileContext& context) {
  if (nothingMoves(context.waypoints())) return holdStill(context);
  const auto& waypoints = context.waypoints();
  std::vector<double> shortest;
  std::size_t last_given = 0;
  for (std::size_t k = 1; k < waypoints.size(); ++k) {
    shortest.push_back(shortestTrapezoid(waypoints[k].position - waypoints[k - 1].position, context.limits).duration);
    if (waypoints[k].time > 0.0) last_given = k;
  }
  // Each segment knows its own shortest time, so a free tail takes their sum: nothing to scale or to search.
  ProfileContext timed = context;
  if (context.duration == 0.0) {
    timed.duration =
        std::accumulate(shortest.begin() + static_cast<long>(last_given), shortest.end(), waypoints[last_given].time);
  }
  const auto build = [&](const std::vector<double>& times) { return trapezoidsThrough(context, times); };
  return meetingVias(fitTimes(timed, build, shortest, true));
}

ProfileDraft buildMultipointCubic(const ProfileContext& context) {
  if (nothingMoves(context.waypoints())) return holdStill(context);
  const MatrixX positions = positionsOf(context.waypoints());
  const auto build = [&](const std::vector<double>& times) {
    PiecewisePolynomial motion = cubicsThrough(times, positions, c2Velocities(context.waypoints(), positions, times));
    motion.continuity = 2;
    motion.rest_continuity = 1;
    return JointTrajectory::piecewise(std::move(motion));
  };
  return meetingVias(
      fitTimes(context, build, segmentWeights(context.waypoints(), context.limits), !movesAtEnds(context.waypoints())));
}

ProfileDraft buildMultipointQuintic(const ProfileContext& context) {
  if (nothingMoves(context.waypoints())) return holdStill(context);
  const MatrixX positions = positionsOf(context.waypoints());
  const auto build = [&](const std::vector<double>& times) {
    return quinticMotion(context.waypoints(), positions, times);
  };
  return meetingVias(fitTimes(context, build, segmentWeights(context.waypoints(), context.limits),
                              positionsDecide(context.waypoints())));
}

}  // namespace screwline
