#include "screwline/ros/stream_reporter.h"

#include <string>
#include <utility>

#include "screwline/ros/checks.h"
#include "screwline/ros/trajectory_params.h"

namespace screwline {
namespace ros_bridge {
namespace {

using diagnostic_msgs::DiagnosticStatus;

void add(DiagnosticStatus& status, const std::string& key, const std::string& value) {
  diagnostic_msgs::KeyValue entry;
  entry.key = key;
  entry.value = value;
  status.values.push_back(std::move(entry));
}

std::string microseconds(double seconds) {
  return numberText(1e6 * seconds);
}

}  // namespace

StreamReporter::StreamReporter(std::shared_ptr<const SerialChain> chain, double rate, Sink sink)
    : chain_(std::move(chain)), rate_(rate), sink_(std::move(sink)), lately_(rate), motion_(rate), tracking_(chain_) {}

void StreamReporter::take(const StreamSample& sample) {
  if (sample.first) {
    motion_.clear();
    const std::lock_guard<std::mutex> lock(mutex_);
    tracking_.clear();
  }
  lately_.take(sample);
  if (!sample.held) motion_.take(sample);
  if (reported_ == 0 || sample.stamp < reported_) reported_ = sample.stamp;
  if (sample.last || sample.stamp - reported_ >= kNanosecondsPerSecond) report(sample.stamp);
}

void StreamReporter::report(Nanoseconds stamp) {
  diagnostic_msgs::DiagnosticArray message;
  message.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
  message.status.push_back(status(lately_, "stream"));
  if (motion_.samples() > 0) {
    message.status.push_back(status(motion_, "motion"));
    addTracking(message.status.back());
  }
  sink_(message);
  lately_.clear();
  reported_ = stamp;
}

DiagnosticStatus StreamReporter::status(const StreamStatistics& figures, const std::string& what) const {
  DiagnosticStatus status;
  status.name = std::string(kTrajectoryGeneratorNode) + ": " + what;
  status.hardware_id = chain_->name();
  status.level = figures.missed() > 0 ? DiagnosticStatus::WARN : DiagnosticStatus::OK;
  status.message = figures.missed() > 0 ? std::to_string(figures.missed()) + " deadlines missed" : "on time";
  add(status, "samples", std::to_string(figures.samples()));
  add(status, "rate [Hz]", numberText(rate_));
  add(status, "achieved rate [Hz]", numberText(figures.rate()));
  add(status, "jitter p50 [us]", microseconds(figures.jitter(0.5)));
  add(status, "jitter p99 [us]", microseconds(figures.jitter(0.99)));
  add(status, "jitter max [us]", microseconds(figures.largestJitter()));
  add(status, "missed deadlines", std::to_string(figures.missed()));
  return status;
}

void StreamReporter::addTracking(DiagnosticStatus& status) const {
  const TrackingError errors = tracking();
  if (!errors.any()) return;
  const std::vector<std::string> names = chain_->jointNames();
  for (std::size_t j = 0; j < names.size(); ++j) {
    add(status, "tracking error max of " + names[j] + " [rad or m]", numberText(errors.peak()[j]));
    add(status, "tracking error rms of " + names[j] + " [rad or m]", numberText(errors.rms()[j]));
  }
}

void StreamReporter::track(const sensor_msgs::JointState& measured, const VectorX& due) {
  const std::lock_guard<std::mutex> lock(mutex_);
  tracking_.take(measured, due);
}

TrackingError StreamReporter::tracking() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return tracking_;
}

}  // namespace ros_bridge
}  // namespace screwline
