#ifndef SCREWLINE_SRC_SYMBOLIC_HALF_ANGLE_H
#define SCREWLINE_SRC_SYMBOLIC_HALF_ANGLE_H

#include <cstddef>
#include <map>
#include <vector>

#include "trig_polynomial.h"

namespace screwline {

/// A polynomial in radicals and scalars as in its ring, and in u = sin(angle / 2), v = cos(angle / 2) of each angle,
/// homogeneous of degree degrees[k] in the two of angles[k]: sin = 2 u v, cos = v^2 - u^2, 1 = u^2 + v^2. Unlike sines
/// and cosines these have unique factors. Keys hold the exponents of radicals and scalars, then those of the u.
struct HalfAnglePolynomial {
  std::vector<int> angles;
  std::vector<int> degrees;
  TrigPolynomial::Terms terms;

  std::size_t entry(const TrigRing& ring, std::size_t k) const {
    return static_cast<std::size_t>(ring.scalarOffset(ring.scalars().size())) + k;
  }
};

HalfAnglePolynomial toHalfAngles(const TrigPolynomial& polynomial);
/// Whether it takes no more than `most_terms`, on the way there too; found in time of that order.
bool isShortInHalfAngles(const TrigPolynomial& polynomial, std::size_t most_terms);
/// @pre all degrees are even.
TrigPolynomial fromHalfAngles(const RingPointer& ring, const HalfAnglePolynomial& polynomial);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_HALF_ANGLE_H
