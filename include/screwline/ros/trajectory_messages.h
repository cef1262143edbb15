#ifndef SCREWLINE_ROS_TRAJECTORY_MESSAGES_H
#define SCREWLINE_ROS_TRAJECTORY_MESSAGES_H

#include "screwline/ros/messages.h"
// After it: the services of trajectory_generator, whose fields are the messages named there.
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <screwline/ExecuteTrajectory.h>
#include <screwline/ListProfiles.h>
#include <screwline/PlanTrajectory.h>
#include <sensor_msgs/JointState.h>
#include <std_srvs/Trigger.h>
#include <trajectory_msgs/JointTrajectory.h>

#include "screwline/ros/response_check.h"

namespace screwline {

/// A plan's answer may hold infinity where its motion steps: in the metrics of acceleration and jerk. (In the messages'
/// namespace, where isSound() looks for it.)
ros_bridge::Allowed allowed(const PlanTrajectory::Response& response, const double* number);

}  // namespace screwline

#endif  // SCREWLINE_ROS_TRAJECTORY_MESSAGES_H
