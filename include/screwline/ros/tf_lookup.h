#ifndef SCREWLINE_ROS_TF_LOOKUP_H
#define SCREWLINE_ROS_TF_LOOKUP_H

#include <string>

#include "screwline/ros/frame_resolver.h"

namespace screwline {
namespace ros_bridge {

/// Listens to tf2 from now on; the lookup gives a frame's latest pose in base_link. It waits up to `timeout` [s] of
/// wall time (a simulated clock may stand still) for a frame that is not known yet. Needs ros::init().
FrameLookup tfLookup(const std::string& base_link, double timeout = 0.25);

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_TF_LOOKUP_H
