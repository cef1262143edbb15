#ifndef SCREWLINE_SRC_TRAJECTORY_TIME_RANGES_H
#define SCREWLINE_SRC_TRAJECTORY_TIME_RANGES_H

#include <functional>
#include <string>

#include "screwline/trajectory/plan.h"

namespace screwline {

/// Of a request whose given times no motion within the limits meets: the first time of which another value alone would
/// do, with the range of such values around the one nearest to it, as the end of a message. Both ends have been
/// planned. Empty where no intermediate time is given, none does alone, or the request is too large to be asked often.
/// @param feasible whether a request can be planned: asked at most some hundred times.
std::string feasibleTimes(const PlanRequest& request, const std::function<bool(const PlanRequest&)>& feasible);

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_TIME_RANGES_H
