#ifndef SCREWLINE_SRC_IK_SEARCHED_CONTINUA_H
#define SCREWLINE_SRC_IK_SEARCHED_CONTINUA_H

#include <vector>

#include "solution_builder.h"

namespace screwline {

/// Members beyond so many show no more continua: a search may stop at them.
constexpr int kMostMembers = 24;

/// Of the answers that a search met some are members of one continuum: where joints are free to move the pose is left
/// alone by more than rounding. Each continuum becomes one answer, the member nearest to the seed that walks along it
/// lead to, with its directions and the range that walks towards each free joint's ends reach: what lies between is
/// proved, what lies beyond is not denied. Members that no walk joins stay apart. Isolated answers are left as they
/// are. Joins none once the request's time is over. Allocates.
std::vector<IkAnswer> joinSearchedContinua(const SerialChain& chain, const Task& task, const IkRequest& request,
                                           const SolutionBuilder& builder, std::vector<IkAnswer> answers);

}  // namespace screwline

#endif  // SCREWLINE_SRC_IK_SEARCHED_CONTINUA_H
