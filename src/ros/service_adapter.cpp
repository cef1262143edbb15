#include "screwline/ros/service_adapter.h"

#include <ros/console.h>

namespace screwline {
namespace ros_bridge {
namespace detail {

void logOutcome(const std::string& service, const Outcome& outcome) {
  if (outcome.code == AnswerCode::kFailure) {
    ROS_ERROR_STREAM(service << ": " << outcome.message);
  } else {
    ROS_DEBUG_STREAM(service << ": " << static_cast<int>(outcome.code) << " " << outcome.message);
  }
}

}  // namespace detail

}  // namespace ros_bridge
}  // namespace screwline
