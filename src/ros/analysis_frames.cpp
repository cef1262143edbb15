#include "screwline/ros/analysis_frames.h"

#include <algorithm>
#include <utility>

#include "../model/urdf_document.h"
#include "screwline/exception.h"
#include "screwline/kinematics/forward.h"
#include "screwline/ros/checks.h"
#include "screwline/ros/conversions.h"

namespace screwline {
namespace ros_bridge {

geometry_msgs::TransformStamped toTransform(const ChildFrame& frame, const ros::Time& stamp) {
  const geometry_msgs::Pose pose = toPose(frame.pose);
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = frame.parent;
  message.child_frame_id = frame.name;
  message.transform.translation.x = pose.position.x;
  message.transform.translation.y = pose.position.y;
  message.transform.translation.z = pose.position.z;
  message.transform.rotation = pose.orientation;
  return message;
}

std::vector<std::string> linkNames(const std::string& urdf_xml) {
  return parseUrdf(urdf_xml).links;
}

AnalysisFrames::AnalysisFrames(std::shared_ptr<const SerialChain> chain, const std::string& prefix,
                               const std::vector<std::string>& taken)
    : chain_(std::move(chain)), tool_name_(prefix + "tool"), target_name_(prefix + "target") {
  for (std::size_t i = 0; i <= chain_->axes().size(); ++i) dh_names_.push_back(prefix + "dh_" + std::to_string(i));
  std::vector<std::string> names = dh_names_;
  names.push_back(tool_name_);
  names.push_back(target_name_);
  for (const std::string& name : names) {
    if (std::find(taken.begin(), taken.end(), name) == taken.end()) continue;
    throw ModelError("frame " + quoted(name) + " is a link of the robot description; give another ~frame_prefix than " +
                     quoted(prefix));
  }
}

ChildFrame AnalysisFrames::constant() const {
  return {chain_->baseLink(), dh_names_.front(), chain_->modifiedDh().base_transform};
}

std::vector<ChildFrame> AnalysisFrames::at(const ConstVectorRef& q) const {
  const std::vector<Axis>& axes = chain_->axes();
  std::vector<ChildFrame> frames;
  frames.reserve(axes.size() + 1);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double displacement = axes[i].multiplier * q[axes[i].source];
    const int row = static_cast<int>(i) + 1;
    frames.push_back({dh_names_[i], dh_names_[i + 1], chain_->modifiedDh().link(row, axes[i].prismatic, displacement)});
  }
  frames.push_back({chain_->baseLink(), tool_name_, forwardKinematics(*chain_, q)});
  return frames;
}

}  // namespace ros_bridge
}  // namespace screwline
