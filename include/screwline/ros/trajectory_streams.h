#ifndef SCREWLINE_ROS_TRAJECTORY_STREAMS_H
#define SCREWLINE_ROS_TRAJECTORY_STREAMS_H

#include <diagnostic_msgs/DiagnosticArray.h>

#include <functional>
#include <memory>

#include "screwline/model/serial_chain.h"
#include "screwline/ros/motion_executor.h"
#include "screwline/ros/trajectory_messages.h"

namespace screwline {
namespace ros_bridge {

/// Where what trajectory_generator says goes: its publishers, or a test.
struct GeneratorSinks {
  std::function<void(const trajectory_msgs::JointTrajectory&)> trajectory;
  std::function<void(const TrajectoryMetrics&)> metrics;
  std::function<void(const sensor_msgs::JointState&)> state;
  std::function<void(const TimeScaling&)> scaling;
  std::function<void(const geometry_msgs::PoseStamped&)> pose;
  std::function<void(const geometry_msgs::TwistStamped&)> twist;
  std::function<void(const diagnostic_msgs::DiagnosticArray&)> diagnostics;
};

/// Samples as messages. Every field has its size from the start on: publish() does not allocate. From one thread.
class TrajectoryStreams {
 public:
  TrajectoryStreams(std::shared_ptr<const SerialChain> chain, GeneratorSinks sinks);

  /// One message on each streamed topic, all with the sample's stamp. A sample that is not finite is not sent.
  void publish(const StreamSample& sample);

 private:
  void fillScaling(const StreamSample& sample);
  void fillTool(const TrajectoryPoint& state);

  std::shared_ptr<const SerialChain> chain_;
  GeneratorSinks sinks_;
  Matrix6X J_;
  sensor_msgs::JointState state_;
  TimeScaling scaling_;
  geometry_msgs::PoseStamped pose_;
  geometry_msgs::TwistStamped twist_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_TRAJECTORY_STREAMS_H
