#ifndef SCREWLINE_ROS_STREAM_STATISTICS_H
#define SCREWLINE_ROS_STREAM_STATISTICS_H

#include <array>
#include <cstddef>
#include <cstdint>

#include "screwline/ros/motion_executor.h"

namespace screwline {
namespace ros_bridge {

/// How punctual a stream is, over any number of samples: a histogram of lateness (hand-over minus stamp) in bins that
/// grow by 5 %, so that a percentile is at most 5 % too high. Fixed size; nothing allocates. From one thread.
class StreamStatistics {
 public:
  explicit StreamStatistics(double rate) : period_(1.0 / rate) {}

  void take(const StreamSample& sample);
  void clear() { *this = StreamStatistics(1.0 / period_); }

  std::int64_t samples() const { return samples_; }
  std::int64_t missed() const { return missed_; }  ///< Sent after the next one was due, or left out.
  double rate() const;                             ///< [Hz] Of hand-overs; 0 for less than two samples.
  double jitter(double share) const;               ///< [s] Lateness that this share of the samples does not exceed.
  double largestJitter() const { return largest_; }

 private:
  static constexpr double kFinest = 1e-7;  ///< [s]
  static constexpr double kGrowth = 1.05;
  static constexpr std::size_t kBins = 400;  ///< To 30 s.

  double period_;
  std::int64_t samples_ = 0;
  std::int64_t missed_ = 0;
  Nanoseconds first_ = 0;
  Nanoseconds last_ = 0;
  double largest_ = 0.0;
  std::array<std::int64_t, kBins> bins_{};
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_STREAM_STATISTICS_H
