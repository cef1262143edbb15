#include <algorithm>
#include <cmath>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/path.h"
#include "screwline/trajectory/profile.h"
#include "screwline/trajectory/retime.h"
#include "screwline/trajectory/segment_times.h"

namespace screwline {
namespace {

constexpr double kMostGridPoints = 200000.0;

int gridPointsOf(const ProfileContext& context) {
  const double count = context.parameter("grid_points", 0.0);
  if (count == std::floor(count) && count >= 0.0 && count <= kMostGridPoints) return static_cast<int>(count);
  throw InputError(AnswerCode::kInvalidGoal, "parameter 'grid_points' is " + number(count) +
                                                 ", it must be a whole number from 0 (chosen) to 200000");
}

/// The instant of each breakpoint of the path: all of them are on the grid.
std::vector<double> breakTimes(const JointPath& path, const RetimeResult& result, double duration) {
  std::vector<double> times;
  const std::vector<double>& tau = result.law.pieces().breaks;
  std::size_t k = 0;
  for (double u : path.breaks()) {
    while (k + 1 < result.points.size() && result.points[k].u < u) ++k;
    times.push_back(tau[k] * duration);
  }
  times.back() = duration;
  return times;
}

}  // namespace

ProfileDraft buildPathTimeOptimal(const ProfileContext& context) {
  const auto& waypoints = context.waypoints();
  if (nothingMoves(waypoints)) return holdStill(context);
  std::vector<double> knots;
  for (std::size_t k = 0; k < waypoints.size(); ++k)
    knots.push_back(static_cast<double>(k) / static_cast<double>(waypoints.size() - 1));
  const JointPath path = naturalSplinePath(knots, positionsOf(waypoints));
  RetimeOptions options;
  options.grid_points = gridPointsOf(context);
  const RetimeResult result = retime(path, context.limits, options);
  const double shortest = noLessThanShortest(result.duration);
  const double duration = context.duration > 0.0 ? context.duration : shortest;
  ProfileDraft draft{JointTrajectory::alongPath(path, result.law, duration), breakTimes(path, result, duration), {}};
  const LimitUse use = tightestUse(draft.trajectory, context.limits);
  if (use.value > use.bound * (1.0 + kLimitTolerance)) refuseDuration(context, use, shortest);
  return draft;
}

}  // namespace screwline
