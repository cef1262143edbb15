#ifndef SCREWLINE_TRAJECTORY_BREAK_TABLE_H
#define SCREWLINE_TRAJECTORY_BREAK_TABLE_H

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace screwline {

/// Finds the segment that holds a value in about the same time for 10 and for 10,000 segments, with nothing remembered
/// between calls: equal buckets over the range name the segments that they touch; those few are searched by halves.
class BreakTable {
 public:
  BreakTable() = default;  ///< One segment, whatever the value.

  /// @param breaks not decreasing, segments + 1 of them. Allocates.
  explicit BreakTable(const std::vector<double>& breaks) {
    const std::size_t segments = breaks.size() < 2 ? 0 : breaks.size() - 1;
    if (segments < 2 || !(breaks.back() > breaks.front())) return;
    inner_.assign(breaks.begin() + 1, breaks.end() - 1);
    inner_.push_back(std::numeric_limits<double>::infinity());  // So that find() may look at one in any bucket.
    const std::size_t buckets = 2 * segments;
    first_ = breaks.front();
    scale_ = static_cast<double>(buckets) / (breaks.back() - breaks.front());
    last_ = static_cast<double>(buckets - 1);
    before_.assign(buckets + 1, 0);
    for (std::size_t k = 0; k + 1 < inner_.size(); ++k) ++before_[bucketOf(inner_[k]) + 1];
    for (std::size_t k = 1; k <= buckets; ++k) before_[k] += before_[k - 1];
  }

  /// The segment that holds t, at a breakpoint the later one; outside the range the nearer end's. Does not allocate.
  std::size_t find(double t) const {
    if (inner_.empty()) return 0;
    const std::size_t bucket = bucketOf(t);
    std::size_t low = before_[bucket];
    std::size_t high = before_[bucket + 1];
    // Most buckets hold one break or none: that needs no branch.
    if (high - low < 2) return low + static_cast<std::size_t>((high > low) & (inner_[low] <= t));
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (inner_[middle] <= t) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }

 private:
  /// Does not decrease with t, so that all breaks of a lower bucket are below t and all of a higher one above.
  std::size_t bucketOf(double t) const {
    const double place = std::max(std::min(last_, (t - first_) * scale_), 0.0);
    return static_cast<std::size_t>(static_cast<std::int64_t>(place));  // To a signed integer it is one instruction.
  }

  std::vector<double> inner_;          ///< The breaks but for the first and the last, then infinity.
  std::vector<std::uint32_t> before_;  ///< [bucket] how many of them lie in the buckets before it.
  double first_ = 0.0;
  double scale_ = 0.0;
  double last_ = 0.0;  ///< Bucket.
};

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_BREAK_TABLE_H
