#ifndef SCREWLINE_SYMBOLIC_RIGHT_ANGLES_H
#define SCREWLINE_SYMBOLIC_RIGHT_ANGLES_H

#include <optional>

#include "screwline/model/serial_chain.h"

namespace screwline {

/// [rad] Robot descriptions often have 1.5708 and 3.1416 for right angles, which are 4e-6 and 7e-6 off; over a chain
/// these add up to a few times 1e-5.
constexpr double kRightAngleTolerance = 5e-5;

/// A chain with its axes put along the base's axes, and how far it is from the one it was made of.
struct SquaredChain {
  SerialChain chain;
  double largest_turn = 0.0;    ///< [rad] Of any axis, or of the tip's frame.
  double position_error = 0.0;  ///< [m] Largest distance of the tips, at 100 configurations.
  double rotation_error = 0.0;  ///< [rad] Largest angle between the tips, at the same.
};

/// Axes and tip frame within `tolerance` [rad] of the directions of the base's axes are turned into them; coordinates
/// of axes and tip that then differ by less than `tolerance` times the chain's length become equal, or zero. None where
/// nothing is off by more than kExactAngle, so that an exact chain stays as it is. Allocates.
std::optional<SquaredChain> withRightAngles(const SerialChain& chain, double tolerance = kRightAngleTolerance);

}  // namespace screwline

#endif  // SCREWLINE_SYMBOLIC_RIGHT_ANGLES_H
