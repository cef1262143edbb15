#include "screwline/ros/frame_broadcaster.h"

#include <cmath>
#include <utility>

#include "screwline/kinematics/forward.h"
#include "screwline/ros/checks.h"
#include "screwline/ros/conversions.h"
#include "screwline/ros/joint_values.h"
#include "screwline/ros/markers.h"

namespace screwline {
namespace ros_bridge {
namespace {

// Shares of the chain's characteristic length.
constexpr double kPathSpacing = 0.005;
constexpr double kPathWidth = 0.008;

double distance(const geometry_msgs::Point& a, const geometry_msgs::Point& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

}  // namespace

FrameBroadcaster::FrameBroadcaster(const ServedRobot& robot, const std::vector<std::string>& links,
                                   const BroadcasterParams& params, BroadcasterSinks sinks)
    : robot_(robot),
      params_(params),
      sinks_(std::move(sinks)),
      frames_(robot_.chain, params_.frame_prefix, links),
      tracker_(robot_.chain) {}

void FrameBroadcaster::start(const ros::Time& now) {
  sinks_.constant_transform(toTransform(frames_.constant(), now));
}

void FrameBroadcaster::onJointState(const sensor_msgs::JointState& state, const ros::Time& now) {
  if (!tracker_.update(state)) return;
  const ros::Time stamp = state.header.stamp.isZero() ? now : state.header.stamp;
  if (!advanceTo(stamp)) return;

  std::vector<ChildFrame> frames = frames_.at(tracker_.positions());
  extendPath(frames.back().pose.p);
  if (target_) frames.push_back(*target_);
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const ChildFrame& frame : frames) transforms.push_back(toTransform(frame, stamp));
  sinks_.transforms(transforms);
  if (markersDue(stamp)) sendMarkers(stamp);
}

void FrameBroadcaster::onTrajectory(const trajectory_msgs::JointTrajectory& trajectory) {
  if (trajectory.points.empty()) {
    target_.reset();
    return;
  }
  const VectorX goal = jointValues(*robot_.chain, trajectory.joint_names, trajectory.points.back().positions,
                                   "joint_trajectory.joint_names", "the last point's positions");
  target_ = ChildFrame{robot_.chain->baseLink(), frames_.targetName(), forwardKinematics(*robot_.chain, goal)};
}

void FrameBroadcaster::onTarget(const geometry_msgs::PoseStamped& target) {
  const std::string& given = target.header.frame_id;
  if (given == frames_.targetName() || (!given.empty() && given.front() == '/')) {
    throw InputError(AnswerCode::kFrameTransformFailure,
                     "target.header.frame_id is " + quoted(given) + ", it must be another frame, and not start with /");
  }
  target_ = ChildFrame{given.empty() ? robot_.chain->baseLink() : given, frames_.targetName(),
                       fromPose(target.pose, "target.pose")};
}

bool FrameBroadcaster::advanceTo(const ros::Time& stamp) {
  if (last_stamp_ && stamp <= *last_stamp_) {
    if ((*last_stamp_ - stamp).toSec() <= kTimeJump) return false;
    path_.clear();
    next_markers_.reset();
  }
  last_stamp_ = stamp;
  return true;
}

void FrameBroadcaster::extendPath(const Vector3& tool) {
  const geometry_msgs::Point point = toPoint(tool);
  const double spacing = kPathSpacing * robot_.chain->characteristicLength();
  if (!path_.empty() && distance(point, path_.back()) < spacing) return;
  path_.push_back(point);
  if (path_.size() > static_cast<std::size_t>(params_.markers.path_points)) path_.pop_front();
}

bool FrameBroadcaster::markersDue(const ros::Time& stamp) {
  if (next_markers_ && stamp < *next_markers_) return false;
  const ros::Duration period(1.0 / params_.markers.rate);
  // In step with what was due, so that jitter of the stamps does not lower the rate; afresh after a pause.
  const bool in_step = next_markers_ && stamp < *next_markers_ + period;
  next_markers_ = (in_step ? *next_markers_ : stamp) + period;
  return true;
}

void FrameBroadcaster::sendMarkers(const ros::Time& stamp) {
  const SerialChain& chain = *robot_.chain;
  visualization_msgs::MarkerArray array;
  array.markers = configurationMarkers(chain, robot_.task, tracker_.positions(), params_.markers);
  array.markers.push_back(toolPathMarker({path_.begin(), path_.end()}, kPathWidth * chain.characteristicLength()));
  for (visualization_msgs::Marker& marker : array.markers) {
    marker.header.frame_id = chain.baseLink();
    marker.header.stamp = stamp;
  }
  sinks_.markers(array);
}

}  // namespace ros_bridge
}  // namespace screwline
