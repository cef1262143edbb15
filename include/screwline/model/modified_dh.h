#ifndef SCREWLINE_MODEL_MODIFIED_DH_H
#define SCREWLINE_MODEL_MODIFIED_DH_H

#include <vector>

#include "screwline/model/joint.h"

namespace screwline {

/// One row of a modified Denavit-Hartenberg table (Craig, ch. 3), at zero joint values:
/// X_{i-1,i} = Rx(alpha) Tx(a) Rz(theta) Tz(d), with alpha_{i-1}, a_{i-1} [m], d_i [m], theta_i [rad].
struct ModifiedDhRow {
  double a = 0.0;
  double alpha = 0.0;
  double d = 0.0;
  double theta = 0.0;
};

/// A chain as base_transform * rows * tool_transform. A joint's value adds to theta (revolute) or d (prismatic) of its
/// row.
struct ModifiedDh {
  std::vector<ModifiedDhRow> rows;
  Pose base_transform;  ///< X_B0: DH frame 0 in the base link.
  Pose tool_transform;  ///< X_nT: the tip in DH frame n.

  /// Frame i (1..n) in frame i-1 with the joint displaced by `displacement` from zero.
  Pose link(int i, bool prismatic, double displacement) const;
};

/// Neighbouring axes that are closer to parallel than this (sine s of the angle) are treated as parallel, and what is
/// left of their tilt is dropped: the table is off by up to s times the arm's length L. Above it the table has their
/// true common normal, which lies L / s away: the table's product then has rounding errors of about 1e-16 L / s. The
/// worst of both is about 1e-8 L, where s is 1e-8; for s below 1e-13 or above 1e-3 the product is the chain to 1e-12.
constexpr double kDhParallelTolerance = 1e-8;

/// The modified-DH table of axes (base frame, zero configuration) and the tip's pose there. Where a convention leaves a
/// choice (parallel, intersecting, coincident axes, the line of a prismatic axis, the first and the last frame), the
/// choice with most zeros is taken; x points to the next axis, or along the normal nearer to the x before where the
/// axes meet. At zero joint values the product is exactly the chain, elsewhere to rounding but for the bound above.
/// Allocates. Source: Craig's frame assignment, ch. 3.4.
ModifiedDh modifiedDhOf(const std::vector<Axis>& axes, const Pose& home);

/// The axes of a table, in the base frame at the zero configuration, with their types; inverse of modifiedDhOf().
/// @pre as many flags as rows.
std::vector<Axis> axesOf(const ModifiedDh& dh, const std::vector<bool>& prismatic);

/// The tip's pose of a table at the zero configuration.
Pose homeOf(const ModifiedDh& dh);

}  // namespace screwline

#endif  // SCREWLINE_MODEL_MODIFIED_DH_H
