#ifndef SCREWLINE_TRAJECTORY_PATH_CLOCK_H
#define SCREWLINE_TRAJECTORY_PATH_CLOCK_H

#include <vector>

#include "screwline/trajectory/constant_jerk.h"
#include "screwline/trajectory/joint_trajectory.h"
#include "screwline/trajectory/limits.h"
#include "screwline/trajectory/stop.h"

namespace screwline {

/// Motions one after another as one path; the pointers are only looked through. Path time 0 is the start of the first.
using Path = std::vector<const JointTrajectory*>;

double durationOf(const Path& path);  ///< [s]

/// How far a path's own time has come, and how fast it passes.
struct PathInstant {
  double time = 0.0;    ///< [s] Path time.
  double rate = 1.0;    ///< Path time per time: 1 as planned, 0 paused.
  double change = 0.0;  ///< [1/s] Derivative of the rate.
  double bend = 0.0;    ///< [1/s^2] Its second derivative.
};

/// A state of the path, with derivatives by path time, becomes one of the robot: derivatives by time.
void pace(const PathInstant& instant, TrajectoryPoint& point);

/// How a path's own time passes: at a constant rate in [0, 1], then along ramps to others. The path is never left: the
/// robot is at Q(s(t)), whatever the clock does. An immutable value; reading it does not allocate.
///
/// What is guaranteed of q(t) = Q(s(t)), proved over every ramp by intervals (enclosure.h), not at samples:
/// - velocity Q' s' never exceeds the path's own, since 0 <= s' <= 1;
/// - acceleration Q'' s'^2 + Q' s'' and jerk Q''' s'^3 + 3 Q'' s' s'' + Q' s''' keep the bounds given;
/// - s'' is continuous, so that the acceleration is as continuous as the path's.
/// Where the path itself brakes at its limit, it cannot be braked harder: the ramp waits until there is room.
class PathClock {
 public:
  /// From path time 0 at a constant rate. @pre rate in [0, 1].
  explicit PathClock(double rate = 1.0);

  PathInstant at(double t) const;  ///< At t [s] since the motion began.
  double finalRate() const;
  double settled() const;  ///< [s] From when on the rate is the final one.

  /// The first t at which the path time is reached; infinity where it never is.
  double instantOf(double path_time) const;

  /// This clock until t, from then on to `rate` by the quickest ramps found that keep the bounds; or, where the path
  /// ends before, as near to it as that. A ramp that runs is left at once where the bounds allow, else followed to its
  /// end. Bounds: see boundsOf(). Allocates; takes from tens of micro-seconds to milliseconds.
  /// @throws InputError (kInvalidGoal): rate is not in [0, 1].
  PathClock turned(double t, double rate, const Path& path, const Limits& bounds) const;

 private:
  /// One phase of constant jerk of the path time; the last one has no end.
  struct Stretch {
    double begin = 0.0;
    EndState state;
    JerkPhase phase;
  };

  const Stretch& stretchAt(double t) const;
  void append(const JerkPhase& phase);

  std::vector<Stretch> stretches_;
};

/// Acceleration and jerk limits, where the path passes them by itself its own (finite) peaks: what a clock has to keep.
Limits boundsOf(const Path& path, const Limits& limits);

/// The least rate in [least, 1] at which a state, seen in path time (velocity / rate, acceleration / rate^2), is one
/// from which the limits can be kept; 1 where none is: there the state itself breaks them. For a path that takes over
/// in flight. @pre jerk limits are finite, least in [0, 1].
double slowestRate(const MotionState& state, const Limits& limits, double least);

/// The state in path time, at a constant rate. @pre rate > 0, or the state is at rest.
MotionState inPathTime(const MotionState& state, double rate);

}  // namespace screwline

#endif  // SCREWLINE_TRAJECTORY_PATH_CLOCK_H
