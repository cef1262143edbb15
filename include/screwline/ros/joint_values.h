#ifndef SCREWLINE_ROS_JOINT_VALUES_H
#define SCREWLINE_ROS_JOINT_VALUES_H

#include <sensor_msgs/JointState.h>

#include <string>
#include <vector>

#include "screwline/model/serial_chain.h"

namespace screwline {
namespace ros_bridge {

/// n values in the chain's order, out of `values` that are in the order of `names` (in chain order where there are
/// none). `name_field` and `field` are what messages call the two.
/// @throws InputError (kInvalidRobotState): sizes, unknown, repeated or missing names, values not finite or beyond
/// kMaxMagnitude.
VectorX jointValues(const SerialChain& chain, const std::vector<std::string>& names, const std::vector<double>& values,
                    const std::string& name_field, const std::string& field);

/// Positions of a joint state. `field` is the request's field that holds it.
VectorX jointPositions(const SerialChain& chain, const sensor_msgs::JointState& state,
                       const std::string& field = "joint_state");

/// Velocities of a joint state.
VectorX jointVelocities(const SerialChain& chain, const sensor_msgs::JointState& state,
                        const std::string& field = "joint_state");

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_JOINT_VALUES_H
