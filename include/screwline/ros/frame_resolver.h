#ifndef SCREWLINE_ROS_FRAME_RESOLVER_H
#define SCREWLINE_ROS_FRAME_RESOLVER_H

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "screwline/model/serial_chain.h"

namespace screwline {
namespace ros_bridge {

/// X_BF of a frame by what is known outside the chain (tf2: its latest transform), or none. May be empty.
using FrameLookup = std::function<std::optional<Pose>(const std::string& frame)>;

/// Finds the pose X_BF of the frame that a request names. Empty: the base link. Thread-safe if the lookup is.
class FrameResolver {
 public:
  FrameResolver(std::shared_ptr<const SerialChain> chain, FrameLookup lookup);

  /// A link of the chain at q, else what the lookup knows. @throws InputError (kFrameTransformFailure) naming `field`
  /// and the frame.
  Pose atConfiguration(const std::string& frame, const ConstVectorRef& q, const std::string& field) const;

  /// Where no configuration is given: links that do not move, else what the lookup knows. @throws as above.
  Pose withoutConfiguration(const std::string& frame, const std::string& field) const;

  /// The frame's name for an answer's header.
  std::string nameOf(const std::string& frame) const;

  /// Whether the frame is the base link.
  bool isBase(const std::string& frame) const;

 private:
  Pose lookUp(const std::string& frame, const std::string& field, const std::string& refusal) const;

  std::shared_ptr<const SerialChain> chain_;
  FrameLookup lookup_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_FRAME_RESOLVER_H
