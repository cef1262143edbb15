#ifndef SCREWLINE_ROS_STREAM_REPORTER_H
#define SCREWLINE_ROS_STREAM_REPORTER_H

#include <diagnostic_msgs/DiagnosticArray.h>

#include <functional>
#include <memory>
#include <mutex>

#include "screwline/ros/stream_statistics.h"
#include "screwline/ros/tracking_error.h"

namespace screwline {
namespace ros_bridge {

/// Tells how the stream keeps its deadlines, and how well a controlled robot follows: once a second of what was since
/// the last time, and at the end of a motion. take() from the streaming thread, track() from any.
class StreamReporter {
 public:
  using Sink = std::function<void(const diagnostic_msgs::DiagnosticArray&)>;

  StreamReporter(std::shared_ptr<const SerialChain> chain, double rate, Sink sink);

  void take(const StreamSample& sample);

  /// A measured state of the motion that runs, and the positions that were due then. @throws InputError
  /// (kInvalidRobotState)
  void track(const sensor_msgs::JointState& measured, const VectorX& due);

  /// Errors since the motion began; no joints measured: not any().
  TrackingError tracking() const;

 private:
  void report(Nanoseconds stamp);
  diagnostic_msgs::DiagnosticStatus status(const StreamStatistics& figures, const std::string& what) const;
  void addTracking(diagnostic_msgs::DiagnosticStatus& status) const;

  std::shared_ptr<const SerialChain> chain_;
  double rate_;
  Sink sink_;
  StreamStatistics lately_;
  StreamStatistics motion_;
  Nanoseconds reported_ = 0;
  mutable std::mutex mutex_;  ///< Of the tracking.
  TrackingError tracking_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_STREAM_REPORTER_H
