#ifndef SCREWLINE_ROS_MARKERS_H
#define SCREWLINE_ROS_MARKERS_H

#include <geometry_msgs/Point.h>
#include <visualization_msgs/Marker.h>

#include <vector>

#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"
#include "screwline/ros/frame_broadcaster_params.h"

namespace screwline {
namespace ros_bridge {

// What rviz draws of a chain at a configuration, without a master: markers in the base link's frame; frame_id and stamp
// are left to the caller. A marker that has nothing to show has the action DELETE, so that a namespace and an id always
// mean the same thing.

constexpr char kScrewAxesMarkers[] = "screw_axes";
constexpr char kManipulabilityMarkers[] = "manipulability";
constexpr char kLostDirectionMarkers[] = "lost_directions";
constexpr char kToolPathMarkers[] = "tool_path";

/// Two markers per axis of the chain, ids 2 i and 2 i + 1. Revolute: an arrow along the axis through its point, and a
/// ring about it. Prismatic: two arrows from its point, one each way.
std::vector<visualization_msgs::Marker> screwAxisMarkers(const SerialChain& chain, const ConstVectorRef& q);

/// Translational manipulability ellipsoid at the tool: half axes are the singular values of the linear rows of J (6 x
/// n, base frame) times scale [s], at least `thinnest` [m] (Yoshikawa 1985).
visualization_msgs::Marker manipulabilityMarker(const Matrix6X& J, const Vector3& tool, double scale, double thinnest);

/// Directions of the task's rows of J whose singular value is at or below `near_singular` of the largest: at the tool
/// a double arrow of the linear part (ids 4 k, 4 k + 1) and one along the angular part (4 k + 2, 4 k + 3), up to
/// `length` [m] each way, paler the farther from singular. Always 24 markers.
std::vector<visualization_msgs::Marker> lostDirectionMarkers(const Task& task, const Matrix6X& J, const Pose& tool,
                                                             double near_singular, double length);

/// A line through points, oldest first.
visualization_msgs::Marker toolPathMarker(const std::vector<geometry_msgs::Point>& points, double width);

/// All but the tool's path, sized to the chain.
std::vector<visualization_msgs::Marker> configurationMarkers(const SerialChain& chain, const Task& task,
                                                             const ConstVectorRef& q, const MarkerParams& params);

geometry_msgs::Point toPoint(const Vector3& point);

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_MARKERS_H
