#ifndef SCREWLINE_MODEL_CHAIN_KERNEL_H
#define SCREWLINE_MODEL_CHAIN_KERNEL_H

#include <vector>

#include "screwline/model/joint.h"

namespace screwline {

/// Constants of one axis in the form that forward kinematics multiplies fastest: from the frame of the axis before,
/// X = Trans(p) Rx(alpha) Rz(offset + value) for a revolute axis, Trans(p) Rx(alpha) Rz(offset) Tz(value) for a
/// prismatic one. Any two lines can be joined so; unlike Denavit-Hartenberg parameters, p stays small for axes that are
/// almost parallel.
struct AxisKernel {
  Vector3 p = Vector3::Zero();
  double cos_alpha = 1.0;
  double sin_alpha = 0.0;
  double offset = 0.0;
  double multiplier = 1.0;
  int source = 0;
  bool prismatic = false;
};

/// A chain compiled for speed: tip = base * axes * tool.
struct ChainKernel {
  Pose base;
  std::vector<AxisKernel> axes;
  Pose tool;
};

/// Compiles axes (base frame, zero configuration) and the tip's pose at zero. Allocates.
ChainKernel compileChain(const std::vector<Axis>& axes, const Pose& home);

}  // namespace screwline

#endif  // SCREWLINE_MODEL_CHAIN_KERNEL_H
