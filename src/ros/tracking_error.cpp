#include "screwline/ros/tracking_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "screwline/ros/checks.h"

namespace screwline {
namespace ros_bridge {

TrackingError::TrackingError(std::shared_ptr<const SerialChain> chain) : chain_(std::move(chain)) {
  clear();
}

void TrackingError::clear() {
  for (auto* values : {&peak_, &squares_, &counts_}) values->assign(static_cast<std::size_t>(chain_->size()), 0.0);
}

void TrackingError::take(const sensor_msgs::JointState& measured, const VectorX& due) {
  const AnswerCode code = AnswerCode::kInvalidRobotState;
  if (measured.name.size() != measured.position.size()) {
    throw InputError(code, "the tracked joint state has " + std::to_string(measured.position.size()) + " positions, " +
                               std::to_string(measured.name.size()) + " names");
  }
  const std::vector<std::string> names = chain_->jointNames();
  for (std::size_t i = 0; i < measured.name.size(); ++i) {
    const auto found = std::find(names.begin(), names.end(), measured.name[i]);
    if (found == names.end()) continue;
    requireFinite(measured.position[i], "the tracked position of joint " + quoted(measured.name[i]), code);
    const std::size_t j = static_cast<std::size_t>(found - names.begin());
    const double error = std::abs(measured.position[i] - due[static_cast<Eigen::Index>(j)]);
    peak_[j] = std::max(peak_[j], error);
    squares_[j] += error * error;
    counts_[j] += 1.0;
  }
}

bool TrackingError::any() const {
  return std::all_of(counts_.begin(), counts_.end(), [](double count) { return count > 0.0; });
}

std::vector<double> TrackingError::peak() const {
  return peak_;
}

std::vector<double> TrackingError::rms() const {
  std::vector<double> values;
  for (std::size_t j = 0; j < counts_.size(); ++j) {
    values.push_back(counts_[j] > 0.0 ? std::sqrt(squares_[j] / counts_[j]) : 0.0);
  }
  return values;
}

}  // namespace ros_bridge
}  // namespace screwline
