#include "screwline/kinematics/statics.h"
#include "screwline/kinematics/velocity.h"
#include "screwline/ros/checks.h"
#include "screwline/ros/conversions.h"
#include "screwline/ros/joint_values.h"
#include "screwline/ros/kinematics_server.h"

namespace screwline {
namespace ros_bridge {
namespace {

/// Both 3-vectors of a 6-vector along other axes.
Vector6 turned(const Matrix3& R, const Vector6& v) {
  Vector6 result;
  result << R * v.head<3>(), R * v.tail<3>();
  return result;
}

Vector6 wrenchOf(const geometry_msgs::Wrench& wrench) {
  Vector6 result;
  result << fromVector3(wrench.force, "wrench.force"), fromVector3(wrench.torque, "wrench.torque");
  return result;
}

Vector6 twistOf(const geometry_msgs::Twist& twist, const Task& task, bool along_base_axes) {
  Vector6 result;
  result << fromVector3(twist.linear, "twist.linear", readMask(task, 0, along_base_axes)),
      fromVector3(twist.angular, "twist.angular", readMask(task, 3, along_base_axes));
  return result;
}

void requireDirection(unsigned direction) {
  if (direction <= 1U) return;
  throw InputError(AnswerCode::kInvalidGoal, "direction is " + std::to_string(direction) + ", it must be 0 or 1");
}

}  // namespace

Outcome KinematicsServer::computeStatics(const ComputeStatics::Request& request,
                                         ComputeStatics::Response& response) const {
  const SerialChain& chain = *robot_.chain;
  requireDirection(request.direction);
  const VectorX q = jointPositions(chain, request.joint_state);
  const Task task = toTask(request.task, robot_.task);
  const Matrix3 R_BF = frames_.atConfiguration(request.wrench.header.frame_id, q, "wrench.header.frame_id").R;
  WrenchSolution solution;
  if (request.direction == ComputeStatics::Request::WRENCH_TO_EFFORT) {
    solution.wrench = turned(R_BF, wrenchOf(request.wrench.wrench));
    solution.exact = true;
  } else {
    const VectorX effort = jointValues(chain, request.joint_state.name, request.effort, "joint_state.name", "effort");
    solution = screwline::wrenchOf(chain, q, effort, task);
  }
  response.joint_names = chain.jointNames();
  response.effort = arrayOf(effortOf(chain, q, solution.wrench));
  response.wrench.header = request.wrench.header;
  response.wrench.header.frame_id = frames_.nameOf(request.wrench.header.frame_id);
  response.wrench.wrench = toWrench(turned(R_BF.transpose(), solution.wrench));
  response.exact = solution.exact;
  response.residual = solution.residual;
  response.supported_wrenches = rowMajor(supportedWrenches(chain, q));
  return {};
}

Outcome KinematicsServer::computeVelocity(const ComputeVelocity::Request& request,
                                          ComputeVelocity::Response& response) const {
  const SerialChain& chain = *robot_.chain;
  requireDirection(request.direction);
  const VectorX q = jointPositions(chain, request.joint_state);
  const Task task = toTask(request.task, robot_.task);
  const std::string& frame = request.twist.header.frame_id;
  const Matrix3 R_BF = frames_.atConfiguration(frame, q, "twist.header.frame_id").R;
  VelocitySolution solution;
  if (request.direction == ComputeVelocity::Request::JOINT_TO_TWIST) {
    solution.velocity = jointVelocities(chain, request.joint_state);
    solution.twist = tipTwist(chain, q, solution.velocity);
    solution.exact = true;
  } else {
    solution = solveVelocity(chain, q, turned(R_BF, twistOf(request.twist.twist, task, frames_.isBase(frame))), task);
  }
  response.joint_names = chain.jointNames();
  response.velocity = arrayOf(solution.velocity);
  response.twist.header = request.twist.header;
  response.twist.header.frame_id = frames_.nameOf(frame);
  response.twist.twist = toTwist(turned(R_BF.transpose(), solution.twist));
  response.exact = solution.exact;
  response.residual = solution.residual;
  response.damping = solution.damping;
  return {};
}

}  // namespace ros_bridge
}  // namespace screwline
