#include <algorithm>
#include <cmath>

#include "screwline/ros/checks.h"
#include "screwline/ros/trajectory_conversions.h"
#include "screwline/ros/trajectory_generator.h"

namespace screwline {
namespace ros_bridge {
namespace {

constexpr double kVelocitySlack = 1e-3;  // share by which a given trajectory may pass a velocity limit: interpolation

/// The points, the first at time 0.
std::vector<SampledPoint> fromZero(std::vector<SampledPoint> points) {
  const double first = points.front().time;
  for (SampledPoint& point : points) point.time -= first;
  return points;
}

/// What keeps a motion from being streamed, or nothing.
std::string breach(const SerialChain& chain, const JointTrajectory& trajectory, const Limits& limits) {
  for (int j = 0; j < chain.size(); ++j) {
    const JointExtrema extrema = trajectory.extrema(j);
    const std::string name = "joint " + quoted(chain.joint(j).name);
    const bool low = extrema.position.lower < limits.lower[j] - kSamePlace;
    if (low || extrema.position.upper > limits.upper[j] + kSamePlace) {
      return name + " would reach " + numberText(low ? extrema.position.lower : extrema.position.upper) +
             ", its limits are " + numberText(limits.lower[j]) + " to " + numberText(limits.upper[j]);
    }
    if (extrema.velocity > limits.velocity[j] * (1.0 + kVelocitySlack)) {
      return name + " would reach velocity " + numberText(extrema.velocity) + ", its limit is " +
             numberText(limits.velocity[j]);
    }
  }
  return "";
}

bool keepsVelocities(const JointTrajectory& trajectory, const Limits& limits) {
  for (int j = 0; j < trajectory.joints(); ++j) {
    if (trajectory.extrema(j).velocity > limits.velocity[j] * (1.0 + kVelocitySlack)) return false;
  }
  return true;
}

}  // namespace

std::shared_ptr<const PlannedMotion> TrajectoryGenerator::lastPlanned() const {
  const std::lock_guard<std::mutex> lock(planned_mutex_);
  return planned_;
}

std::string TrajectoryGenerator::announce(const MotionExecutor::Started& started,
                                          const trajectory_msgs::JointTrajectory& points) {
  trajectory_msgs::JointTrajectory message = withLead(*robot_.chain, *started.motion, points);
  message.header.stamp.fromNSec(static_cast<std::uint64_t>(started.stamp));
  sinks_.trajectory(message);
  const double lead = started.motion->lead().duration();
  const std::string pace = paceNote();
  if (lead == 0.0) return pace;
  return "begins with " + numberText(lead) + " s from the present state to the first point" +
         (pace.empty() ? "" : "; " + pace);
}

Outcome TrajectoryGenerator::executePlanned(const PlannedMotion& planned) {
  const auto started =
      executor_.replace([&](const MotionState& present) { return startFrom(present, planned.trajectory, limits_); });
  const std::string message = announce(started, planned.message);
  announceMetrics(planned.metrics);
  return {AnswerCode::kSuccess, message};
}

/// A first point after time 0 is reached in that time where that joins the present motion without a jump; else, and
/// where the first point is at time 0, by a lead.
Motion TrajectoryGenerator::motionThrough(const std::vector<SampledPoint>& points, const MotionState& present) const {
  const bool smooth = isAtRest(present) || points.front().acceleration.size() > 0;
  if (points.front().time > 0.0 && smooth) {
    const JointTrajectory joined = trajectoryThrough(points, &present);
    if (keepsPositions(joined, limits_) && keepsVelocities(joined, limits_)) return Motion(joined);
  }
  return startFrom(present, trajectoryThrough(fromZero(points)), limits_);
}

Outcome TrajectoryGenerator::executeGiven(const trajectory_msgs::JointTrajectory& trajectory) {
  const std::vector<SampledPoint> points = toPoints(*robot_.chain, trajectory);
  const MotionState present{points.front().position, VectorX::Zero(robot_.chain->size()),
                            VectorX::Zero(robot_.chain->size())};
  trajectoryThrough(points, &present);  // Its checks name the points as they were given.
  const std::string why = breach(*robot_.chain, trajectoryThrough(fromZero(points)), limits_);
  if (!why.empty()) throw InputError(AnswerCode::kLimitsInfeasible, "trajectory: " + why);

  const auto started = executor_.replace([&](const MotionState& state) { return motionThrough(points, state); });
  const JointTrajectory& main = started.motion->main();
  const std::string message = announce(started, toMessage(*robot_.chain, points, main.duration()));
  announceMetrics(metricsOf(robot_.chain, main, limits_, points.back().position));
  return {AnswerCode::kSuccess, message};
}

/// What to know of a motion that is about to start.
std::string TrajectoryGenerator::paceNote() const {
  if (executor_.paused()) return "paused: it starts at ~resume";
  const double speed = executor_.speed();
  if (speed == 0.0) return std::string("it waits for a ") + kSpeedTopic + " above 0";
  return speed < 1.0 ? "at " + numberText(speed) + " of its speed" : "";
}

void TrajectoryGenerator::announceMetrics(const TrajectoryMetrics& metrics) {
  const std::lock_guard<std::mutex> lock(metrics_mutex_);
  metrics_ = metrics;
  sinks_.metrics(metrics);
}

/// With the metrics again at a motion's end where a controlled robot followed it.
void TrajectoryGenerator::stream(const StreamSample& sample) {
  streams_.publish(sample);
  reporter_.take(sample);
  if (!sample.last) return;
  const TrackingError errors = reporter_.tracking();
  if (!errors.any()) return;
  const std::lock_guard<std::mutex> lock(metrics_mutex_);
  if (metrics_.joint_names.empty()) return;
  metrics_.tracking_error_max = errors.peak();
  metrics_.tracking_error_rms = errors.rms();
  sinks_.metrics(metrics_);
}

void TrajectoryGenerator::track(const sensor_msgs::JointState& measured) {
  const auto due = executor_.stateInMotion(static_cast<Nanoseconds>(measured.header.stamp.toNSec()));
  if (due) reporter_.track(measured, due->position);
}

Outcome TrajectoryGenerator::execute(const ExecuteTrajectory::Request& request, ExecuteTrajectory::Response&) {
  const std::lock_guard<std::mutex> lock(executing_);
  if (!request.trajectory.points.empty()) return executeGiven(request.trajectory);
  const auto planned = lastPlanned();
  if (planned != nullptr) return executePlanned(*planned);
  throw InputError(AnswerCode::kInvalidGoal, "trajectory.points has 0 entries, and nothing is planned yet");
}

Outcome TrajectoryGenerator::stop() {
  const std::lock_guard<std::mutex> lock(executing_);
  const auto started = executor_.replace([&](const MotionState& present) { return Motion(stopFrom(present, limits_)); },
                                         MotionExecutor::Pace::kRealTime);
  const double duration = started.motion->duration();
  if (duration == 0.0) return {AnswerCode::kSuccess, "the robot is at rest"};
  std::string message = "at rest in " + numberText(duration) + " s";
  if (!keepsPositions(started.motion->main(), limits_)) message += ", past a position limit: it was too near to brake";
  return {AnswerCode::kSuccess, message};
}

Outcome TrajectoryGenerator::pause() {
  const bool before = executor_.paused();
  const MotionExecutor::Turn turn = executor_.pause();
  if (before) return {AnswerCode::kSuccess, "paused already"};
  if (!turn.moving) return {AnswerCode::kSuccess, "nothing moves; what is executed starts at ~resume"};
  const std::string seconds = numberText(turn.settles_in) + " s";
  if (turn.ends_first)
    return {AnswerCode::kSuccess, "the motion ends in " + seconds + ", there is no room to pause before"};
  return {AnswerCode::kSuccess, "at rest on its path in " + seconds};
}

Outcome TrajectoryGenerator::resume() {
  if (!executor_.paused()) return {AnswerCode::kSuccess, "nothing is paused"};
  const MotionExecutor::Turn turn = executor_.resume();
  if (!turn.moving) return {AnswerCode::kSuccess, "nothing moves; what is executed starts at once"};
  if (executor_.speed() == 0.0) return {AnswerCode::kSuccess, paceNote()};
  return {AnswerCode::kSuccess, "at its speed in " + numberText(turn.settles_in) + " s"};
}

Outcome TrajectoryGenerator::setSpeed(double speed) {
  requireFinite(speed, kSpeedTopic);
  if (speed < 0.0 || speed > 1.0) {
    throw InputError(AnswerCode::kInvalidGoal,
                     std::string(kSpeedTopic) + " is " + numberText(speed) + ", it must be from 0 to 1");
  }
  executor_.setSpeed(speed);
  return {};
}

}  // namespace ros_bridge
}  // namespace screwline
