#ifndef SCREWLINE_MODEL_STRUCTURE_H
#define SCREWLINE_MODEL_STRUCTURE_H

#include <string>
#include <vector>

#include "screwline/model/serial_chain.h"

namespace screwline {

/// Below these two axes count as parallel (sine of the angle), orthogonal (cosine) or meeting (distance over the
/// chain's characteristic length): far above the rounding of a URDF's "1.5707963", far below any offset that is meant.
constexpr double kStructureAngleTolerance = 1e-9;
constexpr double kStructureLengthTolerance = 1e-9;

/// How two axes (lines for revolute joints, directions for prismatic ones) lie to each other. It does not change as the
/// arm moves where they are neighbours, or where all axes between them share the property.
struct AxisRelation {
  double angle = 0.0;     ///< [rad] in [0, pi/2] between the directions.
  double distance = 0.0;  ///< [m] between the lines; 0 where either axis is prismatic.
  bool parallel = false;
  bool orthogonal = false;
  bool intersecting = false;                ///< Both revolute, not parallel, the lines meet.
  bool coincident = false;                  ///< Both revolute, the same line.
  Vector3 meeting_point = Vector3::Zero();  ///< [m] base frame, zero configuration; only where intersecting.
};

/// `length` [m] scales the tolerance of meeting.
AxisRelation relate(const Axis& first, const Axis& second, double length);

/// Neighbouring revolute axes that meet in one point (a spherical wrist or shoulder where count is 3).
struct ConcurrentGroup {
  int first = 0;
  int count = 0;
  Vector3 center = Vector3::Zero();  ///< [m] base frame, zero configuration.
};

/// A run of revolute axes that are parallel to each other; prismatic axes between them do not end it (they turn
/// nothing).
struct ParallelGroup {
  std::vector<int> axes;
  Vector3 direction = Vector3::UnitZ();  ///< Base frame, zero configuration.
};

/// What a chain's axes share.
struct Structure {
  std::vector<AxisRelation> neighbours;         ///< Of axes i and i+1.
  std::vector<ConcurrentGroup> spherical;       ///< Maximal groups of three or more neighbouring axes.
  std::vector<ParallelGroup> parallel;          ///< Maximal groups of two or more.
  bool all_revolute_parallel = false;           ///< A planar arm, prismatic joints apart.
  Vector3 common_direction = Vector3::UnitZ();  ///< Of all revolute axes, where all_revolute_parallel.
};

/// Allocates.
Structure structureOf(const SerialChain& chain);

/// One line per finding, as "axes theta4, theta5, theta6 meet in one point (spherical wrist)".
std::vector<std::string> describeStructure(const SerialChain& chain, const Structure& structure);

}  // namespace screwline

#endif  // SCREWLINE_MODEL_STRUCTURE_H
