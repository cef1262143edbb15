#ifndef SCREWLINE_MODEL_DH_READER_H
#define SCREWLINE_MODEL_DH_READER_H

#include <string>

#include "screwline/model/serial_chain.h"

namespace screwline {

/// Reads a chain from a modified-DH table in YAML:
///
///     name: my_arm
///     joints:                     # base to tip
///       - {name: theta1, type: revolute, alpha: 0, a: 0, d: 0.3, theta: 0, lower: -3, upper: 3, velocity: 2}
///       - {name: d2, type: prismatic, alpha: -pi/2, a: 0, d: 0, theta: 0, lower: 0, upper: 1}
///     base: {xyz: [0, 0, 0], rpy: [0, 0, 0]}    # optional
///     tool: {xyz: [0.1, 0, 0], rpy: [0, 0, 0]}  # optional
///
/// Lengths in m, angles in rad; an angle may be written as a number times pi over a number ("pi/2", "-2*pi/3").
/// Optional: lower, upper (needed for revolute and prismatic), velocity, acceleration, jerk. Unknown keys are refused.
/// @throws ModelError naming the key and what is wrong with it.
SerialChain readDhYaml(const std::string& yaml);

/// The same from a file. @throws ModelError also where it cannot be read.
SerialChain readDhYamlFile(const std::string& path);

/// A plain URDF document of a chain, with simple visuals: what the tool `dh_to_urdf` prints. readUrdf() of it is the
/// same chain.
std::string toUrdf(const SerialChain& chain);

}  // namespace screwline

#endif  // SCREWLINE_MODEL_DH_READER_H
