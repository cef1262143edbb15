#include "screwline/trajectory/verify.h"

#include <algorithm>
#include <cmath>

#include "screwline/trajectory/format.h"

namespace screwline {
namespace {

/// Pieces are built from one another's end values; what remains between them is rounding of the largest value involved.
constexpr double kStepTolerance = 1e-7;
constexpr double kPositionTolerance = 1e-9;

std::string joint(int index) {
  return "joint " + std::to_string(index) + ": ";
}

std::optional<std::string> checkFinite(const JointExtrema& e, int index) {
  const double values[] = {e.position.lower, e.position.upper, e.velocity, e.acceleration, e.jerk, e.travel};
  for (double value : values) {
    if (!std::isfinite(value)) return joint(index) + "a figure of the motion is not finite";
  }
  return std::nullopt;
}

std::optional<std::string> checkBounds(const JointExtrema& e, const Limits& limits, int index) {
  if (limits.lower.size() == 0) return std::nullopt;
  if (e.position.lower < limits.lower[index] - kPositionTolerance) {
    return joint(index) + "position reaches " + number(e.position.lower) + ", its lower limit is " +
           number(limits.lower[index]);
  }
  if (e.position.upper > limits.upper[index] + kPositionTolerance) {
    return joint(index) + "position reaches " + number(e.position.upper) + ", its upper limit is " +
           number(limits.upper[index]);
  }
  return std::nullopt;
}

double shortestPiece(const PiecewisePolynomial& motion) {
  double shortest = motion.duration();
  for (std::size_t k = 0; k < motion.segments(); ++k) {
    if (motion.length(k) > 0.0) shortest = std::min(shortest, motion.length(k));
  }
  return shortest;
}

std::optional<std::string> checkSteps(const PiecewisePolynomial& motion, const JointExtrema& e, int index) {
  const double scale[] = {std::max(1.0, e.position.peak()), e.velocity, e.acceleration, e.jerk};
  const double shortest = shortestPiece(motion);
  for (int order = 0; order <= std::max(motion.continuity, motion.rest_continuity); ++order) {
    const double inside = order <= motion.continuity ? stepInside(motion, index, order) : 0.0;
    const double from_rest = order <= motion.rest_continuity ? stepFromRest(motion, index, order) : 0.0;
    // Rounding of positions over the shortest piece is the floor of what derivatives can cancel to.
    const double floor = shortest > 0.0 ? 1e-13 * scale[0] / std::pow(shortest, order) : 0.0;
    const double step = std::max(inside, from_rest);
    if (step <= kStepTolerance * scale[order] + floor) continue;
    return joint(index) + "derivative " + std::to_string(order) + " steps by " + number(step) +
           ", the motion promises that it does not";
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> verifyTrajectory(const JointTrajectory& trajectory, const Limits& limits,
                                            const std::vector<Checkpoint>& checkpoints) {
  if (limits.joints() != trajectory.joints())
    return "the motion has " + std::to_string(trajectory.joints()) + " joints";
  if (!std::isfinite(trajectory.duration())) return "the duration is not finite";
  for (int j = 0; j < trajectory.joints(); ++j) {
    const JointExtrema extrema = trajectory.extrema(j);
    if (auto broken = checkFinite(extrema, j)) return broken;
    if (auto broken = checkBounds(extrema, limits, j)) return broken;
    if (trajectory.pieces() == nullptr) continue;
    if (auto broken = checkSteps(*trajectory.pieces(), extrema, j)) return broken;
  }
  if (const TimeLaw* scaling = trajectory.scaling(); scaling != nullptr && !scaling->isCycloidal()) {
    if (auto broken = checkSteps(scaling->pieces(), scaling->extrema(), 0)) return "time scaling, " + *broken;
  }
  const LimitUse use = tightestUse(trajectory, limits);
  if (use.value > use.bound * (1.0 + 2.0 * kLimitTolerance)) return describe(use);

  TrajectoryPoint point(trajectory.joints());
  for (const auto& checkpoint : checkpoints) {
    trajectory.sample(checkpoint.time, point);
    for (int j = 0; j < trajectory.joints(); ++j) {
      const double miss = std::abs(point.position[j] - checkpoint.position[j]);
      if (miss <= kPositionTolerance * std::max(1.0, std::abs(checkpoint.position[j]))) continue;
      return joint(j) + "misses its waypoint at " + number(checkpoint.time) + " s by " + number(miss);
    }
  }
  return std::nullopt;
}

}  // namespace screwline
