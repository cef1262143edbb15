#ifndef SCREWLINE_TRAJECTORY_TOOL_PATH_H
#define SCREWLINE_TRAJECTORY_TOOL_PATH_H

#include <cstddef>
#include <vector>

#include "screwline/spatial/pose.h"
#include "screwline/trajectory/corner.h"
#include "screwline/trajectory/polynomial.h"

namespace screwline {

/// The tip on its way, in the base frame, with derivatives by the path parameter u.
struct ToolPathPoint {
  Pose pose;
  Vector6 rate = Vector6::Zero();    ///< [dp/du; w]: twist per unit of u.
  Vector6 change = Vector6::Zero();  ///< [d^2p/du^2; dw/du].
};

/// One formula of a path, over `length` of u. With x = (u - start) / length and polynomials g(x), h(x):
/// position anchor.p + before_p g + after_p h (a line; a corner's blend of two), or on an arc;
/// orientation anchor.R exp([before_r] g_r) exp([after_r] h_r). Screws: anchor exp([before] g) exp([after] h).
struct ToolPathPiece {
  enum class Kind { kStraight, kArc, kScrew };

  Kind kind = Kind::kStraight;
  double start = 0.0;
  double length = 0.0;
  Pose anchor;
  Vector6 before = Vector6::Zero();  ///< Translation in the base frame, rotation in the anchor's; screws: the anchor's.
  Vector6 after = Vector6::Zero();
  Polynomial g;
  Polynomial h;
  Polynomial g_turn;  ///< Of the rotations; equal to g and h but on an arc.
  Polynomial h_turn;
  Vector3 centre = Vector3::Zero();  ///< Arc: its centre, unit normal and angle [rad].
  Vector3 normal = Vector3::UnitZ();
  double angle = 0.0;

  /// Also for u beyond the piece: the formula goes on. Does not allocate.
  void at(double u, ToolPathPoint& point) const;
};

/// A path of the tip: u runs from 0 to length(); in units of the characteristic length beside rad. Between stops
/// position and orientation are C2 in u; at a stop the direction steps, so the tip has to rest there. Immutable.
class ToolPath {
 public:
  /// @pre pieces follow one another from u = 0; stops are starts of pieces, ascending; waypoints one u each.
  ToolPath(std::vector<ToolPathPiece> pieces, std::vector<double> stops, std::vector<double> waypoints);

  double length() const { return length_; }                            ///< Of u; 0: nothing moves.
  const std::vector<double>& waypoints() const { return waypoints_; }  ///< u of each pose that made the path.

  std::size_t parts() const { return part_ends_.size(); }  ///< Smooth parts between stops, at least one.
  double partStart(std::size_t part) const { return part == 0 ? 0.0 : part_ends_[part - 1]; }
  double partEnd(std::size_t part) const { return part_ends_[part]; }

  /// The path at u, by the formulas of one smooth part: beyond its ends they go on. Does not allocate.
  void at(std::size_t part, double u, ToolPathPoint& point) const;
  /// At a stop: of the part that begins there.
  Pose pose(double u) const;
  /// [m] Way of the tip's origin from the start to u. By quadrature, to 1e-6 of the whole.
  double metres(double u) const;

 private:
  std::vector<ToolPathPiece> pieces_;
  std::vector<double> part_ends_;
  std::vector<std::size_t> first_piece_;  ///< Of each part; one more at the end.
  std::vector<double> waypoints_;
  double length_ = 0.0;
};

struct ToolPathOptions {
  double length_scale = 1.0;  ///< [m] that counts as much as 1 rad in u.
  bool rotates = true;        ///< False: the task has no rotation row, orientations are not looked at.
  bool screw = false;         ///< Constant screws instead of lines with spherical interpolation (slerp).
  double blend_radius = 0.0;  ///< [m] A corner is left and met again at this distance at most; 0: stop there.
};

/// A path of lines and how it passes each pose [m]. Ends, repeated poses, and those in which lines go straight on are
/// corners without a reach; off_lines is not known of screws (0).
struct ToolLines {
  ToolPath path;
  std::vector<Corner> corners;
};

/// Lines from pose to pose: the origin at constant speed on the straight, the orientation about one constant axis (or
/// one screw for both). Blends (cornerRise) are C2 in u, share lines that are too short for them fairly (fairReaches),
/// and pass a corner of two lines at right angles at 0.27 blend_radius. The path stops where it goes straight back, or
/// where the tip only turns before or behind a corner. Repeated poses count once.
/// @pre at least one pose, rotations orthonormal. @throws InputError(kInvalidGoal) for a blend_radius that is negative.
ToolLines linesThrough(const std::vector<Pose>& poses, const ToolPathOptions& options);

struct ArcOptions {
  bool centre = false;          ///< The second pose is the circle's centre, not a point on it.
  bool long_way = false;        ///< With a centre: the arc of more than half a turn.
  bool via_orientation = true;  ///< The orientation of the pose on the arc is met too; false: slerp from end to end.
};

/// The circle's arc from the first pose through the second to the third. Orientation: slerp from end to end, and, so
/// that the second pose's is met, a turn relative to it that grows and fades as a parabola.
/// @throws InputError(kInvalidGoal) where three points define no circle, or the centre is not equally far from both
/// ends (by 1e-6 of the radius).
ToolPath arcThrough(const std::vector<Pose>& poses, const ArcOptions& arc, const ToolPathOptions& options);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_TOOL_PATH_H
