#ifndef SCREWLINE_ROS_TRACKING_ERROR_H
#define SCREWLINE_ROS_TRACKING_ERROR_H

#include <sensor_msgs/JointState.h>

#include <memory>
#include <vector>

#include "screwline/model/serial_chain.h"

namespace screwline {
namespace ros_bridge {

/// How far a controlled robot is from where it should be, joint by joint, since the last clear(). A message may tell of
/// some of the joints, and of others besides. One thread at a time.
class TrackingError {
 public:
  explicit TrackingError(std::shared_ptr<const SerialChain> chain);

  void clear();

  /// Takes the difference to the position that was due at the message's stamp.
  /// @throws InputError (kInvalidRobotState): sizes of names and positions differ, a value is not finite.
  void take(const sensor_msgs::JointState& measured, const VectorX& due);

  bool any() const;                  ///< Whether every joint was measured.
  std::vector<double> peak() const;  ///< [rad or m] Largest difference of each joint.
  std::vector<double> rms() const;   ///< [rad or m] Root of the mean square of each joint.

 private:
  std::shared_ptr<const SerialChain> chain_;
  std::vector<double> peak_;
  std::vector<double> squares_;
  std::vector<double> counts_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_TRACKING_ERROR_H
