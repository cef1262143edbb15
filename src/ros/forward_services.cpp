#include <algorithm>

#include "screwline/ros/checks.h"
#include "screwline/ros/conversions.h"
#include "screwline/ros/joint_values.h"
#include "screwline/ros/kinematics_server.h"
#include "screwline/ros/link_jacobian.h"

namespace screwline {
namespace ros_bridge {
namespace {

/// What a request's Jacobian is turned into: moved to its reference point, expressed along its frame's axes.
struct JacobianView {
  Vector3 r;     ///< From the link's origin to the reference point, base frame.
  Matrix3 R_FB;  ///< From base axes to the frame's.
  bool as_it_is = r.isZero(0.0) && R_FB.isIdentity(0.0);

  Matrix6X operator()(const Matrix6X& J) const { return as_it_is ? J : expressedIn(movedReference(J, r), R_FB); }
};

std::size_t methodIndex(unsigned method) {
  if (method < kJacobianMethodCount) return method;
  throw InputError(AnswerCode::kInvalidGoal, "method is " + std::to_string(method) + ", it must be 0 to " +
                                                 std::to_string(kJacobianMethodCount - 1));
}

}  // namespace

Outcome KinematicsServer::computeFk(const ComputeFK::Request& request, ComputeFK::Response& response) const {
  const SerialChain& chain = *robot_.chain;
  requireCount(request.links.size(), kMostLinks, "links");
  const VectorX q = jointPositions(chain, request.joint_state);
  response.links = request.links.empty() ? std::vector<std::string>{chain.tipLink()} : request.links;
  std::vector<const Link*> links;
  for (std::size_t i = 0; i < response.links.size(); ++i) {
    links.push_back(&linkOf(response.links[i], "links[" + std::to_string(i) + "]"));
  }
  const Pose X_FB = frames_.atConfiguration(request.frame_id, q, "frame_id").inverse();
  for (const Link* link : links) {
    geometry_msgs::PoseStamped pose;
    pose.header.stamp = request.joint_state.header.stamp;
    pose.header.frame_id = frames_.nameOf(request.frame_id);
    const bool is_tip = link->name == chain.tipLink();
    pose.pose = toPose(X_FB * (is_tip ? forwardKinematics(chain, q) : linkPose(chain, *link, q)));
    response.poses.push_back(pose);
  }
  return {};
}

Outcome KinematicsServer::computeJacobian(const ComputeJacobian::Request& request,
                                          ComputeJacobian::Response& response) const {
  const SerialChain& chain = *robot_.chain;
  const std::size_t method = methodIndex(request.method);
  const VectorX q = jointPositions(chain, request.joint_state);
  const Link& link = linkOrTip(request.link_name, "link_name");
  const Vector3 point = fromPoint(request.reference_point, "reference_point");
  const Matrix3 R_BF = frames_.atConfiguration(request.frame_id, q, "frame_id").R;

  const LinkJacobians all = linkJacobians(chain, link, q);
  const JacobianView view{all.X_BL.R * point, R_BF.transpose()};
  const Matrix6X J = view(all.by_method[method]);
  double disagreement = 0.0;
  for (const Matrix6X& other : all.by_method) {
    disagreement = std::max(disagreement, (view(other) - J).cwiseAbs().maxCoeff());
  }
  const MatrixX task_rows = taskJacobian(robot_.task, J, view.R_FB * all.X_BL.R);
  response.joint_names = chain.jointNames();
  response.jacobian = rowMajor(J);
  response.task = robot_.task.names();
  response.task_jacobian = rowMajor(task_rows);
  response.determinant = determinantOrNan(task_rows);
  response.method_disagreement = disagreement;
  return {};
}

}  // namespace ros_bridge
}  // namespace screwline
