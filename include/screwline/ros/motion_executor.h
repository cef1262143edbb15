#ifndef SCREWLINE_ROS_MOTION_EXECUTOR_H
#define SCREWLINE_ROS_MOTION_EXECUTOR_H

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "screwline/ros/motion.h"
#include "screwline/ros/motion_clock.h"

namespace screwline {
namespace ros_bridge {

/// One sample of the stream, valid during the call that gets it.
struct StreamSample {
  Nanoseconds stamp = 0;  ///< The instant that it is about.
  const TrajectoryPoint* state = nullptr;
  const TimeLaw* scaling = nullptr;  ///< s(tau) of the motion; null: none, or not in it yet.
  double tau = 0.0;                  ///< Where scaling is given.
  bool held = false;                 ///< The motion is over.
  bool first = false;                ///< Of a motion: its t = 0.
  bool last = false;                 ///< Of a motion: its t = T.
  Nanoseconds sent = 0;              ///< What the clock shows as the sample is handed over.
  std::int64_t skipped = 0;          ///< Samples before this one that were left out, being too late.
};
using StreamSink = std::function<void(const StreamSample& sample)>;

/// Streams one motion after another at a fixed rate. Samples lie at multiples of the period from the first one on;
/// motions start at such an instant, and the end of each has a sample of its own, exactly there. A sample's state is
/// that of its stamp: what is sent late says so by its stamp, and the missed ones follow (up to a second of them).
/// Before and after a motion its end is held at rest. Stamps increase strictly unless the clock is set back by more
/// than a second: the motion then goes on from where it was.
/// Motions keep to their path at any speed: pause() and setSpeed() turn the path's clock (path_clock.h) within the
/// limits. Pause and speed stay for the motions to come, until resume() or a motion in real time.
class MotionExecutor {
 public:
  /// The motion from the state at the instant at which it will start, in the path time that it will start with. May
  /// take a while, may throw.
  using MotionMaker = std::function<Motion(const MotionState& present)>;

  enum class Pace {
    kSpeed,     ///< At the speed that is set; not at all while paused.
    kRealTime,  ///< At full speed whatever is set; ends a pause.
  };

  /// What became of a change of speed.
  struct Turn {
    bool moving = false;      ///< Something runs that heeds it.
    double settles_in = 0.0;  ///< [s] Until the new rate.
    bool ends_first = false;  ///< The motion does, in that time.
  };

  /// A motion that is about to run.
  struct Started {
    Nanoseconds stamp = 0;  ///< Of its first sample.
    std::shared_ptr<const Motion> motion;
  };

  /// @pre rate [Hz] is positive. The sink is called from one thread, without a lock held.
  MotionExecutor(const VectorX& initial_position, double rate, Limits limits, MotionClock clock, StreamSink sink);
  ~MotionExecutor();
  MotionExecutor(const MotionExecutor&) = delete;
  MotionExecutor& operator=(const MotionExecutor&) = delete;

  void start();     ///< Streams from a thread of its own.
  void shutdown();  ///< Ends it; the motion is left where it is.

  /// Waits for the next sample's instant and sends it; what the thread does in a loop. False after shutdown().
  bool step();

  /// Replaces what runs at the next instant of the stream that the maker is quick enough for. What the maker throws
  /// passes, and the old motion goes on. @throws InputError (kFailure): the clock does not run, or the maker is too
  /// slow.
  Started replace(const MotionMaker& make, Pace pace = Pace::kSpeed);

  /// The rate at which paths are followed, in [0, 1]; 1 at first. @throws InputError (kInvalidGoal): outside, NaN;
  /// (kFailure) as replace().
  Turn setSpeed(double speed);
  Turn pause();
  Turn resume();
  double speed() const;
  bool paused() const;

  /// The state now.
  MotionState state() const;
  /// The state at an instant of what runs: none before it began, or where nothing does.
  std::optional<MotionState> stateInMotion(Nanoseconds instant) const;

 private:
  struct Active {
    std::shared_ptr<const Motion> motion;
    std::shared_ptr<const PathClock> clock;
    std::shared_ptr<const Limits> bounds;  ///< Of the clock.
    Pace pace = Pace::kSpeed;
    Nanoseconds start = 0;
    Nanoseconds end = 0;  ///< kNever where the clock stands before.
  };
  struct Event {
    Nanoseconds stamp = 0;
    bool grid = false;   ///< Takes the next multiple of the period.
    bool start = false;  ///< The next motion takes over.
    bool end = false;    ///< The motion's last instant.
  };

  Nanoseconds gridInstant(std::int64_t tick) const;
  std::int64_t firstTickAt(Nanoseconds instant) const;
  MotionState stateAt(Nanoseconds instant) const;
  double pathRate() const { return paused_ ? 0.0 : speed_; }
  Active follow(const MotionMaker& make, const MotionState& present, double rate, Pace pace) const;
  void setClock(Active& active, PathClock clock) const;
  Active* heeding();
  Turn turn(std::optional<double> speed, std::optional<bool> paused);
  void followClock(Nanoseconds now);
  Event nextEvent() const;
  bool waitForEvent();

  const double rate_;
  const Limits limits_;
  const MotionClock clock_;
  const StreamSink sink_;

  mutable std::mutex mutex_;  ///< Of what follows, up to the blank line; held briefly.
  Nanoseconds origin_ = 0;    ///< Instant of tick 0; 0: no time yet.
  std::int64_t tick_ = 0;     ///< The next one.
  Nanoseconds last_stamp_ = 0;
  Active active_;
  std::optional<Active> next_;
  bool over_ = true;  ///< The end of the active motion is sent.
  std::int64_t skipped_ = 0;
  double speed_ = 1.0;
  bool paused_ = false;

  std::mutex replacing_;
  TrajectoryPoint point_;  ///< Of the streaming thread.
  std::atomic<bool> running_{true};
  std::thread thread_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_MOTION_EXECUTOR_H
