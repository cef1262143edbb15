#include "screwline/ros/trajectory_streams.h"

#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "screwline/kinematics/jacobian.h"
#include "screwline/ros/conversions.h"

namespace screwline {
namespace ros_bridge {
namespace {

bool allFinite(const VectorX& values) {
  return std::all_of(values.data(), values.data() + values.size(), [](double value) { return std::isfinite(value); });
}

void copy(const VectorX& from, std::vector<double>& to) {
  std::copy(from.data(), from.data() + from.size(), to.begin());
}

}  // namespace

TrajectoryStreams::TrajectoryStreams(std::shared_ptr<const SerialChain> chain, GeneratorSinks sinks)
    : chain_(std::move(chain)), sinks_(std::move(sinks)), J_(6, chain_->size()) {
  const std::size_t n = static_cast<std::size_t>(chain_->size());
  state_.name = chain_->jointNames();
  state_.position.resize(n);
  state_.velocity.resize(n);
  for (auto* values : {&scaling_.tau, &scaling_.s, &scaling_.ds, &scaling_.dds, &scaling_.ddds}) values->reserve(1);
  pose_.header.frame_id = twist_.header.frame_id = chain_->baseLink();
}

void TrajectoryStreams::publish(const StreamSample& sample) {
  if (!allFinite(sample.state->position) || !allFinite(sample.state->velocity)) {
    ROS_ERROR_STREAM_THROTTLE(1.0, "internal check: a sample of the motion is not finite and is not sent");
    return;
  }
  ros::Time stamp;
  stamp.fromNSec(static_cast<std::uint64_t>(sample.stamp));
  state_.header.stamp = scaling_.header.stamp = pose_.header.stamp = twist_.header.stamp = stamp;
  copy(sample.state->position, state_.position);
  copy(sample.state->velocity, state_.velocity);
  fillScaling(sample);
  fillTool(*sample.state);
  sinks_.state(state_);
  sinks_.scaling(scaling_);
  sinks_.pose(pose_);
  sinks_.twist(twist_);
}

void TrajectoryStreams::fillScaling(const StreamSample& sample) {
  const std::size_t count = sample.scaling != nullptr ? 1 : 0;
  const ScalingSample at = count > 0 ? sample.scaling->at(sample.tau) : ScalingSample();
  const double moving = sample.held ? 0.0 : 1.0;
  scaling_.tau.assign(count, sample.tau);
  scaling_.s.assign(count, at.s);
  scaling_.ds.assign(count, moving * at.ds);
  scaling_.dds.assign(count, moving * at.dds);
  scaling_.ddds.assign(count, moving * at.ddds);
}

void TrajectoryStreams::fillTool(const TrajectoryPoint& state) {
  pose_.pose = toPose(geometricJacobian(*chain_, state.position, J_));
  Vector6 twist;
  twist.noalias() = J_ * state.velocity;
  twist_.twist = toTwist(twist);
}

}  // namespace ros_bridge
}  // namespace screwline
