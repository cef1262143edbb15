#ifndef SCREWLINE_ROS_FRAME_BROADCASTER_H
#define SCREWLINE_ROS_FRAME_BROADCASTER_H

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <visualization_msgs/MarkerArray.h>

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "screwline/ros/analysis_frames.h"
#include "screwline/ros/frame_broadcaster_params.h"
#include "screwline/ros/joint_state_tracker.h"
#include "screwline/ros/robot_loader.h"

namespace screwline {
namespace ros_bridge {

/// Where the broadcaster's output goes: tf_static, tf, the marker topic.
struct BroadcasterSinks {
  std::function<void(const geometry_msgs::TransformStamped&)> constant_transform;
  std::function<void(const std::vector<geometry_msgs::TransformStamped>&)> transforms;
  std::function<void(const visualization_msgs::MarkerArray&)> markers;
};

/// The node's logic, without a master: joint states in, analysis frames and markers out, in the joint states' own time
/// (so that a replayed bag does as the robot did). A stamp that is not newer than the one before is passed over; a jump
/// back by more than kTimeJump starts anew. Not thread-safe.
class FrameBroadcaster {
 public:
  static constexpr double kTimeJump = 0.5;  ///< [s]

  /// `links` are all of the robot description. @throws ModelError where a frame would have the name of one of them.
  FrameBroadcaster(const ServedRobot& robot, const std::vector<std::string>& links, const BroadcasterParams& params,
                   BroadcasterSinks sinks);

  /// Sends what never changes.
  void start(const ros::Time& now);

  /// Sends the frames at the message's stamp (`now` where it has none), and markers where they are due.
  /// @throws InputError as JointStateTracker::update().
  void onJointState(const sensor_msgs::JointState& state, const ros::Time& now);

  /// The end of the trajectory becomes the target; one without points ends the target.
  /// @throws InputError where its joints or last point do not fit the chain.
  void onTrajectory(const trajectory_msgs::JointTrajectory& trajectory);

  /// A target in any frame; none given: the base link. @throws InputError where the pose or its frame is no good.
  void onTarget(const geometry_msgs::PoseStamped& target);

 private:
  /// Whether a message of this stamp is to be broadcast; starts anew after a jump back.
  bool advanceTo(const ros::Time& stamp);
  void extendPath(const Vector3& tool);
  bool markersDue(const ros::Time& stamp);
  void sendMarkers(const ros::Time& stamp);

  ServedRobot robot_;
  BroadcasterParams params_;
  BroadcasterSinks sinks_;
  AnalysisFrames frames_;
  JointStateTracker tracker_;
  std::optional<ChildFrame> target_;
  std::optional<ros::Time> last_stamp_;
  std::optional<ros::Time> next_markers_;
  std::deque<geometry_msgs::Point> path_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_FRAME_BROADCASTER_H
