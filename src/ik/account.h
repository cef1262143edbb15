#ifndef SCREWLINE_SRC_IK_ACCOUNT_H
#define SCREWLINE_SRC_IK_ACCOUNT_H

#include <string>

#include "screwline/ik/inverse_kinematics.h"

namespace screwline {

/// A result in one line, for people. `doubt`: why its list may be incomplete, where it may be.
std::string accountOf(const IkRequest& request, const IkResult& result, const std::string& doubt);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_ACCOUNT_H
