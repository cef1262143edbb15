#include "screwline/ros/frame_resolver.h"

#include <utility>

#include "screwline/kinematics/forward.h"
#include "screwline/ros/checks.h"

namespace screwline {
namespace ros_bridge {

FrameResolver::FrameResolver(std::shared_ptr<const SerialChain> chain, FrameLookup lookup)
    : chain_(std::move(chain)), lookup_(std::move(lookup)) {}

Pose FrameResolver::atConfiguration(const std::string& frame, const ConstVectorRef& q, const std::string& field) const {
  if (isBase(frame)) return {};
  if (const Link* link = chain_->findLink(frame)) return linkPose(*chain_, *link, q);
  return lookUp(frame, field, "is neither a link of chain " + quoted(chain_->name()) + " nor known to tf2");
}

Pose FrameResolver::withoutConfiguration(const std::string& frame, const std::string& field) const {
  if (isBase(frame)) return {};
  const Link* link = chain_->findLink(frame);
  if (link != nullptr && link->axis_count == 0) return link->home;
  if (link != nullptr) return lookUp(frame, field, "moves with the chain, and tf2 does not tell where it is");
  return lookUp(frame, field, "is neither a link of chain " + quoted(chain_->name()) + " nor known to tf2");
}

std::string FrameResolver::nameOf(const std::string& frame) const {
  return frame.empty() ? chain_->baseLink() : frame;
}

bool FrameResolver::isBase(const std::string& frame) const {
  return frame.empty() || frame == chain_->baseLink();
}

Pose FrameResolver::lookUp(const std::string& frame, const std::string& field, const std::string& refusal) const {
  const std::optional<Pose> X_BF = lookup_ ? lookup_(frame) : std::nullopt;
  if (!X_BF) throw InputError(AnswerCode::kFrameTransformFailure, field + " " + quoted(frame) + " " + refusal);
  return *X_BF;
}

}  // namespace ros_bridge
}  // namespace screwline
