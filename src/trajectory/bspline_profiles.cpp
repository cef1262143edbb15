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

SplineEnds endsOf(const ProfileContext& context) {
  const PathPoint& first = context.waypoints().front();
  const PathPoint& last = context.waypoints().back();
  return {first.velocity, first.acceleration, last.velocity, last.acceleration};
}

void joinEnds(const SplineEnds& ends, int degree, PiecewisePolynomial& motion) {
  motion.rest_continuity = copiesForRest(degree) - 1;
  motion.starts_at_rest = ends.firstRests();
  motion.ends_at_rest = ends.lastRests();
}

MatrixX requiredControl(const ProfileContext& context, int degree, bool rest, bool moving) {
  if (!rest && moving) {
    throw InputError(AnswerCode::kInvalidGoal,
                     "parameter 'rest_ends' is 0: the control points alone decide the velocities at the ends, give "
                     "none in the waypoints");
  }
  const MatrixX control = controlPoints(context.waypoints(), rest ? copiesForRest(degree) : 1);
  if (control.cols() >= degree + 1) return control;
  throw InputError(AnswerCode::kInvalidGoal, "waypoints has " + std::to_string(control.cols()) +
                                                 " entries; without rest_ends a B-spline of degree " +
                                                 std::to_string(degree) + " takes at least " +
                                                 std::to_string(degree + 1));
}

}  // namespace

ProfileDraft buildBspline(const ProfileContext& context) {
  if (nothingMoves(context.waypoints())) return holdStill(context);
  const int degree = degreeOf(context);
  const bool rest = context.parameter("rest_ends", 1.0) != 0.0;
  const SplineEnds ends = endsOf(context);
  const bool moving = !ends.firstRests() || !ends.lastRests();
  const MatrixX control = requiredControl(context, degree, rest, moving);
  const auto spline = [&](double duration) {
    Bspline result = uniformBspline(degree, control, duration);
    if (moving) meetEnds(ends, copiesForRest(degree), result);
    return result;
  };
  const auto build = [&](const std::vector<double>& times) {
    PiecewisePolynomial motion = piecesOf(spline(times.back()));
    if (rest) {
      joinEnds(ends, degree, motion);
    } else {
      motion.rest_continuity = 0;
      motion.starts_at_rest = motion.ends_at_rest = false;
    }
    return JointTrajectory::piecewise(motion);
  };
  ProfileDraft draft = fitTimes(context, build, segmentWeights(context.waypoints(), context.limits), !moving);
  const Bspline found = spline(draft.trajectory.duration());
  for (std::size_t k = 1; k + 1 < draft.waypoint_times.size(); ++k) {
    draft.waypoint_times[k] = instantOf(found, k + static_cast<std::size_t>(rest ? copiesForRest(degree) - 1 : 0));
  }
  if (!rest) draft.notes.push_back("without rest_ends the B-spline starts and ends in motion");
  if (moving) draft.notes.push_back("with velocities at its ends the B-spline may leave the hull of the waypoints");
  return draft;
}

ProfileDraft buildBsplineInterpolating(const ProfileContext& context) {
  if (nothingMoves(context.waypoints())) return holdStill(context);
  const int degree = degreeOf(context);
  const SplineEnds ends = endsOf(context);
  const auto build = [&](const MatrixX& positions, const std::vector<double>& times) {
    PiecewisePolynomial motion = piecesOf(interpolatingBspline(degree, times, positions, ends));
    joinEnds(ends, degree, motion);
    return motion;
  };
  return meetingVias(fitShape(context, build, ends.firstRests() && ends.lastRests()));
}

}  // namespace screwline
