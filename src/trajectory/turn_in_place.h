#ifndef SCREWLINE_SRC_TRAJECTORY_TURN_IN_PLACE_H
#define SCREWLINE_SRC_TRAJECTORY_TURN_IN_PLACE_H

#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"
#include "screwline/trajectory/piecewise_polynomial.h"

namespace screwline {

/// Whether the tip stays where it is, over the task, while the joints go straight from one configuration to another: a
/// self-motion that is a line, as that of aligned wrist axes (one turns forth, the other back). Looked at in 16 places.
/// @param tolerance [m and rad]
bool keepsPose(const SerialChain& chain, const Task& task, const VectorX& from, const VectorX& to, double tolerance);

/// That motion as a piece of a followed curve (branch_following.h): u stands still, the length is that of the joints'.
/// @pre from and to differ.
PiecewisePolynomial turnInPlace(const VectorX& from, const VectorX& to, double u);

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_TURN_IN_PLACE_H
