#include "bag_recorder.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

namespace screwline {
namespace ros_bridge {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kBytesPerCheck = 1 << 20;  ///< Written before the disk's free space is asked for again.

std::string inMegabytes(std::uint64_t bytes) {
  return std::to_string(bytes >> 20) + " MiB";
}

/// What errno says of the last call, where it says anything.
std::string systemReason() {
  return errno == 0 ? "" : std::string(": ") + std::strerror(errno);
}

}  // namespace

BagRecorder::BagRecorder(const std::string& path, const RecorderBounds& bounds) : path_(path), bounds_(bounds) {
  open();
  writer_ = std::thread([this] { writeAll(); });
}

BagRecorder::~BagRecorder() {
  try {
    close();
  } catch (const RecordingError&) {  // Who wants to know calls close().
  }
}

void BagRecorder::open() {
  std::error_code ignored;
  if (fs::exists(path_, ignored)) throw RecordingError("bag '" + path_ + "' exists already, it is not overwritten");
  // rosbag does not tell why a file cannot be opened; the system does.
  std::FILE* probe = std::fopen(active().c_str(), "wb");
  if (probe == nullptr) throw RecordingError("bag '" + active() + "' cannot be written: " + std::strerror(errno));
  std::fclose(probe);
  errno = 0;
  try {
    bag_ = std::make_unique<rosbag::Bag>(active(), rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    throw RecordingError("bag '" + active() + "' cannot be written: " + error.what() + systemReason());
  }
}

void BagRecorder::take(const std::string& topic, const Message& message) {
  Taken taken{topic, std::max(message.getReceiptTime(), ros::TIME_MIN), message.getConstMessage(),
              message.getConnectionHeaderPtr()};
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closing_ || failed_) return;
    held_ += taken.message->size();
    if (held_ <= bounds_.most_waiting) {
      waiting_.push_back(std::move(taken));
    } else {
      reason_ = "the disk is too slow: " + inMegabytes(held_) + " wait to be written";
      failed_ = true;
    }
  }
  wake_.notify_one();
}

void BagRecorder::writeAll() {
  std::vector<Taken> batch;
  try {
    while (nextBatch(batch)) {
      std::uint64_t bytes = 0;
      for (const Taken& taken : batch) {
        write(taken);
        bytes += taken.message->size();
      }
      const std::lock_guard<std::mutex> lock(mutex_);
      held_ -= bytes;
    }
    finish();
  } catch (const RecordingError& full) {
    fail(full.what());
    finish();
  }
}

/// What waits; false where nothing does, nor will.
bool BagRecorder::nextBatch(std::vector<Taken>& batch) {
  batch.clear();
  std::unique_lock<std::mutex> lock(mutex_);
  wake_.wait(lock, [this] { return !waiting_.empty() || closing_ || failed_; });
  std::swap(batch, waiting_);
  return !batch.empty();
}

void BagRecorder::write(const Taken& taken) {
  requireSpace();
  if (!bag_) return;
  errno = 0;
  try {
    bag_->write(taken.topic, taken.time, *taken.message, taken.connection);
  } catch (const rosbag::BagException& error) {
    fail(error.what() + systemReason() + "; '" + active() + "' can be read once it is reindexed");
    // Its destructor would write again, and throw.
    static_cast<void>(bag_.release());
    return;
  }
  ++count_;
  unchecked_ += taken.message->size();
}

/// @throws RecordingError while there is room for the index still.
void BagRecorder::requireSpace() {
  if (count_ > 0 && unchecked_ < kBytesPerCheck) return;
  unchecked_ = 0;
  std::error_code unknown;
  const fs::space_info space = fs::space(fs::absolute(active(), unknown).parent_path(), unknown);
  if (unknown || space.available >= bounds_.reserve) return;
  throw RecordingError("the disk is full: " + inMegabytes(space.available) + " are left, of which " +
                       inMegabytes(bounds_.reserve) + " are kept for the index");
}

void BagRecorder::finish() {
  if (!bag_) return;
  errno = 0;
  try {
    bag_->close();
    bag_.reset();
  } catch (const rosbag::BagException& error) {
    fail(error.what() + systemReason() + "; '" + active() + "' can be read once it is reindexed");
    static_cast<void>(bag_.release());
    return;
  }
  if (std::rename(active().c_str(), path_.c_str()) != 0) fail("it keeps the name '" + active() + "'" + systemReason());
}

void BagRecorder::fail(const std::string& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!failed_) reason_ = reason;
  failed_ = true;
}

std::uint64_t BagRecorder::close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closing_ = true;
  }
  wake_.notify_one();
  if (writer_.joinable()) writer_.join();
  if (failed_) {
    throw RecordingError("bag '" + path_ + "' is not complete, it ends after " + std::to_string(count_) +
                         " messages: " + reason_);
  }
  return count_;
}

}  // namespace ros_bridge
}  // namespace screwline
