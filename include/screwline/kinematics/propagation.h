#ifndef SCREWLINE_KINEMATICS_PROPAGATION_H
#define SCREWLINE_KINEMATICS_PROPAGATION_H

#include <vector>

#include "screwline/model/serial_chain.h"

namespace screwline {

/// Velocities of modified-DH frame i (1..n; vector index i-1), components in frame i. rad/s, m/s.
struct LinkVelocity {
  Vector3 w = Vector3::Zero();
  Vector3 v = Vector3::Zero();  ///< Of the frame's origin.
};

/// Force and moment that link i-1 exerts on link i, at frame i's origin, components in frame i (Craig's f_i, n_i). N, N
/// m.
struct LinkWrench {
  Vector3 f = Vector3::Zero();
  Vector3 n = Vector3::Zero();
};

/// Outward recursion over the links (Craig eq. 5.45 to 5.48). `velocity` has n joint rates. Allocates the result.
std::vector<LinkVelocity> propagateVelocity(const SerialChain& chain, const ConstVectorRef& q,
                                            const ConstVectorRef& velocity);

/// Inward recursion (Craig eq. 5.80, 5.81). `wrench` [f; n] is exerted by the tool on the environment about the tip's
/// origin, components in the tip frame. Allocates the result.
std::vector<LinkWrench> propagateForce(const SerialChain& chain, const ConstVectorRef& q, const Vector6& wrench);

/// Twist [v; w] of the tip from the last link's velocity, components in the tip frame.
Vector6 tipTwist(const SerialChain& chain, const LinkVelocity& last);

/// Joint efforts (n: N m, N) that hold the wrenches: n_i . z or f_i . z.
VectorX effortsOf(const SerialChain& chain, const std::vector<LinkWrench>& wrenches);

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_PROPAGATION_H
