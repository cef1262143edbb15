#ifndef SCREWLINE_ROS_TRAJECTORY_PLANNER_H
#define SCREWLINE_ROS_TRAJECTORY_PLANNER_H

#include <memory>
#include <string>
#include <vector>

#include "screwline/ik/inverse_kinematics.h"
#include "screwline/ros/frame_resolver.h"
#include "screwline/ros/robot_loader.h"
#include "screwline/ros/service_adapter.h"
#include "screwline/ros/trajectory_messages.h"
#include "screwline/trajectory/plan.h"

namespace screwline {
namespace ros_bridge {

/// What ~execute needs of a plan.
struct PlannedMotion {
  JointTrajectory trajectory;
  trajectory_msgs::JointTrajectory message;
  TrajectoryMetrics metrics;
};

/// Answers ~plan: the request's waypoints in joint space, the core's plan, its answer. Many threads may call it.
class TrajectoryPlanner {
 public:
  TrajectoryPlanner(ServedRobot robot, double ik_timeout, FrameLookup lookup);

  /// Fills the response and `planned`. `present` is where the robot is: the first pose is solved near to it.
  /// @throws InputError naming what is wrong in the request.
  Outcome plan(const PlanTrajectory::Request& request, const VectorX& present, PlanTrajectory::Response& response,
               PlannedMotion& planned) const;

  /// The request in chain order, poses solved. `notes` gets what its reader should know. @throws InputError
  PlanRequest toPlanRequest(const PlanTrajectory::Request& request, const VectorX& present,
                            std::vector<std::string>& notes) const;

 private:
  struct PoseSeed;

  Limits limitsOfRequest(const PlanTrajectory::Request& request) const;
  VectorX values(const PlanTrajectory::Request& request, const std::vector<double>& given,
                 const std::string& field) const;
  void requireWithinLimits(const VectorX& position, const std::string& field) const;
  Pose poseOf(const Waypoint& waypoint, const std::string& field) const;
  VectorX solve(const Waypoint& waypoint, const std::string& field, PoseSeed& seed,
                std::vector<std::string>& notes) const;
  IkResult ask(const IkRequest& question, const std::string& field) const;
  void noteAssumedLimits(const PlanTrajectory::Request& request, std::vector<std::string>& notes) const;
  void fillViaErrors(const PlanResult& result, PlanTrajectory::Response& response,
                     std::vector<std::string>& notes) const;

  ServedRobot robot_;
  double ik_timeout_;
  FrameResolver frames_;
  InverseKinematics solver_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_TRAJECTORY_PLANNER_H
