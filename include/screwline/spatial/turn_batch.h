#ifndef SCREWLINE_SPATIAL_TURN_BATCH_H
#define SCREWLINE_SPATIAL_TURN_BATCH_H

#include <array>
#include <cstddef>

#include "screwline/spatial/atan2.h"
#include "screwline/spatial/turn.h"

namespace screwline {

/// Turns whose angles are taken together: atan2Many() takes four in the time of one. No allocation.
class TurnBatch {
 public:
  static constexpr std::size_t kMost = 48;  ///< Of six joints and eight solutions.

  /// Where its angle will be. @pre fewer than kMost are in
  std::size_t add(const Turn& turn) {
    cosines_[count_] = turn.c;
    sines_[count_] = turn.s;
    return count_++;
  }

  /// Takes the angles of all that were added.
  void takeAngles() { atan2Many(sines_.data(), cosines_.data(), angles_.data(), static_cast<int>(count_)); }

  std::size_t count() const { return count_; }
  double operator[](std::size_t place) const { return angles_[place]; }  ///< [rad] in [-pi, pi].

 private:
  std::array<double, kMost> cosines_;
  std::array<double, kMost> sines_;
  std::array<double, kMost> angles_;
  std::size_t count_ = 0;
};

}  // namespace screwline

#endif  // SCREWLINE_SPATIAL_TURN_BATCH_H
