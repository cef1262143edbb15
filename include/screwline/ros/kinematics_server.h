#ifndef SCREWLINE_ROS_KINEMATICS_SERVER_H
#define SCREWLINE_ROS_KINEMATICS_SERVER_H

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "screwline/ik/inverse_kinematics.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/ros/bounded_cache.h"
#include "screwline/ros/derived_conditions.h"
#include "screwline/ros/frame_resolver.h"
#include "screwline/ros/robot_loader.h"
#include "screwline/ros/service_adapter.h"

namespace screwline {
namespace ros_bridge {

/// Links that one request may ask for.
constexpr std::size_t kMostLinks = 10000;

/// Answers questions about one robot: see the .srv files. Needs no master until advertise(). Every method may be called
/// from many threads; each fills the response and returns how it ended, or throws InputError for a bad request.
class KinematicsServer {
 public:
  KinematicsServer(ServedRobot robot, const KinematicsParams& params, FrameLookup lookup);

  /// Offers the services in a private namespace for as long as this lives. Batches and derivations have threads of
  /// their own: a long one keeps no other question waiting. Begins to derive the singular conditions of the robot's
  /// task; until they are known, and for other tasks, they are fitted to numbers.
  void advertise(ros::NodeHandle& private_node);

  Outcome describe(const Describe::Request& request, Describe::Response& response) const;
  Outcome computeFk(const ComputeFK::Request& request, ComputeFK::Response& response) const;
  Outcome computeIk(const ComputeIK::Request& request, ComputeIK::Response& response) const;
  Outcome computeJacobian(const ComputeJacobian::Request& request, ComputeJacobian::Response& response) const;
  Outcome analyze(const AnalyzeSingularity::Request& request, AnalyzeSingularity::Response& response) const;
  Outcome computeStatics(const ComputeStatics::Request& request, ComputeStatics::Response& response) const;
  Outcome computeVelocity(const ComputeVelocity::Request& request, ComputeVelocity::Response& response) const;
  Outcome computeFkBatch(const ComputeFKBatch::Request& request, ComputeFKBatch::Response& response) const;
  Outcome derive(const Derive::Request& request, Derive::Response& response) const;
  Outcome computeIkBatch(const ComputeIKBatch::Request& request, ComputeIKBatch::Response& response) const;

 private:
  using SolverKey = std::pair<std::string, std::vector<int>>;  ///< Tip link, task rows.

  /// The link of that name. @throws InputError (kInvalidLinkName)
  const Link& linkOf(const std::string& name, const std::string& field) const;
  /// The same; empty: the tip.
  const Link& linkOrTip(const std::string& name, const std::string& field) const;
  std::shared_ptr<const InverseKinematics> solverFor(const Link& tip, const Task& task) const;
  /// Those of the conditions: derived where they are known, else fitted.
  std::shared_ptr<const std::vector<SingularityFactor>> factorsFor(const Task& task) const;
  /// N of a request's N x columns numbers. @throws InputError (`code`; kTooLarge beyond ~max_batch)
  std::size_t batchRows(std::size_t numbers, int columns, const std::string& field, AnswerCode code) const;
  std::vector<Pose> batchTargets(const std::vector<double>& poses) const;
  IkRequest ikRequest(const ComputeIK::Request& request, const Task& task) const;

  ServedRobot robot_;
  KinematicsParams params_;
  FrameResolver frames_;
  mutable BoundedCache<SolverKey, InverseKinematics> solvers_;
  mutable BoundedCache<std::vector<int>, std::vector<SingularityFactor>> factors_;
  std::optional<DerivedConditions> conditions_;
  ros::CallbackQueue batch_queue_;
  std::optional<ros::AsyncSpinner> batch_spinner_;
  std::vector<ros::ServiceServer> services_;  // Last: withdrawn before the queue and its threads end.
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_KINEMATICS_SERVER_H
