#include "screwline/ros/trajectory_planner.h"

#include <algorithm>

#include "screwline/kinematics/forward.h"
#include "screwline/ros/checks.h"
#include "screwline/ros/conversions.h"
#include "screwline/ros/trajectory_conversions.h"
#include "screwline/spatial/rotation.h"
#include "screwline/trajectory/profile.h"

namespace screwline {
namespace ros_bridge {
namespace {

constexpr double kMet = 1e-9;  // rad or m: a via that is missed by less is met

std::string joined(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += (text.empty() ? "" : "; ") + note;
  return text;
}

double orOne(double scaling) {
  return scaling == 0.0 ? 1.0 : scaling;
}

TimeScaling scalingOf(const JointTrajectory& trajectory, const std::vector<double>& times) {
  TimeScaling message;
  if (trajectory.scaling() == nullptr) return message;
  for (const double time : times) {
    const double tau = trajectory.duration() > 0.0 ? std::min(1.0, time / trajectory.duration()) : 1.0;
    const ScalingSample at = trajectory.scaling()->at(tau);
    message.tau.push_back(tau);
    message.s.push_back(at.s);
    message.ds.push_back(at.ds);
    message.dds.push_back(at.dds);
    message.ddds.push_back(at.ddds);
  }
  return message;
}

VectorX goalOf(const PlanResult& result) {
  if (result.waypoints.size() >= 2) return result.waypoints.back();
  TrajectoryPoint end(result.trajectory.joints());
  result.trajectory.sample(result.trajectory.duration(), end);
  return end.position;
}

}  // namespace

TrajectoryPlanner::TrajectoryPlanner(ServedRobot robot, double ik_timeout, FrameLookup lookup)
    : robot_(std::move(robot)),
      ik_timeout_(ik_timeout),
      frames_(robot_.chain, std::move(lookup)),
      solver_(*robot_.chain, robot_.task) {}

void TrajectoryPlanner::noteAssumedLimits(const PlanTrajectory::Request& request,
                                          std::vector<std::string>& notes) const {
  const auto note = [&](const std::vector<double>& given, bool JointLimits::*assumed, const std::string& order) {
    std::string names;
    for (const Joint& joint : robot_.chain->joints()) {
      if (given.empty() && joint.limits.*assumed) names += (names.empty() ? "" : ", ") + joint.name;
    }
    if (!names.empty()) notes.push_back(order + " limits are assumed: " + names);
  };
  note(request.velocity_limits, &JointLimits::velocity_assumed, "velocity");
  note(request.acceleration_limits, &JointLimits::acceleration_assumed, "acceleration");
  note(request.jerk_limits, &JointLimits::jerk_assumed, "jerk");
}

void TrajectoryPlanner::fillViaErrors(const PlanResult& result, PlanTrajectory::Response& response,
                                      std::vector<std::string>& notes) const {
  const SerialChain& chain = *robot_.chain;
  const MatrixX errors = result.via_joint_errors.cwiseAbs();
  response.via_joint_errors = rowMajor(errors);
  Eigen::Index missed = 0;
  for (Eigen::Index i = 0; i < errors.rows(); ++i) {
    const VectorX& wanted = result.waypoints[static_cast<std::size_t>(i) + 1];
    const Pose target = forwardKinematics(chain, wanted);
    const Pose met = forwardKinematics(chain, wanted + result.via_joint_errors.row(i).transpose());
    response.via_position_errors.push_back((met.p - target.p).norm());
    response.via_orientation_errors.push_back(rotationAngle(met.R * target.R.transpose()));
    if (errors.row(i).maxCoeff() > kMet) ++missed;
  }
  if (missed == 0) return;
  Eigen::Index worst = 0;
  Eigen::Index joint = 0;
  const double most = errors.maxCoeff(&worst, &joint);
  const std::size_t via = static_cast<std::size_t>(worst);
  notes.push_back(std::to_string(missed) + " of " + std::to_string(errors.rows()) +
                  " vias missed; the worst, waypoints[" + std::to_string(via + 1) + "], by " + numberText(most) +
                  " in joint " + quoted(chain.joint(static_cast<int>(joint)).name) + ", by " +
                  numberText(response.via_position_errors[via]) + " m and " +
                  numberText(response.via_orientation_errors[via]) + " rad at the tip");
}

Outcome TrajectoryPlanner::plan(const PlanTrajectory::Request& request, const VectorX& present,
                                PlanTrajectory::Response& response, PlannedMotion& planned) const {
  findProfile(request.profile);
  std::vector<std::string> notes;
  const PlanRequest question = toPlanRequest(request, present, notes);
  PlanResult result = screwline::plan(question);
  notes.insert(notes.end(), result.notes.begin(), result.notes.end());
  noteAssumedLimits(request, notes);

  SampledTrajectory samples = sampled(*robot_.chain, result.trajectory, result.sample_period);
  response.joint_names = robot_.chain->jointNames();
  response.duration = result.trajectory.duration();
  response.trajectory = std::move(samples.message);
  response.jerks = std::move(samples.jerks);
  response.time_scaling = scalingOf(result.trajectory, samples.times);
  fillViaErrors(result, response, notes);
  const Limits limits = scaledLimits(question.limits, orOne(question.velocity_scaling),
                                     orOne(question.acceleration_scaling), orOne(question.jerk_scaling));
  response.metrics = metricsOf(robot_.chain, result.trajectory, limits, goalOf(result));
  planned = {std::move(result.trajectory), response.trajectory, response.metrics};
  return {AnswerCode::kSuccess, joined(notes)};
}

}  // namespace ros_bridge
}  // namespace screwline
