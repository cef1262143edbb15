#ifndef SCREWLINE_ROS_ANALYSIS_FRAMES_H
#define SCREWLINE_ROS_ANALYSIS_FRAMES_H

#include <geometry_msgs/TransformStamped.h>

#include <memory>
#include <string>
#include <vector>

#include "screwline/model/serial_chain.h"

namespace screwline {
namespace ros_bridge {

/// A frame on its way to tf2: the pose of `name` in `parent`.
struct ChildFrame {
  std::string parent;
  std::string name;
  Pose pose;
};

geometry_msgs::TransformStamped toTransform(const ChildFrame& frame, const ros::Time& stamp);

/// Names of all links of a robot description, those beside the chain included. @throws ModelError where it is
/// malformed.
std::vector<std::string> linkNames(const std::string& urdf_xml);

/// The frames in which a chain is analysed, and their names: <prefix>dh_0 in the base link, where it stays;
/// <prefix>dh_i in <prefix>dh_{i-1}, one for each row of the modified-DH table, z along axis i; <prefix>tool in the
/// base link, the pose that forward kinematics gives of the tip; <prefix>target, wherever that is.
class AnalysisFrames {
 public:
  /// `taken` names the frames that robot_state_publisher owns. @throws ModelError where a name is one of them.
  AnalysisFrames(std::shared_ptr<const SerialChain> chain, const std::string& prefix,
                 const std::vector<std::string>& taken);

  /// dh_0.
  ChildFrame constant() const;
  /// dh_1 to dh_n and the tool. @pre q has chain.size() finite values.
  std::vector<ChildFrame> at(const ConstVectorRef& q) const;

  const std::string& targetName() const { return target_name_; }

 private:
  std::shared_ptr<const SerialChain> chain_;
  std::vector<std::string> dh_names_;
  std::string tool_name_;
  std::string target_name_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_ANALYSIS_FRAMES_H
