#ifndef SCREWLINE_SRC_TRAJECTORY_JOINT_LEGS_H
#define SCREWLINE_SRC_TRAJECTORY_JOINT_LEGS_H

#include <vector>

#include "screwline/trajectory/corner.h"

namespace screwline {

/// A line between two waypoints in joint space that differ.
struct JointLeg {
  Eigen::Index start = 0;  ///< Column of the last waypoint at its start.
  Eigen::Index goal = 0;   ///< Column of the first waypoint at its end.
  VectorX direction;       ///< Unit length.
  double length = 0.0;
};

/// The legs through the columns of positions; repeated ones make none.
std::vector<JointLeg> jointLegs(const MatrixX& positions);

/// Of each corner between the legs, and of the ends: how far it may reach (fairReaches), zero where no blend is of use.
/// No blend, and no line between two, is shorter than 1e-6 of the way: its instants would be rounded too much.
std::vector<double> reachesOf(const std::vector<JointLeg>& legs, double radius);

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_JOINT_LEGS_H
