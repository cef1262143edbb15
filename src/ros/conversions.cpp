#include "screwline/ros/conversions.h"

#include <cmath>

#include "screwline/ros/checks.h"

namespace screwline {
namespace ros_bridge {
namespace {

Vector3 checked(const Vector3& values, const std::string& field, const ReadMask& read) {
  static const char* const kNames[] = {".x", ".y", ".z"};
  Vector3 result = Vector3::Zero();
  for (int i = 0; i < 3; ++i) {
    if (!read[static_cast<std::size_t>(i)]) continue;
    if (!isServed(values[i])) requireFinite(values[i], field + kNames[i]);
    result[i] = values[i];
  }
  return result;
}

geometry_msgs::Vector3 toVector3(const Vector3& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

}  // namespace

ReadMask readMask(const Task& task, int first_row, bool along_base_axes) {
  // Rows about the tool's axes depend on all three components.
  if (first_row == 3 && task.usesToolAxes()) return {true, true, true};
  const ReadMask rows{task.contains(first_row), task.contains(first_row + 1), task.contains(first_row + 2)};
  if (along_base_axes) return rows;
  const bool any = rows[0] || rows[1] || rows[2];
  return {any, any, any};
}

Vector3 fromPoint(const geometry_msgs::Point& point, const std::string& field, const ReadMask& read) {
  return checked({point.x, point.y, point.z}, field, read);
}

Vector3 fromVector3(const geometry_msgs::Vector3& vector, const std::string& field, const ReadMask& read) {
  return checked({vector.x, vector.y, vector.z}, field, read);
}

Matrix3 fromQuaternion(const geometry_msgs::Quaternion& quaternion, const std::string& field) {
  if (!isServed(quaternion.x)) requireFinite(quaternion.x, field + ".x");
  if (!isServed(quaternion.y)) requireFinite(quaternion.y, field + ".y");
  if (!isServed(quaternion.z)) requireFinite(quaternion.z, field + ".z");
  if (!isServed(quaternion.w)) requireFinite(quaternion.w, field + ".w");
  const Quaternion q(quaternion.w, quaternion.x, quaternion.y, quaternion.z);
  const double norm = q.norm();
  if (std::abs(norm - 1.0) > kQuaternionTolerance) {
    throw InputError(AnswerCode::kInvalidGoal, field + " has norm " + numberText(norm) + ", it must be 1 within " +
                                                   numberText(kQuaternionTolerance));
  }
  return q.normalized().toRotationMatrix();
}

Pose fromPose(const geometry_msgs::Pose& pose, const std::string& field) {
  return {fromQuaternion(pose.orientation, field + ".orientation"), fromPoint(pose.position, field + ".position")};
}

geometry_msgs::Pose toPose(const Pose& pose) {
  Quaternion q(pose.R);
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  q.coeffs().array() += 0.0;  // No -0 for people to read.
  geometry_msgs::Pose message;
  message.position.x = pose.p.x();
  message.position.y = pose.p.y();
  message.position.z = pose.p.z();
  message.orientation.x = q.x();
  message.orientation.y = q.y();
  message.orientation.z = q.z();
  message.orientation.w = q.w();
  return message;
}

geometry_msgs::Twist toTwist(const Vector6& twist) {
  geometry_msgs::Twist message;
  message.linear = toVector3(twist.head<3>());
  message.angular = toVector3(twist.tail<3>());
  return message;
}

geometry_msgs::Wrench toWrench(const Vector6& wrench) {
  geometry_msgs::Wrench message;
  message.force = toVector3(wrench.head<3>());
  message.torque = toVector3(wrench.tail<3>());
  return message;
}

std::vector<double> arrayOf(const ConstVectorRef& vector) {
  return {vector.data(), vector.data() + vector.size()};
}

std::vector<double> rowMajor(const Eigen::Ref<const MatrixX>& matrix) {
  std::vector<double> array;
  array.reserve(static_cast<std::size_t>(matrix.size()));
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) array.push_back(matrix(row, column));
  return array;
}

Task toTask(const std::vector<std::string>& names, const Task& otherwise) {
  return names.empty() ? otherwise : Task::parse(names);
}

void requireMeaning(const Task& task) {
  if (task.usesToolAxes()) {
    if (task.rotationCount() != 1) return;
    throw InputError(
        AnswerCode::kInvalidGoal,
        "task has 1 of tx ty tz, it must have two of them (the direction of the third axis), all three or none");
  }
  if (task.rotationCount() != 2) return;
  throw InputError(AnswerCode::kInvalidGoal, "task has 2 of rx ry rz, it must have one of them, all three or none");
}

}  // namespace ros_bridge
}  // namespace screwline
