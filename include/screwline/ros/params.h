#ifndef SCREWLINE_ROS_PARAMS_H
#define SCREWLINE_ROS_PARAMS_H

#include <map>
#include <string>
#include <vector>

#include "screwline/model/limits.h"
#include "screwline/ros/param_reader.h"

namespace screwline {
namespace ros_bridge {

/// Which chain of robot_description a node serves.
struct RobotParams {
  std::string base_link;          ///< Empty: of the only root-to-leaf chain.
  std::string tip_link;           ///< Empty: of the only root-to-leaf chain.
  std::vector<std::string> task;  ///< Empty: derived from the chain.
  int max_joints = kMaxJoints;    ///< 1 to kMaxJoints.
};

/// Private parameters of kinematics_server.
struct KinematicsParams {
  RobotParams robot;
  double ik_timeout = 0.1;           ///< [s] for what inverse kinematics searches numerically.
  int threads = 0;                   ///< That answer requests; 0: as many as cores.
  int max_batch = 1000000;           ///< Rows of a batch request.
  double batch_timeout = 600.0;      ///< [s] for all of a batch of inverse kinematics.
  double derive_timeout = 60.0;      ///< [s] for the formulas of one request.
  double conditions_timeout = 60.0;  ///< [s] for the singular conditions, in the background; 0: they are not derived.
  double rotation_weight = 1.0;      ///< [m/rad] how rotation counts beside translation in one distance.
};

/// @throws ModelError naming the key.
RobotParams readRobotParams(ParamReader& reader);

/// Every private parameter of the node. @throws ModelError, also for a key that the node does not have.
KinematicsParams readKinematicsParams(const XmlRpc::XmlRpcValue& private_params);

/// What stands in robot_description_planning/joint_limits.
struct PlanningLimits {
  std::map<std::string, RateLimits> rates;  ///< By joint name; has_... flags obeyed.
  std::vector<std::string> with_positions;  ///< Joints for which it also gives position limits (these are not read).
};

/// `values`: a struct of joint names, or invalid where there is none. `where`: its name in messages.
/// @throws ModelError naming the key: wrong types, a limit not in (0, kMaxMagnitude], a has_... flag without its limit.
PlanningLimits readPlanningLimits(const XmlRpc::XmlRpcValue& values, const std::string& where);

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_PARAMS_H
