#include "screwline/ros/kinematics_server.h"

#include <boost/function.hpp>

#include "screwline/ros/checks.h"
#include "screwline/ros/node_constants.h"

namespace screwline {
namespace ros_bridge {
namespace {

constexpr std::size_t kMostSolvers = 64;

/// Offers one method of the server as a service.
template <typename Service>
ros::ServiceServer offer(ros::NodeHandle& node, const std::string& name, const KinematicsServer& server,
                         Outcome (KinematicsServer::*method)(const typename Service::Request&,
                                                             typename Service::Response&) const) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> callback = [&server, method, name](Request& request,
                                                                                      Response& response) {
    return serve(name, response, [&] { return (server.*method)(request, response); });
  };
  return node.advertiseService<Request, Response>(name, callback);
}

}  // namespace

KinematicsServer::KinematicsServer(ServedRobot robot, const KinematicsParams& params, FrameLookup lookup)
    : robot_(std::move(robot)),
      params_(params),
      frames_(robot_.chain, std::move(lookup)),
      solvers_(kMostSolvers),
      factors_(kMostSolvers) {}

void KinematicsServer::advertise(ros::NodeHandle& private_node) {
  conditions_.emplace(robot_.chain, robot_.task, params_.conditions_timeout);
  ros::NodeHandle batch_node(private_node);
  batch_node.setCallbackQueue(&batch_queue_);
  services_ = {
      offer<Describe>(private_node, kDescribeService, *this, &KinematicsServer::describe),
      offer<ComputeFK>(private_node, kComputeFkService, *this, &KinematicsServer::computeFk),
      offer<ComputeIK>(private_node, kComputeIkService, *this, &KinematicsServer::computeIk),
      offer<ComputeJacobian>(private_node, kComputeJacobianService, *this, &KinematicsServer::computeJacobian),
      offer<AnalyzeSingularity>(private_node, kAnalyzeSingularityService, *this, &KinematicsServer::analyze),
      offer<ComputeStatics>(private_node, kComputeStaticsService, *this, &KinematicsServer::computeStatics),
      offer<ComputeVelocity>(private_node, kComputeVelocityService, *this, &KinematicsServer::computeVelocity),
      offer<ComputeFKBatch>(batch_node, kComputeFkBatchService, *this, &KinematicsServer::computeFkBatch),
      offer<ComputeIKBatch>(batch_node, kComputeIkBatchService, *this, &KinematicsServer::computeIkBatch),
      offer<Derive>(batch_node, kDeriveService, *this, &KinematicsServer::derive),
  };
  batch_spinner_.emplace(static_cast<unsigned>(params_.threads), &batch_queue_);
  batch_spinner_->start();
}

const Link& KinematicsServer::linkOf(const std::string& name, const std::string& field) const {
  const SerialChain& chain = *robot_.chain;
  const Link* link = chain.findLink(name);
  if (link != nullptr) return *link;
  throw InputError(AnswerCode::kInvalidLinkName,
                   field + " is " + quoted(name) + ", chain " + quoted(chain.name()) + " has no such link");
}

const Link& KinematicsServer::linkOrTip(const std::string& name, const std::string& field) const {
  return linkOf(name.empty() ? robot_.chain->tipLink() : name, field);
}

}  // namespace ros_bridge
}  // namespace screwline
