#include "screwline/model/urdf_reader.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "screwline/exception.h"
#include "screwline/model/limits.h"
#include "screwline/spatial/rotation.h"
#include "text.h"
#include "urdf_document.h"

namespace screwline {
namespace {

constexpr double kSmallestAxis = 1e-6;
constexpr std::size_t kNamesListed = 12;

void require(bool holds, const std::string& message) {
  if (!holds) throw ModelError(message);
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kNamesListed); ++i)
    text += (i == 0 ? "" : ", ") + inQuotes(names[i]);
  return names.size() <= kNamesListed ? text : text + " and " + std::to_string(names.size() - kNamesListed) + " more";
}

bool isPrismatic(const UrdfJoint& joint) {
  return joint.type == "prismatic";
}

bool isServed(const UrdfJoint& joint) {
  return isPrismatic(joint) || joint.type == "revolute" || joint.type == "continuous";
}

using Path = std::vector<const UrdfJoint*>;

/// The joints from base to tip, or none where tip is not below base.
std::optional<Path> pathBetween(const UrdfDocument& document, const std::string& base, const std::string& tip) {
  Path path;
  std::string link = tip;
  while (link != base) {
    const auto above = document.joint_above.find(link);
    if (above == document.joint_above.end()) return std::nullopt;
    path.push_back(&document.joints[above->second]);
    link = path.back()->parent;
  }
  std::reverse(path.begin(), path.end());
  return path;
}

bool hasMovingJoint(const Path& path) {
  return std::any_of(path.begin(), path.end(), [](const UrdfJoint* joint) { return joint->type != "fixed"; });
}

/// The only leaf that some joint moves.
std::string onlyTipBelow(const UrdfDocument& document, const std::string& base) {
  std::vector<std::string> tips;
  for (const std::string& link : document.links) {
    if (!document.joints_below.at(link).empty()) continue;
    const std::optional<Path> path = pathBetween(document, base, link);
    if (path && hasMovingJoint(*path)) tips.push_back(link);
  }
  require(!tips.empty(), "robot " + inQuotes(document.name) + ": no moving joint below link " + inQuotes(base));
  require(tips.size() == 1, "robot " + inQuotes(document.name) + ": several chains start at link " + inQuotes(base) +
                                ", they end at " + listed(tips) + "; tip_link must name the one to take");
  return tips.front();
}

void requireLink(const UrdfDocument& document, const std::string& field, const std::string& link) {
  require(document.hasLink(link), field + " " + inQuotes(link) + " is not a link of robot " + inQuotes(document.name) +
                                      ", which has " + listed(document.links));
}

Path choosePath(const UrdfDocument& document, const ChainChoice& choice, std::string& base, std::string& tip) {
  if (!choice.base_link.empty()) requireLink(document, "base_link", choice.base_link);
  if (!choice.tip_link.empty()) requireLink(document, "tip_link", choice.tip_link);
  base = choice.base_link.empty() ? document.root : choice.base_link;
  tip = choice.tip_link.empty() ? onlyTipBelow(document, base) : choice.tip_link;
  require(base != tip, "base_link and tip_link are both " + inQuotes(tip) + ", no joint is between them");
  const std::optional<Path> path = pathBetween(document, base, tip);
  require(path.has_value(), "tip_link " + inQuotes(tip) + " is not below base_link " + inQuotes(base));
  require(hasMovingJoint(*path), "no moving joint between " + inQuotes(base) + " and " + inQuotes(tip));
  return *path;
}

void requireBounded(const std::string& what, double value) {
  require(std::abs(value) <= kMaxMagnitude,
          what + " is " + numberText(value) + ", beyond " + numberText(kMaxMagnitude) + " in magnitude");
}

std::string vectorText(const Vector3& v) {
  return "(" + numberText(v.x()) + ", " + numberText(v.y()) + ", " + numberText(v.z()) + ")";
}

void checkJoint(const UrdfJoint& joint) {
  const std::string who = "joint " + inQuotes(joint.name) + ": ";
  require(
      joint.type == "fixed" || isServed(joint),
      who + "type is " + joint.type + ", only revolute, continuous, prismatic and fixed joints can be in the chain");
  for (int k = 0; k < 3; ++k) requireBounded(who + "origin " + vectorText(joint.origin.p), joint.origin.p[k]);
  if (joint.type == "fixed") return;
  for (int k = 0; k < 3; ++k) requireBounded(who + "axis " + vectorText(joint.axis), joint.axis[k]);
  require(joint.axis.norm() >= kSmallestAxis,
          who + "axis " + vectorText(joint.axis) + " has no direction, its length must be at least 1e-06");
  requireBounded(who + "velocity limit", joint.velocity);
  require(joint.velocity >= 0.0, who + "velocity limit is " + numberText(joint.velocity) + ", it must not be negative");
  if (joint.type == "continuous") return;
  require(joint.has_range, who + "a " + joint.type + " joint needs limits, lower and upper are missing");
  requireBounded(who + "lower limit", joint.lower);
  requireBounded(who + "upper limit", joint.upper);
  require(joint.lower <= joint.upper,
          who + "lower limit " + numberText(joint.lower) + " is above upper limit " + numberText(joint.upper));
}

/// What a joint's own description allows it.
JointLimits ownLimits(const UrdfJoint& joint) {
  JointLimits limits;
  if (joint.type != "continuous") {
    limits.lower = joint.lower;
    limits.upper = joint.upper;
  }
  if (joint.velocity > 0.0) limits.velocity = joint.velocity;
  return limits;
}

/// A joint's value as multiplier * q + offset of the joint that drives it, mimics of mimics followed to their end.
UrdfMimic drive(const std::map<std::string, const UrdfJoint*>& in_chain, const UrdfJoint& joint) {
  const std::string who = "joint " + inQuotes(joint.name) + ": ";
  UrdfMimic drive{joint.name, 1.0, 0.0};
  std::set<std::string> seen{joint.name};
  for (const UrdfJoint* at = &joint; at->mimic;) {
    const UrdfMimic& mimic = *at->mimic;
    requireBounded(who + "mimic multiplier", mimic.multiplier);
    requireBounded(who + "mimic offset", mimic.offset);
    drive.offset += drive.multiplier * mimic.offset;
    drive.multiplier *= mimic.multiplier;
    drive.joint = mimic.joint;
    require(seen.insert(mimic.joint).second, who + "mimics itself by way of joint " + inQuotes(at->name));
    const auto source = in_chain.find(mimic.joint);
    require(source != in_chain.end(), who + "mimics joint " + inQuotes(mimic.joint) + ", which is not in the chain");
    require(isServed(*source->second), who + "mimics joint " + inQuotes(mimic.joint) + ", which does not move");
    at = source->second;
  }
  return drive;
}

/// Walks the path from base to tip and gathers the chain.
class ChainBuilder {
 public:
  ChainBuilder(const UrdfDocument& document, const Path& path) : document_(document), path_(path) {}

  ChainDescription build(const std::string& base, const std::string& tip) {
    result_.name = document_.name;
    result_.base_link = base;
    result_.tip_link = tip;
    collectJoints();
    addLink(base, Pose());
    for (const UrdfJoint* joint : path_) step(*joint);
    result_.home = at_;
    for (Joint& joint : result_.joints) joint.limits = withAssumedRates(joint.limits);
    addAttachedLinks();
    return result_;
  }

 private:
  /// The degrees of freedom: the joints that move and mimic none.
  void collectJoints() {
    for (const UrdfJoint* joint : path_) {
      checkJoint(*joint);
      in_chain_[joint->name] = joint;
      if (!isServed(*joint) || joint->mimic) continue;
      const JointType type = isPrismatic(*joint)         ? JointType::kPrismatic
                             : joint->type == "revolute" ? JointType::kRevolute
                                                         : JointType::kContinuous;
      index_of_[joint->name] = static_cast<int>(result_.joints.size());
      result_.joints.push_back({joint->name, type, ownLimits(*joint)});
    }
  }

  void step(const UrdfJoint& joint) {
    at_ = at_ * joint.origin;
    if (isServed(joint)) addAxis(joint);
    addLink(joint.child, at_);
  }

  void addAxis(const UrdfJoint& joint) {
    const UrdfMimic source = drive(in_chain_, joint);
    const Vector3 direction = joint.axis.normalized();
    if (source.multiplier != 0.0) {
      const int index = index_of_.at(source.joint);
      result_.axes.push_back({isPrismatic(joint), (at_.R * direction).normalized(), at_.p, index, source.multiplier});
      if (joint.mimic) limitSource(joint, source, result_.joints[static_cast<std::size_t>(index)]);
    }
    if (isPrismatic(joint)) {
      at_.p += at_.R * direction * source.offset;
    } else {
      at_.R = at_.R * rotationAbout(direction, source.offset);
    }
  }

  /// The driving joint may go only where the mimic's own limits let the mimic follow.
  static void limitSource(const UrdfJoint& mimic, const UrdfMimic& source, Joint& joint) {
    const JointLimits own = ownLimits(mimic);
    double lower = (own.lower - source.offset) / source.multiplier;
    double upper = (own.upper - source.offset) / source.multiplier;
    if (source.multiplier < 0.0) std::swap(lower, upper);
    JointLimits& limits = joint.limits;
    require(std::max(limits.lower, lower) <= std::min(limits.upper, upper),
            "joint " + inQuotes(mimic.name) + ": its limits allow joint " + inQuotes(joint.name) +
                ", which it mimics, only " + numberText(lower) + " to " + numberText(upper) + ", but that has " +
                numberText(limits.lower) + " to " + numberText(limits.upper));
    limits.lower = std::max(limits.lower, lower);
    limits.upper = std::min(limits.upper, upper);
    limits.velocity = std::min(limits.velocity, own.velocity / std::abs(source.multiplier));
    if (joint.type == JointType::kContinuous && std::isfinite(limits.lower)) joint.type = JointType::kRevolute;
  }

  void addLink(const std::string& name, const Pose& X) {
    result_.links.push_back({name, static_cast<int>(result_.axes.size()), X});
    known_.insert(name);
  }

  /// Links beside the chain that fixed joints hold to it, above the base too.
  void addAttachedLinks() {
    for (std::size_t i = 0; i < result_.links.size(); ++i) {
      const Link link = result_.links[i];
      for (const std::size_t below : document_.joints_below.at(link.name)) attach(document_.joints[below], link, true);
      const auto above = document_.joint_above.find(link.name);
      if (above != document_.joint_above.end()) attach(document_.joints[above->second], link, false);
    }
  }

  void attach(const UrdfJoint& joint, const Link& to, bool downward) {
    const std::string& name = downward ? joint.child : joint.parent;
    if (joint.type != "fixed" || !known_.insert(name).second) return;
    checkJoint(joint);
    result_.links.push_back({name, to.axis_count, to.home * (downward ? joint.origin : joint.origin.inverse())});
  }

  const UrdfDocument& document_;
  const Path& path_;
  ChainDescription result_;
  Pose at_;  ///< Of the link that was reached, in the base, at zero.
  std::map<std::string, const UrdfJoint*> in_chain_;
  std::map<std::string, int> index_of_;
  std::set<std::string> known_;
};

}  // namespace

SerialChain readUrdf(const std::string& urdf_xml, const ChainChoice& choice) {
  const UrdfDocument document = parseUrdf(urdf_xml);
  std::string base;
  std::string tip;
  const Path path = choosePath(document, choice, base, tip);
  return SerialChain(ChainBuilder(document, path).build(base, tip));
}

SerialChain readUrdfFile(const std::string& path, const ChainChoice& choice) {
  const std::optional<std::string> text = textOfFile(path);
  require(text.has_value(), "file " + inQuotes(path) + " cannot be read");
  try {
    return readUrdf(*text, choice);
  } catch (const ModelError& error) {
    throw ModelError(path + ": " + error.what());
  }
}

}  // namespace screwline
