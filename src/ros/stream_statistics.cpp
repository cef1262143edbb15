#include "screwline/ros/stream_statistics.h"

#include <algorithm>
#include <cmath>

#include "motion_instants.h"

namespace screwline {
namespace ros_bridge {

void StreamStatistics::take(const StreamSample& sample) {
  const double late = std::max(0.0, secondsOf(sample.sent - sample.stamp));
  const double bin = late > kFinest ? std::ceil(std::log(late / kFinest) / std::log(kGrowth)) : 0.0;
  ++bins_[std::min(static_cast<std::size_t>(bin), kBins - 1)];
  largest_ = std::max(largest_, late);
  missed_ += sample.skipped + (late >= period_ ? 1 : 0);
  if (samples_++ == 0) first_ = sample.sent;
  last_ = sample.sent;
}

double StreamStatistics::rate() const {
  return last_ > first_ ? static_cast<double>(samples_ - 1) / secondsOf(last_ - first_) : 0.0;
}

double StreamStatistics::jitter(double share) const {
  const double wanted = share * static_cast<double>(samples_);
  std::int64_t passed = 0;
  for (std::size_t k = 0; k < kBins; ++k) {
    passed += bins_[k];
    if (passed > 0 && static_cast<double>(passed) >= wanted) {
      return std::min(largest_, kFinest * std::pow(kGrowth, static_cast<double>(k)));
    }
  }
  return 0.0;
}

}  // namespace ros_bridge
}  // namespace screwline
