#ifndef SCREWLINE_SRC_TRAJECTORY_LEAD_LAW_H
#define SCREWLINE_SRC_TRAJECTORY_LEAD_LAW_H

#include <vector>

#include "screwline/trajectory/retime.h"

namespace screwline {

/// A way u(s) along a path on a uniform grid of s: d^3u/ds^3 is constant on each cell, so C2. It begins and ends
/// with no acceleration. Limits are not its business: it is what a dilation of time starts from.
struct LeadLaw {
  double step = 0.0;           ///< [s]
  std::vector<double> u;       ///< [node]
  std::vector<double> rate;    ///< du/ds
  std::vector<double> change;  ///< d^2u/ds^2

  std::size_t cells() const { return u.size() - 1; }
};

/// The fastest motion under velocities and accelerations with its acceleration averaged over the time that jerk takes
/// to build it up: near to the fastest with that jerk, and smooth where this is.
/// @param timed of the path, as `retime` gives it. @param ramp [s] > 0. @param cells >= 8.
LeadLaw leadLaw(const RetimeResult& timed, double length, double ramp, int cells);

/// The rate at which the path's third derivative alone uses the jerk limits, nearly, or what is `asked` for if that is
/// less: where a corner is narrow, a lead that knows nothing of jerk would pass it so fast that its few cells there had
/// to be slowed down a hundredfold. Keeps references to all three.
RateBound steadyRate(const JointPath& path, const Limits& limits, const RateBound& asked);

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_LEAD_LAW_H
