#include "screwline/kinematics/propagation.h"

#include "jacobian_methods.h"

namespace screwline {
namespace {

/// X_{i-1,i} of every link at q, as one modified-DH transform each.
std::vector<Pose> linkTransforms(const SerialChain& chain, const ConstVectorRef& q) {
  std::vector<Pose> links;
  links.reserve(chain.axes().size());
  for (std::size_t i = 0; i < chain.axes().size(); ++i) {
    const Axis& axis = chain.axes()[i];
    const double displacement = axis.multiplier * q[axis.source];
    links.push_back(chain.modifiedDh().link(static_cast<int>(i) + 1, axis.prismatic, displacement));
  }
  return links;
}

/// The first link that a joint moves: of its own axis, or of one that mimics it.
std::size_t firstMovedBy(const SerialChain& chain, int joint) {
  std::size_t i = 0;
  while (chain.axes()[i].source != joint) ++i;
  return i;
}

/// R_BT by the table.
Matrix3 tipRotation(const SerialChain& chain, const std::vector<Pose>& links) {
  Matrix3 R = chain.modifiedDh().base_transform.R;
  for (const Pose& X : links) R = R * X.R;
  return R * chain.modifiedDh().tool_transform.R;
}

/// Links before `first` are at rest: they are left out of the result.
void outward(const SerialChain& chain, const std::vector<Pose>& links, const ConstVectorRef& velocity,
             std::size_t first, std::vector<LinkVelocity>& result) {
  result.clear();
  LinkVelocity parent;
  for (std::size_t i = first; i < links.size(); ++i) {
    const Axis& axis = chain.axes()[i];
    const Pose& X = links[i];
    const double rate = axis.multiplier * velocity[axis.source];
    LinkVelocity link;
    link.w = X.R.transpose() * parent.w;
    link.v = X.R.transpose() * (parent.v + parent.w.cross(X.p));
    (axis.prismatic ? link.v : link.w).z() += rate;
    result.push_back(link);
    parent = link;
  }
}

void inward(const SerialChain& chain, const std::vector<Pose>& links, const Vector6& wrench,
            std::vector<LinkWrench>& result) {
  result.resize(links.size());
  const Pose* X = &chain.modifiedDh().tool_transform;
  LinkWrench child;
  child.f = wrench.head<3>();
  child.n = wrench.tail<3>();
  for (std::size_t i = links.size(); i-- > 0;) {
    LinkWrench& link = result[i];
    link.f = X->R * child.f;
    link.n = X->R * child.n + X->p.cross(link.f);
    child = link;
    X = &links[i];
  }
}

}  // namespace

std::vector<LinkVelocity> propagateVelocity(const SerialChain& chain, const ConstVectorRef& q,
                                            const ConstVectorRef& velocity) {
  std::vector<LinkVelocity> result;
  outward(chain, linkTransforms(chain, q), velocity, 0, result);
  return result;
}

std::vector<LinkWrench> propagateForce(const SerialChain& chain, const ConstVectorRef& q, const Vector6& wrench) {
  std::vector<LinkWrench> result;
  inward(chain, linkTransforms(chain, q), wrench, result);
  return result;
}

Vector6 tipTwist(const SerialChain& chain, const LinkVelocity& last) {
  const Pose& tool = chain.modifiedDh().tool_transform;
  Vector6 V;
  V << tool.R.transpose() * (last.v + last.w.cross(tool.p)), tool.R.transpose() * last.w;
  return V;
}

VectorX effortsOf(const SerialChain& chain, const std::vector<LinkWrench>& wrenches) {
  VectorX effort = VectorX::Zero(chain.size());
  for (std::size_t i = 0; i < wrenches.size(); ++i) {
    const Axis& axis = chain.axes()[i];
    effort[axis.source] += axis.multiplier * (axis.prismatic ? wrenches[i].f.z() : wrenches[i].n.z());
  }
  return effort;
}

Matrix6X velocityPropagationJacobian(const SerialChain& chain, const ConstVectorRef& q) {
  const std::vector<Pose> links = linkTransforms(chain, q);
  const Matrix3 R_BT = tipRotation(chain, links);
  Matrix6X J(6, chain.size());
  VectorX velocity = VectorX::Zero(chain.size());
  std::vector<LinkVelocity> velocities;
  velocities.reserve(links.size());
  for (int i = 0; i < chain.size(); ++i) {
    velocity[i] = 1.0;
    outward(chain, links, velocity, firstMovedBy(chain, i), velocities);
    const Vector6 V_T = tipTwist(chain, velocities.back());
    J.col(i) << R_BT * V_T.head<3>(), R_BT * V_T.tail<3>();
    velocity[i] = 0.0;
  }
  return J;
}

Matrix6X forcePropagationJacobian(const SerialChain& chain, const ConstVectorRef& q) {
  const std::vector<Pose> links = linkTransforms(chain, q);
  const Matrix3 R_TB = tipRotation(chain, links).transpose();
  Matrix6X J(6, chain.size());
  std::vector<LinkWrench> wrenches;
  for (int row = 0; row < 6; ++row) {
    const Vector6 F_B = Vector6::Unit(row);
    Vector6 F_T;
    F_T << R_TB * F_B.head<3>(), R_TB * F_B.tail<3>();
    inward(chain, links, F_T, wrenches);
    J.row(row) = effortsOf(chain, wrenches).transpose();
  }
  return J;
}

}  // namespace screwline
