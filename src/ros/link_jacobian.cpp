#include "screwline/ros/link_jacobian.h"

#include <map>

namespace screwline {
namespace ros_bridge {
namespace {

/// The part of a chain that moves a link, with the places of its joints in the whole chain.
struct SubChain {
  SerialChain chain;
  std::vector<Eigen::Index> columns;
};

SubChain chainTo(const SerialChain& chain, const Link& link) {
  ChainDescription description;
  description.name = chain.name();
  description.base_link = chain.baseLink();
  description.tip_link = link.name;
  description.home = link.home;
  description.links = {link};
  std::vector<Eigen::Index> columns;
  std::map<int, int> place_of;  // of a joint of the whole chain in the part
  for (int i = 0; i < link.axis_count; ++i) {
    Axis axis = chain.axes()[static_cast<std::size_t>(i)];
    const auto [place, is_new] = place_of.emplace(axis.source, static_cast<int>(columns.size()));
    if (is_new) {
      description.joints.push_back(chain.joint(axis.source));
      columns.push_back(axis.source);
    }
    axis.source = place->second;
    description.axes.push_back(axis);
  }
  return {SerialChain(std::move(description)), std::move(columns)};
}

}  // namespace

LinkJacobians linkJacobians(const SerialChain& chain, const Link& link, const ConstVectorRef& q) {
  LinkJacobians result;
  const bool is_tip = link.name == chain.tipLink();
  result.X_BL = is_tip ? forwardKinematics(chain, q) : linkPose(chain, link, q);
  if (is_tip) {
    for (int i = 0; i < kJacobianMethodCount; ++i) {
      result.by_method[static_cast<std::size_t>(i)] = jacobian(chain, q, static_cast<JacobianMethod>(i));
    }
    return result;
  }
  for (Matrix6X& J : result.by_method) J = Matrix6X::Zero(6, chain.size());
  if (link.axis_count == 0) return result;
  const SubChain part = chainTo(chain, link);
  VectorX values(part.chain.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = q[part.columns[static_cast<std::size_t>(i)]];
  for (int method = 0; method < kJacobianMethodCount; ++method) {
    const Matrix6X J = jacobian(part.chain, values, static_cast<JacobianMethod>(method));
    Matrix6X& whole = result.by_method[static_cast<std::size_t>(method)];
    for (Eigen::Index i = 0; i < values.size(); ++i) whole.col(part.columns[static_cast<std::size_t>(i)]) = J.col(i);
  }
  return result;
}

}  // namespace ros_bridge
}  // namespace screwline
