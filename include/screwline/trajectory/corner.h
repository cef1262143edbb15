#ifndef SCREWLINE_TRAJECTORY_CORNER_H
#define SCREWLINE_TRAJECTORY_CORNER_H

#include <cstddef>
#include <string>
#include <vector>

#include "screwline/spatial/pose.h"
#include "screwline/trajectory/polynomial.h"

namespace screwline {

/// How one waypoint between the ends is passed by a way of lines. Distances are Euclidean, in joint space [rad or m] or
/// of the tip [m].
struct Corner {
  double reach = 0.0;      ///< The line is left and met again so far from the waypoint: at most the radius.
  double deviation = 0.0;  ///< The nearest that the way comes to the waypoint.
  double off_lines = 0.0;  ///< The farthest that the way is from both lines beside; 0 beside screws: not known.
  bool shortened = false;  ///< The lines beside are too short for the radius: they are shared with other corners.
  bool stops = false;      ///< The way turns straight back, or has no room for a blend: at rest in the waypoint.
};

/// How lines meet, by their directions of unit length: going straight on needs no blend, turning straight back none
/// that does not stop.
enum class Bend { kNone, kCorner, kReversal };
Bend bendBetween(const VectorX& before, const VectorX& after);

/// [corner] how far each may reach into the lines beside it: at most `most`, two corners of a line together at most its
/// length, and otherwise as evenly as can be (max-min fair: no corner can have more without taking from one that has
/// no more than it). lengths[k] lies between corners k and k + 1; the ends are corners too. O(N log N); allocates.
/// Source: Bertsekas & Gallager, Data Networks, section 6.5.2 (progressive filling).
/// @pre most.size() == lengths.size() + 1, none of them negative.
std::vector<double> fairReaches(const std::vector<double>& lengths, std::vector<double> most);

/// A blend from one line to the next, over x in [0, 1]: waypoint - rise(1 - x) d1 + rise(x) d2 with the lines'
/// directions d1, d2 and this polynomial. It leaves and meets the lines at `reach` without curvature (C2), symmetric in
/// the corner, and passes the waypoint and the lines nearest and farthest in its middle, where both terms are 3/16
/// reach.
Polynomial cornerRise(double reach);
constexpr double kCornerMiddle = 3.0 / 16.0;

/// Of a blend in whose middle both lines' terms are `middle`.
Corner describeCorner(double reach, double middle, const VectorX& before, const VectorX& after);

/// What a message says of all corners together: greatest distances (from the lines too, where that is known), stops,
/// and where the lines are too short. @param unit behind each distance: " m" of a tip's; empty: a norm of joint
/// differences.
void noteCorners(const std::vector<Corner>& corners, double radius, const std::string& unit,
                 std::vector<std::string>& notes);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_CORNER_H
