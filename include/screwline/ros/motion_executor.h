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
};
using StreamSink = std::function<void(const StreamSample& sample)>;

/// Streams one motion after another at a fixed rate. Samples lie at multiples of the period from the first one on;
/// motions start at such an instant, and the end of each has a sample of its own, exactly there. A sample's state is
/// that of its stamp: what is sent late says so by its stamp, and the missed ones follow (up to a second of them).
/// Before and after a motion its end is held at rest. Stamps increase strictly unless the clock is set back by more
/// than a second: the motion then goes on from where it was.
class MotionExecutor {
 public:
  /// The motion from the state at the instant at which it will start. May take a while, may throw.
  using MotionMaker = std::function<Motion(const MotionState& present)>;

  /// A motion that is about to run.
  struct Started {
    Nanoseconds stamp = 0;  ///< Of its first sample.
    std::shared_ptr<const Motion> motion;
  };

  /// @pre rate [Hz] is positive. The sink is called from one thread, without a lock held.
  MotionExecutor(const VectorX& initial_position, double rate, MotionClock clock, StreamSink sink);
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
  Started replace(const MotionMaker& make);

  /// The state now.
  MotionState state() const;

 private:
  struct Active {
    std::shared_ptr<const Motion> motion;
    Nanoseconds start = 0;
    Nanoseconds end = 0;
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
  void followClock(Nanoseconds now);
  Event nextEvent() const;
  bool waitForEvent();

  const double rate_;
  const MotionClock clock_;
  const StreamSink sink_;

  mutable std::mutex mutex_;  ///< Of what follows, up to the blank line; held briefly.
  Nanoseconds origin_ = 0;    ///< Instant of tick 0; 0: no time yet.
  std::int64_t tick_ = 0;     ///< The next one.
  Nanoseconds last_stamp_ = 0;
  Active active_;
  std::optional<Active> next_;
  bool over_ = true;  ///< The end of the active motion is sent.

  std::mutex replacing_;
  TrajectoryPoint point_;  ///< Of the streaming thread.
  std::atomic<bool> running_{true};
  std::thread thread_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_MOTION_EXECUTOR_H
