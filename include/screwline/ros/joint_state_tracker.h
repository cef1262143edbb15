#ifndef SCREWLINE_ROS_JOINT_STATE_TRACKER_H
#define SCREWLINE_ROS_JOINT_STATE_TRACKER_H

#include <sensor_msgs/JointState.h>

#include <memory>
#include <vector>

#include "screwline/model/serial_chain.h"

namespace screwline {
namespace ros_bridge {

/// The chain's configuration out of a stream of joint states, which may come from several publishers: each may tell of
/// some of the chain's joints and of others besides.
class JointStateTracker {
 public:
  explicit JointStateTracker(std::shared_ptr<const SerialChain> chain);

  /// Takes over what a message says of the chain's joints: true where it says something and every joint is known now.
  /// @throws InputError (kInvalidRobotState): sizes of names and positions differ, a value of the chain is not finite;
  /// what was known stays.
  bool update(const sensor_msgs::JointState& state);

  /// Only where update() was true once.
  const VectorX& positions() const { return positions_; }

 private:
  std::shared_ptr<const SerialChain> chain_;
  VectorX positions_;
  std::vector<bool> known_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_JOINT_STATE_TRACKER_H
