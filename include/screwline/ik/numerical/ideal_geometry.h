#ifndef SCREWLINE_IK_NUMERICAL_IDEAL_GEOMETRY_H
#define SCREWLINE_IK_NUMERICAL_IDEAL_GEOMETRY_H

#include <optional>

#include "screwline/model/serial_chain.h"

namespace screwline {

/// Up to where an angle or a length counts as meant to be special. The defaults take in "3.14" for pi, and calibration
/// errors of 0.5 mm and 0.5 mrad per parameter of an arm of 1 m, which add up in what neighbouring axes share.
struct IdealTolerance {
  double angle = 4e-3;   ///< [rad] between axes, beside 0 and pi/2.
  double length = 4e-3;  ///< Of the chain's characteristic length.
};

/// A chain with the special geometry that another one almost has.
struct IdealGeometry {
  SerialChain chain;          ///< Same joints, limits, links and tip at zero; axes moved.
  double largest_turn = 0.0;  ///< [rad] that an axis was turned by.
  double largest_move = 0.0;  ///< [m] that an axis's point was moved by.
};

/// The chain's axes moved as little as makes these exact wherever they hold within the tolerance: neighbouring axes
/// parallel, at right angles, meeting, on one line, or the feet of an axis's two common normals in one point (together:
/// three axes that meet in one point). Neighbours in direction are also axes with slides between them, which turn
/// nothing. Empty where nothing needs to be moved by more than 1e-10, or where what almost holds cannot hold at once.
/// The method: Newton steps of least norm on all conditions together, lengths in units of the characteristic length.
/// Allocates; about a millisecond.
std::optional<IdealGeometry> idealized(const SerialChain& chain, const IdealTolerance& tolerance = {});

/// The chain with one joint fixed at a value: one joint less. Its tip and the axes beyond are moved to where they are
/// then at zero; links that hang on the chain are left out, apart from base and tip.
/// @throws ModelError where no joint is left; @pre 0 <= joint < size(), no mimic joints.
SerialChain withFixedJoint(const SerialChain& chain, int joint, double value);

}  // namespace screwline

#endif  // SCREWLINE_IK_NUMERICAL_IDEAL_GEOMETRY_H
