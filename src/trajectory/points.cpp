#include "screwline/trajectory/points.h"

#include <cmath>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/hermite.h"

namespace screwline {
namespace {

[[noreturn]] void refuse(const std::string& message) {
  throw InputError(AnswerCode::kInvalidGoal, message);
}

void requireUsable(double value, const std::string& field) {
  if (std::isfinite(value) && std::abs(value) <= 1e6) return;
  refuse(field + " is " + number(value) + ", its magnitude must be finite and at most 1000000");
}

void requireVector(const VectorX& values, Eigen::Index joints, const std::string& field) {
  if (values.size() != joints) {
    refuse(field + " has " + std::to_string(values.size()) + " values, it must have " + std::to_string(joints));
  }
  for (Eigen::Index i = 0; i < values.size(); ++i)
    requireUsable(values[i], indexed(field, static_cast<std::size_t>(i)));
}

void validatePoints(const std::vector<SampledPoint>& points) {
  if (points.empty()) refuse("points is empty");
  if (points.size() > 1000000) {
    throw InputError(AnswerCode::kTooLarge,
                     "points has " + std::to_string(points.size()) + " entries, at most 1000000 are taken");
  }
  const SampledPoint& first = points.front();
  if (first.position.size() == 0) refuse("points[0].positions is empty");
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::string field = indexed("points", k);
    requireVector(points[k].position, first.position.size(), field + ".positions");
    requireVector(points[k].velocity, first.velocity.size() > 0 ? first.position.size() : 0, field + ".velocities");
    requireVector(points[k].acceleration, first.acceleration.size() > 0 ? first.position.size() : 0,
                  field + ".accelerations");
    requireUsable(points[k].time, field + ".time_from_start");
    if (points[k].time < 0.0)
      refuse(field + ".time_from_start is " + number(points[k].time) + " s, it must not be negative");
    if (k > 0 && points[k].time <= points[k - 1].time) {
      refuse(field + ".time_from_start is " + number(points[k].time) + " s, it must be after " +
             number(points[k - 1].time) + " s");
    }
  }
}

/// The start state as a point with the fields that the others have.
SampledPoint startPoint(const MotionState* start, const SampledPoint& first) {
  if (start == nullptr) refuse("points[0].time_from_start is " + number(first.time) + " s, it must be 0");
  SampledPoint point;
  point.position = start->position;
  if (first.velocity.size() > 0) point.velocity = start->velocity;
  if (first.acceleration.size() > 0) point.acceleration = start->acceleration;
  return point;
}

JointTrajectory restingAt(const VectorX& position) {
  PiecewisePolynomial rest(static_cast<int>(position.size()), 0, {0.0, 0.0}, 3);
  for (int j = 0; j < rest.joints; ++j) rest.at(0, 0, j) = position[j];
  return JointTrajectory::piecewise(rest);
}

}  // namespace

JointTrajectory trajectoryThrough(const std::vector<SampledPoint>& points, const MotionState* start) {
  validatePoints(points);
  std::vector<SampledPoint> all;
  if (points.front().time > 0.0) all.push_back(startPoint(start, points.front()));
  all.insert(all.end(), points.begin(), points.end());
  if (!points.empty() && all.size() > points.size()) validatePoints(all);
  if (all.size() == 1) return restingAt(all.front().position);

  const Eigen::Index joints = all.front().position.size();
  const Eigen::Index count = static_cast<Eigen::Index>(all.size());
  const bool has_velocity = all.front().velocity.size() > 0;
  const bool has_acceleration = has_velocity && all.front().acceleration.size() > 0;
  std::vector<double> times;
  MatrixX positions(joints, count);
  MatrixX velocities = MatrixX::Zero(joints, count);
  MatrixX accelerations = MatrixX::Zero(joints, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const SampledPoint& point = all[static_cast<std::size_t>(k)];
    times.push_back(point.time);
    positions.col(k) = point.position;
    if (has_velocity) velocities.col(k) = point.velocity;
    if (has_acceleration) accelerations.col(k) = point.acceleration;
  }
  if (has_acceleration) return JointTrajectory::piecewise(quinticsThrough(times, positions, velocities, accelerations));
  if (has_velocity) return JointTrajectory::piecewise(cubicsThrough(times, positions, velocities));
  return JointTrajectory::piecewise(linesThrough(times, positions));
}

}  // namespace screwline
