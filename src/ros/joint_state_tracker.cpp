#include "screwline/ros/joint_state_tracker.h"

#include <algorithm>
#include <utility>

#include "screwline/ros/checks.h"

namespace screwline {
namespace ros_bridge {

JointStateTracker::JointStateTracker(std::shared_ptr<const SerialChain> chain)
    : chain_(std::move(chain)),
      positions_(VectorX::Zero(chain_->size())),
      known_(static_cast<std::size_t>(chain_->size()), false) {}

bool JointStateTracker::update(const sensor_msgs::JointState& state) {
  if (state.position.empty()) return false;
  if (state.name.size() != state.position.size()) {
    throw InputError(AnswerCode::kInvalidRobotState, "joint_states.position has " +
                                                         std::to_string(state.position.size()) + " values, name has " +
                                                         std::to_string(state.name.size()));
  }
  VectorX positions = positions_;
  std::vector<bool> known = known_;
  bool told = false;
  for (std::size_t i = 0; i < state.name.size(); ++i) {
    const auto is_named = [&](const Joint& joint) { return joint.name == state.name[i]; };
    const auto joint = std::find_if(chain_->joints().begin(), chain_->joints().end(), is_named);
    if (joint == chain_->joints().end()) continue;
    requireFinite(state.position[i], "joint_states.position of " + joint->name, AnswerCode::kInvalidRobotState);
    const auto index = joint - chain_->joints().begin();
    positions[index] = state.position[i];
    known[static_cast<std::size_t>(index)] = true;
    told = true;
  }
  positions_ = positions;
  known_ = known;
  return told && std::find(known_.begin(), known_.end(), false) == known_.end();
}

}  // namespace ros_bridge
}  // namespace screwline
