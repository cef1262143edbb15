#ifndef SCREWLINE_ROS_BAG_RECORDER_H
#define SCREWLINE_ROS_BAG_RECORDER_H

#include <ros/message_event.h>
#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "screwline/exception.h"

namespace screwline {
namespace ros_bridge {

/// The bag cannot be opened, or does not hold all that was taken for it. The message names the file and the reason.
class RecordingError : public Exception {
 public:
  using Exception::Exception;
};

struct RecorderBounds {
  std::uint64_t most_waiting = std::uint64_t{1} << 30;  ///< [bytes] taken and not yet written.
  std::uint64_t reserve = std::uint64_t{16} << 20;      ///< [bytes] of the disk left free, for the bag's index.
};

/// Messages of any type, as they come, into one bag. They are written by a thread of its own: who takes them never
/// waits for the disk. Nothing is dropped: where a message cannot be kept the recording ends, and says so.
class BagRecorder {
 public:
  /// As a subscriber gets it: not deserialised, with its connection's header, which says whether the topic is latched.
  using Message = ros::MessageEvent<const topic_tools::ShapeShifter>;

  /// Writes to `path`.active, which is renamed to `path` once it is closed. @throws RecordingError: there is such a
  /// file already, or it cannot be written.
  explicit BagRecorder(const std::string& path, const RecorderBounds& bounds = {});
  /// Closes the bag; what fails then is not told.
  ~BagRecorder();
  BagRecorder(const BagRecorder&) = delete;
  BagRecorder& operator=(const BagRecorder&) = delete;

  /// Queues a message that came on a topic. Ignored once the recording has failed or is closed. From any thread.
  void take(const std::string& topic, const Message& message);
  /// Whether the recording has ended by itself; close() tells why.
  bool failed() const { return failed_; }
  /// Writes what waits, then the index; the number of messages in the bag. @throws RecordingError: a message that was
  /// taken is not in it. Even then it is closed and can be read, unless the message says otherwise.
  std::uint64_t close();

 private:
  struct Taken {
    std::string topic;
    ros::Time time;
    boost::shared_ptr<const topic_tools::ShapeShifter> message;
    boost::shared_ptr<ros::M_string> connection;
  };

  void open();
  void writeAll();
  bool nextBatch(std::vector<Taken>& batch);
  void write(const Taken& taken);
  void requireSpace();
  void finish();
  void fail(const std::string& reason);
  std::string active() const { return path_ + ".active"; }

  const std::string path_;
  const RecorderBounds bounds_;
  std::unique_ptr<rosbag::Bag> bag_;  // Empty once it is closed or broken.
  std::uint64_t count_ = 0;           // Messages written.
  std::uint64_t unchecked_ = 0;       // Bytes written since the disk's free space was asked for.

  std::mutex mutex_;  // Of what follows.
  std::condition_variable wake_;
  std::vector<Taken> waiting_;
  std::uint64_t held_ = 0;  // Bytes taken and not yet written.
  bool closing_ = false;
  std::string reason_;  // Of the failure.
  std::atomic<bool> failed_{false};
  std::thread writer_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_BAG_RECORDER_H
