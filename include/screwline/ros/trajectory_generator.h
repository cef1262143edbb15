#ifndef SCREWLINE_ROS_TRAJECTORY_GENERATOR_H
#define SCREWLINE_ROS_TRAJECTORY_GENERATOR_H

#include <ros/node_handle.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "screwline/ros/motion_executor.h"
#include "screwline/ros/stream_reporter.h"
#include "screwline/ros/trajectory_params.h"
#include "screwline/ros/trajectory_planner.h"
#include "screwline/ros/trajectory_streams.h"
#include "screwline/trajectory/points.h"

namespace screwline {
namespace ros_bridge {

/// Plans and streams the motion of one robot: see PlanTrajectory.srv. Needs no master until advertise(). Every service
/// may be called from many threads; each fills the response and returns how it ended, or throws InputError.
class TrajectoryGenerator {
 public:
  /// @throws ModelError: an initial position that is not one of the robot's.
  TrajectoryGenerator(ServedRobot robot, const TrajectoryParams& params, FrameLookup lookup, MotionClock clock,
                      const GeneratorSinks& sinks);

  /// Offers the services in a private namespace for as long as this lives.
  /// And listens to the speed in the public one, and to the states of a controlled robot where a topic is given.
  void advertise(ros::NodeHandle& private_node, ros::NodeHandle& node);

  MotionExecutor& executor() { return executor_; }

  Outcome plan(const PlanTrajectory::Request& request, PlanTrajectory::Response& response);
  Outcome execute(const ExecuteTrajectory::Request& request, ExecuteTrajectory::Response& response);
  Outcome stop();
  Outcome pause();
  Outcome resume();
  /// Speed at which paths are followed, 0 to 1. @throws InputError outside of it.
  Outcome setSpeed(double speed);
  /// A state of the controlled robot: compared with what was due at its stamp. @throws InputError (kInvalidRobotState)
  void track(const sensor_msgs::JointState& measured);
  Outcome listProfiles(const ListProfiles::Request& request, ListProfiles::Response& response) const;

 private:
  std::shared_ptr<const PlannedMotion> lastPlanned() const;
  Outcome executePlanned(const PlannedMotion& planned);
  Outcome executeGiven(const trajectory_msgs::JointTrajectory& trajectory);
  Motion motionThrough(const std::vector<SampledPoint>& points, const MotionState& present) const;
  void stream(const StreamSample& sample);
  void announceMetrics(const TrajectoryMetrics& metrics);
  std::string paceNote() const;
  std::string announce(const MotionExecutor::Started& started, const trajectory_msgs::JointTrajectory& points);

  ServedRobot robot_;
  Limits limits_;
  GeneratorSinks sinks_;
  TrajectoryPlanner planner_;
  TrajectoryStreams streams_;
  StreamReporter reporter_;
  std::string tracked_topic_;
  std::mutex metrics_mutex_;
  TrajectoryMetrics metrics_;  ///< Of the motion that runs.
  mutable std::mutex planned_mutex_;
  std::shared_ptr<const PlannedMotion> planned_;
  std::mutex executing_;  ///< What is announced comes in the order of what is executed.
  MotionExecutor executor_;
  std::vector<ros::ServiceServer> services_;
  ros::Subscriber speed_;
  ros::Subscriber tracked_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_TRAJECTORY_GENERATOR_H
