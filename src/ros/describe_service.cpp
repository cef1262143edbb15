#include <cmath>

#include "screwline/model/structure.h"
#include "screwline/ros/conversions.h"
#include "screwline/ros/kinematics_server.h"

namespace screwline {
namespace ros_bridge {
namespace {

void describeJoints(const SerialChain& chain, Describe::Response& response) {
  response.base_link = chain.baseLink();
  response.tip_link = chain.tipLink();
  response.joint_names = chain.jointNames();
  for (const Joint& joint : chain.joints()) {
    response.joint_types.emplace_back(toString(joint.type));
    response.lower.push_back(joint.limits.lower);
    response.upper.push_back(joint.limits.upper);
    response.velocity_limits.push_back(joint.limits.velocity);
    response.acceleration_limits.push_back(joint.limits.acceleration);
    response.jerk_limits.push_back(joint.limits.jerk);
  }
}

void describeGeometry(const SerialChain& chain, Describe::Response& response) {
  response.screw_axes = rowMajor(chain.screwAxes().transpose());
  response.home = toPose(chain.home());
  const ModifiedDh& dh = chain.modifiedDh();
  for (const ModifiedDhRow& row : dh.rows) {
    response.modified_dh.insert(response.modified_dh.end(), {row.a, row.alpha, row.d, row.theta});
  }
  response.base_transform = toPose(dh.base_transform);
  response.tool_transform = toPose(dh.tool_transform);
}

}  // namespace

Outcome KinematicsServer::describe(const Describe::Request&, Describe::Response& response) const {
  const SerialChain& chain = *robot_.chain;
  describeJoints(chain, response);
  describeGeometry(chain, response);
  response.task = robot_.task.names();
  response.notes = robot_.notes;
  for (std::string& finding : describeStructure(chain, structureOf(chain))) {
    response.notes.push_back(std::move(finding));
  }
  if (chain.hasMimic())
    response.notes.emplace_back("mimic joints move with their joints; modified_dh has a row for each");
  if (conditions_) response.notes.push_back(conditions_->note());
  const auto solver = solverFor(linkOf(chain.tipLink(), "tip_link"), robot_.task);
  response.ik_method = solver->method();
  response.ik_complete = solver->complete();
  return {};
}

}  // namespace ros_bridge
}  // namespace screwline
