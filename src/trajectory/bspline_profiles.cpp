#include <algorithm>
#include <cmath>
#include <numeric>

#include "screwline/exception.h"
#include "screwline/trajectory/bspline.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/profile.h"
#include "screwline/trajectory/segment_times.h"

namespace screwline {
namespace {

int degreeOf(const ProfileContext& context) {
  const double degree = context.parameter("degree", 3.0);
  if (degree == std::floor(degree) && degree >= 3.0 && degree <= 7.0) return static_cast<int>(degree);
  throw InputError(AnswerCode::kInvalidGoal,
                   "parameter 'degree' is " + number(degree) + ", it must be 3, 4, 5, 6 or 7");
}

/// How often an end point is repeated so that velocity and acceleration (and jerk, from degree 6) are zero there.
int copiesForRest(int degree) {
  return degree < 6 ? 3 : 4;
}

MatrixX controlPoints(const std::vector<PathPoint>& waypoints, int copies) {
  const MatrixX positions = positionsOf(waypoints);
  MatrixX control(positions.rows(), positions.cols() + 2 * (copies - 1));
  control.leftCols(copies).colwise() = positions.col(0);
  control.middleCols(copies - 1, positions.cols()) = positions;
  control.rightCols(copies).colwise() = positions.col(positions.cols() - 1);
  return control;
}

Bspline uniformBspline(int degree, const MatrixX& control, double duration) {
  const int spans = static_cast<int>(control.cols()) - degree;
  std::vector<double> interior;
  for (int k = 1; k < spans; ++k) interior.push_back(duration * k / spans);
  return {degree, clampedKnots(degree, interior, duration), control};
}

/// The instant that belongs to a control point: the mean of the knots that carry it (Greville's abscissa).
double instantOf(const Bspline& spline, std::size_t control) {
  double sum = 0.0;
  for (std::size_t k = 1; k <= static_cast<std::size_t>(spline.degree); ++k) sum += spline.knots[control + k];
  return sum / spline.degree;
}

}  // namespace

ProfileDraft buildBspline(const ProfileContext& context) {
  if (nothingMoves(context.waypoints())) return holdStill(context);
  const int degree = degreeOf(context);
  const bool rest = context.parameter("rest_ends", 1.0) != 0.0;
  const MatrixX control = controlPoints(context.waypoints(), rest ? copiesForRest(degree) : 1);
  if (control.cols() < degree + 1) {
    throw InputError(AnswerCode::kInvalidGoal, "waypoints has " + std::to_string(control.cols()) +
                                                   " entries; without rest_ends a B-spline of degree " +
                                                   std::to_string(degree) + " takes at least " +
                                                   std::to_string(degree + 1));
  }
  const auto build = [&](const std::vector<double>& times) {
    PiecewisePolynomial motion = piecesOf(uniformBspline(degree, control, times.back()));
    motion.rest_continuity = rest ? copiesForRest(degree) - 1 : 0;
    motion.starts_at_rest = motion.ends_at_rest = rest;
    return JointTrajectory::piecewise(motion);
  };
  ProfileDraft draft = fitTimes(context, build, segmentWeights(context.waypoints(), context.limits), true);
  const double duration = draft.trajectory.duration();
  const Bspline spline = uniformBspline(degree, control, duration);
  for (std::size_t k = 1; k + 1 < draft.waypoint_times.size(); ++k) {
    draft.waypoint_times[k] = instantOf(spline, k + static_cast<std::size_t>(rest ? copiesForRest(degree) - 1 : 0));
  }
  if (!rest) draft.notes.push_back("without rest_ends the B-spline starts and ends in motion");
  return draft;
}

ProfileDraft buildBsplineInterpolating(const ProfileContext& context) {
  if (nothingMoves(context.waypoints())) return holdStill(context);
  const int degree = degreeOf(context);
  const MatrixX positions = positionsOf(context.waypoints());
  const auto build = [&](const std::vector<double>& times) {
    PiecewisePolynomial motion = piecesOf(interpolatingBspline(degree, times, positions));
    motion.rest_continuity = copiesForRest(degree) - 1;
    return JointTrajectory::piecewise(motion);
  };
  return meetingVias(fitTimes(context, build, segmentWeights(context.waypoints(), context.limits), true));
}

}  // namespace screwline
