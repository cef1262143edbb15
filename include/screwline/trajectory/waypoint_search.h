#ifndef SCREWLINE_TRAJECTORY_WAYPOINT_SEARCH_H
#define SCREWLINE_TRAJECTORY_WAYPOINT_SEARCH_H

#include <array>
#include <memory>
#include <vector>

#include "screwline/trajectory/state_to_state.h"

namespace screwline {

/// A waypoint of a motion that does not stop there: states of all joints, and whether the search may choose velocity
/// and acceleration.
struct ViaState {
  std::array<EndState, kMaxJoints> joints;
  bool free = true;
};

/// The sum of the time-optimal durations from waypoint to waypoint, made shorter by the choice of the velocities and
/// accelerations at the free ones: a pattern search from a stop at each and from a guess, with a bounded number of
/// steps and the same result in every run. Never longer than with a stop at each free waypoint.
class WaypointSearch {
 public:
  /// @pre at least two waypoints; the first and the last are not free. `limits` as in StateToState.
  WaypointSearch(int joints, const std::array<AxisLimits, kMaxJoints>& limits, std::vector<ViaState> waypoints);

  /// Chooses the free states. @return false where a segment has no motion even with a stop at each of them.
  bool run();

  const std::vector<ViaState>& waypoints() const { return waypoints_; }
  /// Plans segment k (from waypoint k) with the present states: whether it can be driven; motion() says how, or why
  /// not.
  bool feasible(std::size_t k);
  StateToStateMotion& motion() { return *motion_; }
  double duration() const;
  double stopDuration() const { return stop_duration_; }  ///< With a stop at each free waypoint; infinite: no motion.

 private:
  double plan(std::size_t k);  ///< Cost of segment k: its duration, and others_weight_ times the joints' own mean.
  bool planAll();
  void guess();
  void improve();
  bool tryStep(std::size_t k, std::size_t joint, double velocity, double acceleration);
  bool tryScale(std::size_t k, double factor);
  bool accept(std::size_t k, const ViaState& before);

  std::unique_ptr<StateToState> question_;
  std::unique_ptr<StateToStateMotion> motion_;
  std::vector<ViaState> waypoints_;
  std::vector<double> durations_;
  double stop_duration_ = 0.0;
  double others_weight_ = 0.0;
};

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_WAYPOINT_SEARCH_H
