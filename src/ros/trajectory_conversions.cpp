#include "screwline/ros/trajectory_conversions.h"

#include <string>
#include <utility>

#include "screwline/kinematics/jacobian.h"
#include "screwline/ros/checks.h"
#include "screwline/ros/conversions.h"
#include "screwline/ros/joint_values.h"

namespace screwline {

ros_bridge::Allowed allowed(const PlanTrajectory::Response& response, const double* number) {
  using ros_bridge::lies;
  const TrajectoryMetrics& metrics = response.metrics;
  const bool infinite = lies(number, metrics.peak_acceleration) || lies(number, metrics.peak_jerk) ||
                        lies(number, metrics.rms_acceleration) || lies(number, metrics.jerk_integral) ||
                        number == &metrics.energy;
  return infinite ? ros_bridge::Allowed::kInfinity : ros_bridge::Allowed::kFinite;
}

namespace ros_bridge {
namespace {

constexpr double kLeadPeriod = 0.01;  // s between the points of a lead

std::string pointField(std::size_t i, const char* field) {
  return "trajectory.points[" + std::to_string(i) + "]." + field;
}

VectorX valuesOrNone(const SerialChain& chain, const trajectory_msgs::JointTrajectory& message,
                     const std::vector<double>& values, const std::string& field) {
  if (values.empty()) return VectorX();
  return jointValues(chain, message.joint_names, values, "trajectory.joint_names", field);
}

trajectory_msgs::JointTrajectoryPoint toMessage(const TrajectoryPoint& point, double time) {
  trajectory_msgs::JointTrajectoryPoint message;
  message.positions = arrayOf(point.position);
  message.velocities = arrayOf(point.velocity);
  message.accelerations = arrayOf(point.acceleration);
  message.time_from_start = ros::Duration(time);
  return message;
}

trajectory_msgs::JointTrajectory emptyMessage(const SerialChain& chain) {
  trajectory_msgs::JointTrajectory message;
  message.header.frame_id = chain.baseLink();
  message.joint_names = chain.jointNames();
  return message;
}

}  // namespace

Limits limitsOf(const SerialChain& chain) {
  Limits limits = Limits::unlimited(chain.size());
  for (int j = 0; j < chain.size(); ++j) {
    const JointLimits& joint = chain.joint(j).limits;
    limits.velocity[j] = joint.velocity;
    limits.acceleration[j] = joint.acceleration;
    limits.jerk[j] = joint.jerk;
  }
  limits.lower = chain.lower();
  limits.upper = chain.upper();
  return limits;
}

std::vector<SampledPoint> toPoints(const SerialChain& chain, const trajectory_msgs::JointTrajectory& message) {
  requireCount(message.points.size(), kMostPoints, "trajectory.points");
  std::vector<SampledPoint> points;
  points.reserve(message.points.size());
  for (std::size_t i = 0; i < message.points.size(); ++i) {
    const trajectory_msgs::JointTrajectoryPoint& given = message.points[i];
    SampledPoint point;
    point.position =
        jointValues(chain, message.joint_names, given.positions, "trajectory.joint_names", pointField(i, "positions"));
    point.velocity = valuesOrNone(chain, message, given.velocities, pointField(i, "velocities"));
    point.acceleration = valuesOrNone(chain, message, given.accelerations, pointField(i, "accelerations"));
    point.time = given.time_from_start.toSec();
    points.push_back(std::move(point));
  }
  return points;
}

trajectory_msgs::JointTrajectory toMessage(const SerialChain& chain, const std::vector<SampledPoint>& points,
                                           double duration) {
  trajectory_msgs::JointTrajectory message = emptyMessage(chain);
  const double shift = duration - points.back().time;
  for (const SampledPoint& point : points) {
    trajectory_msgs::JointTrajectoryPoint entry;
    entry.positions = arrayOf(point.position);
    entry.velocities = arrayOf(point.velocity);
    entry.accelerations = arrayOf(point.acceleration);
    entry.time_from_start = ros::Duration(point.time + shift);
    message.points.push_back(std::move(entry));
  }
  return message;
}

SampledTrajectory sampled(const SerialChain& chain, const JointTrajectory& trajectory, double period) {
  SampledTrajectory result;
  result.message = emptyMessage(chain);
  result.times = sampleTimes(trajectory, period);
  result.message.points.reserve(result.times.size());
  result.jerks.reserve(result.times.size() * static_cast<std::size_t>(chain.size()));
  TrajectoryPoint point(chain.size());
  for (const double time : result.times) {
    trajectory.sample(time, point);
    result.message.points.push_back(toMessage(point, time));
    result.jerks.insert(result.jerks.end(), point.jerk.data(), point.jerk.data() + point.jerk.size());
  }
  return result;
}

trajectory_msgs::JointTrajectory withLead(const SerialChain& chain, const Motion& motion,
                                          const trajectory_msgs::JointTrajectory& main) {
  if (motion.lead().duration() == 0.0) return main;
  trajectory_msgs::JointTrajectory all = sampled(chain, motion.lead(), kLeadPeriod).message;
  all.points.pop_back();  // The first of what follows.
  const bool velocities = !main.points.empty() && !main.points.front().velocities.empty();
  const bool accelerations = velocities && !main.points.front().accelerations.empty();
  for (trajectory_msgs::JointTrajectoryPoint& point : all.points) {
    if (!velocities) point.velocities.clear();
    if (!accelerations) point.accelerations.clear();
  }
  for (trajectory_msgs::JointTrajectoryPoint point : main.points) {
    point.time_from_start += ros::Duration(motion.lead().duration());
    all.points.push_back(std::move(point));
  }
  return all;
}

TrajectoryMetrics metricsOf(const std::shared_ptr<const SerialChain>& chain, const JointTrajectory& trajectory,
                            const Limits& limits, const VectorX& goal) {
  const JointMetrics joints = jointMetrics(trajectory, limits, goal);
  const ToolMetrics tool = toolMetrics(trajectory, toolKinematics(chain));
  TrajectoryMetrics message;
  message.joint_names = chain->jointNames();
  message.peak_velocity = arrayOf(joints.peak_velocity);
  message.peak_acceleration = arrayOf(joints.peak_acceleration);
  message.peak_jerk = arrayOf(joints.peak_jerk);
  message.rms_acceleration = arrayOf(joints.rms_acceleration);
  message.jerk_integral = arrayOf(joints.jerk_integral);
  message.travel = arrayOf(joints.travel);
  message.limit_ratio = arrayOf(joints.limit_ratio);
  message.path_length = tool.path_length;
  message.max_curvature = tool.max_curvature;
  message.peak_speed = tool.peak_speed;
  message.energy = joints.energy;
  message.goal_error = joints.goal_error;
  return message;
}

ToolKinematics toolKinematics(const std::shared_ptr<const SerialChain>& chain) {
  constexpr double kStep = 1e-5;  // rad or m of the joint that moves fastest
  return [chain, J = Matrix6X(6, chain->size()), around = Matrix6X(6, chain->size()),
          q = VectorX(chain->size())](const TrajectoryPoint& state) mutable {
    const Pose X_BT = geometricJacobian(*chain, state.position, J);
    ToolMotion motion{X_BT.p, J.topRows<3>() * state.velocity, J.topRows<3>() * state.acceleration};
    const double speed = state.velocity.cwiseAbs().maxCoeff();
    if (speed == 0.0) return motion;
    const double h = kStep / speed;  // s
    for (const double sign : {1.0, -1.0}) {
      q = state.position + sign * h * state.velocity;
      geometricJacobian(*chain, q, around);
      motion.acceleration += sign / (2.0 * h) * (around.topRows<3>() * state.velocity);
    }
    return motion;
  };
}

}  // namespace ros_bridge
}  // namespace screwline
