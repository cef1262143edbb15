#include "screwline/ros/joint_values.h"

#include <algorithm>

#include "screwline/ros/checks.h"

namespace screwline {
namespace ros_bridge {
namespace {

[[noreturn]] void refuse(const std::string& message) {
  throw InputError(AnswerCode::kInvalidRobotState, message);
}

int indexOf(const SerialChain& chain, const std::string& name) {
  for (int i = 0; i < chain.size(); ++i)
    if (chain.joint(i).name == name) return i;
  return -1;
}

/// For each joint of the chain, the place of its value.
std::vector<std::size_t> orderOf(const SerialChain& chain, const std::vector<std::string>& names,
                                 const std::string& field) {
  const std::size_t missing = names.size();
  std::vector<std::size_t> order(static_cast<std::size_t>(chain.size()), missing);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto who = [&] { return field + "[" + std::to_string(i) + "] is " + quoted(names[i]); };
    const int joint = indexOf(chain, names[i]);
    if (joint < 0) refuse(who() + ", chain " + quoted(chain.name()) + " has no such joint");
    std::size_t& place = order[static_cast<std::size_t>(joint)];
    if (place != missing) refuse(who() + ", as " + field + "[" + std::to_string(place) + "] is already");
    place = i;
  }
  const auto gap = std::find(order.begin(), order.end(), missing);
  if (gap != order.end()) {
    const Joint& joint = chain.joint(static_cast<int>(gap - order.begin()));
    refuse(field + " lacks joint " + quoted(joint.name) + " of chain " + quoted(chain.name()));
  }
  return order;
}

std::string countText(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

VectorX jointValues(const SerialChain& chain, const std::vector<std::string>& names, const std::vector<double>& values,
                    const std::string& name_field, const std::string& field) {
  const auto has = [&] { return field + " has " + countText(values.size(), "value") + ", "; };
  if (!names.empty() && names.size() != values.size()) {
    refuse(has() + name_field + " has " + countText(names.size(), "name"));
  }
  const std::size_t count = static_cast<std::size_t>(chain.size());
  if (names.empty() && values.size() != count) {
    refuse(has() + "chain " + quoted(chain.name()) + " has " + countText(count, "joint"));
  }
  const std::vector<std::size_t> order = names.empty() ? std::vector<std::size_t>() : orderOf(chain, names, name_field);
  VectorX result(chain.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = names.empty() ? i : order[i];
    if (!isServed(values[place])) {
      requireFinite(values[place], field + "[" + std::to_string(place) + "]", AnswerCode::kInvalidRobotState);
    }
    result[static_cast<Eigen::Index>(i)] = values[place];
  }
  return result;
}

VectorX jointPositions(const SerialChain& chain, const sensor_msgs::JointState& state, const std::string& field) {
  return jointValues(chain, state.name, state.position, field + ".name", field + ".position");
}

VectorX jointVelocities(const SerialChain& chain, const sensor_msgs::JointState& state, const std::string& field) {
  return jointValues(chain, state.name, state.velocity, field + ".name", field + ".velocity");
}

}  // namespace ros_bridge
}  // namespace screwline
