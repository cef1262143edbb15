#ifndef SCREWLINE_SRC_TRAJECTORY_DILATION_H
#define SCREWLINE_SRC_TRAJECTORY_DILATION_H

#include <cstddef>
#include <optional>
#include <vector>

namespace screwline {

/// A motion Q(s) of n joints on a uniform grid of its own time s, to be run through faster or slower: ds/dt = sqrt(r).
/// Then velocity is Q' sqrt(r), acceleration Q'' r + Q' r'/2, jerk (Q''' r + 3/2 Q'' r' + 1/2 Q' r'') sqrt(r). All
/// entries are shares of their limits; joints without the limit have zeros.
struct Dilation {
  std::size_t joints = 0;
  std::size_t cells = 0;
  double step = 0.0;                    ///< [s] of a cell.
  std::vector<double> ceiling;          ///< [node] of r, from velocities; infinite: none.
  std::vector<double> first_by_accel;   ///< [node][joint] Q' over the acceleration limit
  std::vector<double> second_by_accel;  ///< and Q''.
  std::vector<double> first_by_jerk;    ///< [node][joint] The same over the jerk limit.
  std::vector<double> second_by_jerk;
  std::vector<double> third_by_jerk;  ///< [cell][0: its start, 1: its end][joint] Q''', which may step at nodes.
  std::optional<double> first;        ///< r at the first node, where r' is zero then; else free.
  std::optional<double> last;         ///< The same at the last node.
};

/// r as a C1 spline of parabolas, one for each cell: control points, cells + 2 of them. At node i it is the mean of
/// points i and i + 1, its derivative their difference by the step.
struct DilationSpline {
  std::vector<double> points;
  double at(std::size_t node) const { return 0.5 * (points[node] + points[node + 1]); }
  double slopeAt(std::size_t node, double step) const { return (points[node + 1] - points[node]) / step; }
};

struct DilationResult {
  bool found = false;    ///< Else the given ends are too fast.
  double reached = 1.0;  ///< The least share of a given end's rate (not its square) that was come to.
  DilationSpline r;
};

/// The r of the shortest duration, within the limits at every node (jerk: at both sides of it). Velocity and
/// acceleration are linear in r; jerk becomes |linear| <= r^(-1/2), whose right side is convex: each step takes its
/// tangent, so the iterates stay feasible, and ends in a local optimum. Primal-dual interior point method; each step
/// solves one system of five diagonals, so all is linear in the cells. Sources: Verscheure et al., Time-optimal path
/// tracking for robots, IEEE TAC 2009 (the convex form); Debrouwere et al., IEEE T-RO 2013 (jerk as convex-concave
/// constraints); Nocedal & Wright, Numerical Optimization, ch. 19. Allocates.
/// Given ends are reached first, from a slow motion on, by the same method with them as what is sought.
DilationResult fastestDilation(const Dilation& problem);

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_DILATION_H
