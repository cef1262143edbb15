#include "account.h"

namespace screwline {

std::string accountOf(const IkRequest& request, const IkResult& result, const std::string& doubt) {
  const std::string excluded = result.outside_limits > 0
                                   ? ", " + std::to_string(result.outside_limits) + " more break joint limits"
                                   : std::string();
  std::string incomplete;
  if (result.left_out > 0) {
    incomplete = "; " + std::to_string(result.left_out) + " left out by max_solutions";
  } else if (!result.complete) {
    incomplete = "; the list may be incomplete: " + doubt;
  }
  switch (result.status) {
    case IkStatus::kSolved: {
      const std::size_t count = result.solutions.size();
      return std::to_string(count) + (count == 1 ? " solution" : " solutions") + excluded + incomplete;
    }
    case IkStatus::kOutsideLimits:
      if (result.outside_limits > 0) {
        return "no solution within limits: " + std::to_string(result.outside_limits) + " break joint limits" +
               incomplete;
      }
      return "no solution on branch '" + request.branch + "'" + incomplete;
    case IkStatus::kUnreachable:
      return "proved unreachable: no joint values reach the pose" +
             (request.find_closest ? "; nearest reachable at distance " + std::to_string(result.distance_to_reachable)
                                   : std::string());
    case IkStatus::kNotFound:
      break;
  }
  return std::string("no solution found, which proves nothing") + (result.timed_out ? " (time ran out)" : "");
}

}  // namespace screwline
