#ifndef SCREWLINE_ROS_CONVERSIONS_H
#define SCREWLINE_ROS_CONVERSIONS_H

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/Wrench.h>

#include <array>
#include <string>
#include <vector>

#include "screwline/model/task.h"
#include "screwline/spatial/pose.h"

namespace screwline {
namespace ros_bridge {

/// A quaternion's norm may be off 1 by this; it is then normalised.
constexpr double kQuaternionTolerance = 1e-3;

/// Which components of x y z a question reads; the others are taken as zero, whatever they hold.
using ReadMask = std::array<bool, 3>;
constexpr ReadMask kReadAll{true, true, true};

/// The components of x y z (first_row 0) or rx ry rz (first_row 3) that a task reads. Along axes other than the base
/// frame's every component is read where any row of the three is; so is it for rows about the tool's axes.
ReadMask readMask(const Task& task, int first_row, bool along_base_axes);

/// @throws InputError (kInvalidGoal) naming the component of `field`: not finite or beyond kMaxMagnitude.
Vector3 fromPoint(const geometry_msgs::Point& point, const std::string& field, const ReadMask& read = kReadAll);
Vector3 fromVector3(const geometry_msgs::Vector3& vector, const std::string& field, const ReadMask& read = kReadAll);

/// Rotation matrix of a quaternion. @throws InputError (kInvalidGoal): not finite, norm off 1 by more than
/// kQuaternionTolerance.
Matrix3 fromQuaternion(const geometry_msgs::Quaternion& quaternion, const std::string& field);

/// All seven numbers of a pose. @throws InputError as above.
Pose fromPose(const geometry_msgs::Pose& pose, const std::string& field);

geometry_msgs::Pose toPose(const Pose& pose);
/// [v; w].
geometry_msgs::Twist toTwist(const Vector6& twist);
/// [f; n].
geometry_msgs::Wrench toWrench(const Vector6& wrench);

std::vector<double> arrayOf(const ConstVectorRef& vector);
std::vector<double> rowMajor(const Eigen::Ref<const MatrixX>& matrix);

/// Rows named by a request; none: `otherwise`. @throws InputError (kInvalidGoal): unknown or repeated rows.
Task toTask(const std::vector<std::string>& names, const Task& otherwise);

/// Two of rx ry rz fix neither an orientation nor a heading, one of tx ty tz no direction. @throws InputError
/// (kInvalidGoal)
void requireMeaning(const Task& task);

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_CONVERSIONS_H
