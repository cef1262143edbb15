#ifndef SCREWLINE_SRC_TRAJECTORY_SEGMENT_SEARCH_H
#define SCREWLINE_SRC_TRAJECTORY_SEGMENT_SEARCH_H

#include <utility>
#include <vector>

#include "screwline/trajectory/segment_times.h"

namespace screwline {

/// Instants of waypoints of which some are given. Segments between two given ones share the time between these in
/// proportion to their weights; those behind the last given one, the tail, take their weights as they are [s].
class TimeFrame {
 public:
  /// @param given [waypoint] s, 0: open; those given increase. @pre two waypoints at least.
  explicit TimeFrame(std::vector<double> given);

  bool openEnd() const { return known_ + 1 < given_.size(); }  ///< The duration is open.
  bool allOpen() const { return known_ == 0; }                 ///< Nothing is given.
  bool allGiven() const;                                       ///< No instant is left to choose.
  std::size_t tail() const { return known_; }                  ///< The first segment behind the last given instant.
  double tailStart() const { return given_[known_]; }          ///< [s]
  /// [begin, end) of the segments that share their time with this one.
  std::pair<std::size_t, std::size_t> groupOf(std::size_t segment) const;

  /// [s] With the tail `scale` times as long as its weights.
  std::vector<double> instants(const std::vector<double>& weights, double scale = 1.0) const;

 private:
  std::vector<double> given_;
  std::size_t known_ = 0;  ///< The last waypoint with a given instant.
};

/// Weights of the segments for the shortest motion within the limits through instants that are given in part; with
/// the end given too, for the motion that uses the least of the limits. Starts from `weights` and is by its own measure
/// never worse than these: first every segment that has room is shortened and every one that is tight lengthened, among
/// those that share their time (of the optimum most meet a limit), then single ones are left room again, or are
/// lengthened, where the whole gains by it. Steps and their number are fixed, so the same request gets the same answer,
/// and one in which nothing is given gets the reversed one for the same backwards. Limits are looked at in a few places
/// of each piece: the caller scales the result by exact extrema.
/// @param homogeneous positions and ratios of times alone decide the motion's shape.
/// @pre weights positive, one per segment. Cost bounded: about 0.2 s, and linear in segments and joints beyond that.
std::vector<double> searchedWeights(const ShapeBuilder& build, const MatrixX& positions, const Limits& limits,
                                    const TimeFrame& frame, bool homogeneous, const std::vector<double>& weights);

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_SEGMENT_SEARCH_H
