#include "screwline/ros/response_check.h"

namespace screwline {
namespace ros_bridge {

Allowed allowed(const ComputeIK::Response& response, const double* number) {
  const auto open = [number](const IkSolution& solution) {
    return number == &solution.joint_error || lies(number, solution.self_motion_lower) ||
           lies(number, solution.self_motion_upper);
  };
  bool infinite = open(response.closest);
  for (const IkSolution& solution : response.solutions) infinite = infinite || open(solution);
  return infinite ? Allowed::kInfinity : Allowed::kFinite;
}

}  // namespace ros_bridge
}  // namespace screwline
