#ifndef SCREWLINE_IK_BRANCH_NAME_H
#define SCREWLINE_IK_BRANCH_NAME_H

#include <string>
#include <vector>

namespace screwline {

/// The parts of a branch's name: "shoulder front, elbow up" as {"shoulder front", "elbow up"}. Allocates.
std::vector<std::string> branchPartsOf(const std::string& branch);

/// Whether a solution's branch has every part that is wished; "elbow straight" is on both elbow branches.
bool matchesBranch(const std::string& branch, const std::string& wish);

}  // namespace screwline

#endif  // SCREWLINE_IK_BRANCH_NAME_H
