#ifndef SCREWLINE_IK_METHOD_SUMMARY_H
#define SCREWLINE_IK_METHOD_SUMMARY_H

#include <memory>
#include <string>
#include <vector>

#include "screwline/ik/inverse_kinematics.h"

namespace screwline {

/// For people, a line each: what the axes share, the method that follows from it, whether it finds every solution, the
/// branches that solutions can have. No formulas. Allocates.
std::vector<std::string> summaryOf(const InverseKinematics& ik);

/// All solutions of a pose, limits not looked at; of a chain of seven joints those with the value of the parameter
/// joint that is given, where outline() names it. @pre `ik` outlives what is returned.
InverseSolver everySolution(const InverseKinematics& ik);

/// What is written about a solver, which it keeps alive.
InverseMethod inverseMethodOf(std::shared_ptr<const InverseKinematics> ik);

}  // namespace screwline

#endif  // SCREWLINE_IK_METHOD_SUMMARY_H
