#include "screwline/ros/frame_broadcaster_params.h"

#include "screwline/exception.h"

namespace screwline {
namespace ros_bridge {
namespace {

constexpr double kFastestMarkers = 1000.0;  // Hz
constexpr double kLargestScale = 1000.0;    // s
constexpr int kLongestPath = 100000;

}  // namespace

BroadcasterParams readBroadcasterParams(const XmlRpc::XmlRpcValue& private_params) {
  ParamReader reader(private_params);
  BroadcasterParams params;
  params.robot = readRobotParams(reader);
  params.frame_prefix = reader.text("frame_prefix", params.frame_prefix);
  if (!params.frame_prefix.empty() && params.frame_prefix.front() == '/') {
    throw ModelError(reader.nameOf("frame_prefix") + " is '" + params.frame_prefix +
                     "', tf2 has no frame that starts with /");
  }
  MarkerParams& markers = params.markers;
  markers.rate = reader.number("marker_rate", markers.rate, 0.0, kFastestMarkers);
  markers.ellipsoid_scale = reader.number("ellipsoid_scale", markers.ellipsoid_scale, 0.0, kLargestScale);
  markers.near_singular = reader.number("near_singular", markers.near_singular, 0.0, 1.0);
  markers.path_points = reader.integer("path_points", markers.path_points, 2, kLongestPath);
  reader.refuseUnknown();
  return params;
}

}  // namespace ros_bridge
}  // namespace screwline
