#ifndef SCREWLINE_SRC_SYMBOLIC_CPP_ROOTS_H
#define SCREWLINE_SRC_SYMBOLIC_CPP_ROOTS_H

namespace screwline {

/// Functions of a written header that solve quartics: realRoots() of polynomials, anglesOf() of sums of cosines and
/// sines of an angle and of its double. They need kPi, <cmath> and <vector>.
extern const char* const kCppRoots;

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_CPP_ROOTS_H
