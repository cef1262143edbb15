#ifndef SCREWLINE_SRC_SYMBOLIC_INVERSE_ROOTS_H
#define SCREWLINE_SRC_SYMBOLIC_INVERSE_ROOTS_H

#include <array>
#include <vector>

namespace screwline {

/// All angles [rad] in (-pi, pi] where k + a cos x + b sin x + c cos 2x + d sin 2x is zero, as eigenvalues on the unit
/// circle. Two that meet may come twice, as near to each other as rounding puts them. Allocates.
std::vector<double> zeroAngles(const std::array<double, 5>& coefficients);

/// Real roots of c0 + c1 x + ... + c4 x^4, as eigenvalues. Allocates.
std::vector<double> realRoots(const std::array<double, 5>& coefficients);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_INVERSE_ROOTS_H
