#include <algorithm>
#include <cmath>

#include "screwline/exception.h"
#include "screwline/trajectory/format.h"
#include "screwline/trajectory/joint_trajectory.h"

namespace screwline {

std::vector<double> sampleTimes(const JointTrajectory& trajectory, double period, bool with_corners) {
  constexpr double kMostSamples = 1e6;
  if (!(period > 0.0) || !std::isfinite(period)) {
    throw InputError(AnswerCode::kInvalidGoal, "sample_period is " + number(period) + " s, it must be positive");
  }
  const double duration = trajectory.duration();
  if (duration / period > kMostSamples) {
    throw InputError(AnswerCode::kTooLarge, "a duration of " + number(duration) + " s at sample_period " +
                                                number(period) + " s makes more than 1000000 samples");
  }
  std::vector<double> times;
  const double slack = 1e-6 * period;  // Else a duration of n periods would get two samples a rounding apart.
  for (std::size_t i = 0; static_cast<double>(i) * period < duration - slack; ++i)
    times.push_back(static_cast<double>(i) * period);
  if (with_corners) {
    for (double corner : trajectory.corners()) times.push_back(corner);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
  }
  times.push_back(duration);
  return times;
}

}  // namespace screwline
