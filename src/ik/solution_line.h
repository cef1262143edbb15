#ifndef SCREWLINE_SRC_IK_SOLUTION_LINE_H
#define SCREWLINE_SRC_IK_SOLUTION_LINE_H

#include <optional>

#include "candidate.h"

namespace screwline {

/// A continuum that is a straight line in joint space: joints that turn about one line (an aligned wrist), a joint
/// whose axis goes through the point that is asked for, slides in line. Known by members far apart that lie on a line
/// to rounding: along other continua joints move as roots of trigonometric equations do, which no straight line
/// follows. Described in closed form: each joint's turns and limits cut the line into pieces, on each of which the
/// distance to the seed is a parabola. Empty where the continuum is bent.
/// @param q a member. @param joint the one that is free.
std::optional<Continuum> describeLine(const SerialChain& chain, const MemberAt& at, const VectorX& q, int joint,
                                      const VectorX& seed, bool ignore_limits);

/// Where the continuum is a straight line in the value of `joint` alone, widens the ranges of the joints that move by
/// what they go from `continuum.nearest` to both sides until one of them meets a limit. False where it is bent.
bool widenAlongLine(const SerialChain& chain, const MemberAt& at, int joint, Continuum& continuum);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_SOLUTION_LINE_H
