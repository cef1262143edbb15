#include "urdf_document.h"

#include <console_bridge/console.h>
#include <tinyxml2.h>
#include <urdf_parser/urdf_parser.h>

#include <mutex>
#include <set>

#include "screwline/exception.h"
#include "text.h"

namespace screwline {
namespace {

constexpr std::size_t kMaxLinks = 10000;

using Element = tinyxml2::XMLElement;

void require(bool holds, const std::string& message) {
  if (!holds) throw ModelError("URDF: " + message);
}

std::string attributeOf(const Element* element, const char* attribute) {
  const char* value = element == nullptr ? nullptr : element->Attribute(attribute);
  return value == nullptr ? "" : value;
}

/// Collects what urdfdom says, in place of the console, as long as it lives.
class MessageCatcher : public console_bridge::OutputHandler {
 public:
  MessageCatcher() : previous_(console_bridge::getOutputHandler()), level_(console_bridge::getLogLevel()) {
    console_bridge::useOutputHandler(this);
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
  }
  ~MessageCatcher() override {
    console_bridge::setLogLevel(level_);
    console_bridge::useOutputHandler(previous_);
  }
  MessageCatcher(const MessageCatcher&) = delete;
  MessageCatcher& operator=(const MessageCatcher&) = delete;

  void log(const std::string& message, console_bridge::LogLevel, const char*, int) override {
    if (message == "joint xml is not initialized correctly") return;  // Follows every message on a joint.
    messages_ += (messages_.empty() ? "" : "; ") + message;
  }
  const std::string& messages() const { return messages_; }

 private:
  console_bridge::OutputHandler* previous_;
  console_bridge::LogLevel level_;
  std::string messages_;
};

urdf::ModelInterfaceSharedPtr parseByUrdfdom(const std::string& xml) {
  static std::mutex mutex;  // The output handler is the process's.
  const std::lock_guard<std::mutex> lock(mutex);
  const MessageCatcher catcher;
  urdf::ModelInterfaceSharedPtr model;
  std::string reason;
  try {
    model = urdf::parseURDF(xml);
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (reason.empty()) reason = catcher.messages();
  require(model != nullptr, reason.empty() ? "urdfdom refuses it and does not say why" : reason);
  return model;
}

const Element& rootOf(const tinyxml2::XMLDocument& document, const std::string& xml) {
  require(xml.find_first_not_of(" \t\r\n") != std::string::npos, "the document is empty");
  require(!document.Error(), "the XML is malformed at line " + std::to_string(document.ErrorLineNum()) + " (" +
                                 document.ErrorName() + ")");
  const Element* root = document.RootElement();
  require(root != nullptr, "the document has no <robot> element");
  require(root->Name() == std::string("robot"),
          "the root element is <" + std::string(root->Name()) + ">, it must be <robot>");
  const Element* second = root->NextSiblingElement();
  require(second == nullptr, "a second root element, <" + std::string(second ? second->Name() : "") + ">");
  return *root;
}

/// The names of all elements of a kind, in their order; each must be there once.
std::vector<std::string> namesOf(const Element& root, const char* kind) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (const Element* e = root.FirstChildElement(kind); e != nullptr; e = e->NextSiblingElement(kind)) {
    const std::string name = attributeOf(e, "name");
    require(!name.empty(), std::string("a <") + kind + "> has no name, line " + std::to_string(e->GetLineNum()));
    require(seen.insert(name).second, std::string(kind) + " name " + inQuotes(name) + " is used twice");
    names.push_back(name);
  }
  return names;
}

/// URDF asks for velocity and effort of every limit, many files leave them out: 0 stands for "not given".
void completeLimits(Element& root) {
  for (Element* joint = root.FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint")) {
    Element* limit = joint->FirstChildElement("limit");
    for (const char* attribute : {"velocity", "effort"}) {
      if (limit != nullptr && limit->Attribute(attribute) == nullptr) limit->SetAttribute(attribute, "0");
    }
  }
}

void connectLinks(const Element& root, UrdfDocument& result) {
  for (const std::string& link : result.links) result.joints_below[link];
  for (const Element* e = root.FirstChildElement("joint"); e != nullptr; e = e->NextSiblingElement("joint")) {
    UrdfJoint joint;
    joint.name = attributeOf(e, "name");
    joint.type = attributeOf(e, "type");
    joint.parent = attributeOf(e->FirstChildElement("parent"), "link");
    joint.child = attributeOf(e->FirstChildElement("child"), "link");
    const std::string who = "joint " + inQuotes(joint.name) + ": ";
    require(!joint.type.empty(), who + "no type");
    require(!joint.parent.empty(), who + "no parent link");
    require(!joint.child.empty(), who + "no child link");
    require(result.hasLink(joint.parent), who + "parent link " + inQuotes(joint.parent) + " does not exist");
    require(result.hasLink(joint.child), who + "child link " + inQuotes(joint.child) + " does not exist");
    const std::size_t index = result.joints.size();
    const auto [other, is_new] = result.joint_above.emplace(joint.child, index);
    require(is_new, "link " + inQuotes(joint.child) + " is the child of two joints, " +
                        inQuotes(is_new ? "" : result.joints[other->second].name) + " and " + inQuotes(joint.name));
    result.joints_below[joint.parent].push_back(index);
    result.joints.push_back(joint);
  }
}

/// Links below `root`, itself included.
std::set<std::string> reachableFrom(const UrdfDocument& document, const std::string& root) {
  std::set<std::string> reached{root};
  std::vector<std::string> open{root};
  while (!open.empty()) {
    const std::string link = open.back();
    open.pop_back();
    for (const std::size_t joint : document.joints_below.at(link)) {
      if (reached.insert(document.joints[joint].child).second) open.push_back(document.joints[joint].child);
    }
  }
  return reached;
}

void findRoot(UrdfDocument& document) {
  std::string roots;
  std::set<std::string> reached;
  for (const std::string& link : document.links) {
    if (document.joint_above.count(link) > 0) continue;
    roots += (roots.empty() ? "" : ", ") + inQuotes(link);
    if (document.root.empty()) document.root = link;
    reached.merge(reachableFrom(document, link));
  }
  for (const std::string& link : document.links)
    require(reached.count(link) > 0, "the joints form a loop at link " + inQuotes(link));
  require(roots == inQuotes(document.root), "several root links, which no joint connects: " + roots);
}

Pose poseOf(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {Quaternion(r.w, r.x, r.y, r.z).normalized().toRotationMatrix(),
          Vector3(pose.position.x, pose.position.y, pose.position.z)};
}

void readNumbers(const Element& root, const urdf::ModelInterface& model, UrdfDocument& result) {
  const Element* element = root.FirstChildElement("joint");
  for (UrdfJoint& joint : result.joints) {
    const auto source = model.getJoint(joint.name);
    require(source != nullptr, "joint " + inQuotes(joint.name) + " cannot be read");
    joint.origin = poseOf(source->parent_to_joint_origin_transform);
    joint.axis = Vector3(source->axis.x, source->axis.y, source->axis.z);
    if (source->limits) {
      const Element* limit = element->FirstChildElement("limit");
      joint.has_range = limit->Attribute("lower") != nullptr || limit->Attribute("upper") != nullptr;
      joint.lower = source->limits->lower;
      joint.upper = source->limits->upper;
      joint.velocity = source->limits->velocity;
    }
    if (source->mimic) {
      joint.mimic = UrdfMimic{source->mimic->joint_name, source->mimic->multiplier, source->mimic->offset};
    }
    element = element->NextSiblingElement("joint");
  }
}

}  // namespace

UrdfDocument parseUrdf(const std::string& xml) {
  tinyxml2::XMLDocument document;
  document.Parse(xml.c_str(), xml.size());
  const Element& root = rootOf(document, xml);

  UrdfDocument result;
  result.name = attributeOf(&root, "name");
  require(!result.name.empty(), "<robot> has no name");
  result.links = namesOf(root, "link");
  require(!result.links.empty(), "robot " + inQuotes(result.name) + " has no link");
  require(result.links.size() <= kMaxLinks, "robot " + inQuotes(result.name) + " has " +
                                                std::to_string(result.links.size()) + " links, at most " +
                                                std::to_string(kMaxLinks) + " are read");
  namesOf(root, "joint");
  connectLinks(root, result);
  findRoot(result);

  completeLimits(*document.RootElement());
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  readNumbers(root, *parseByUrdfdom(printer.CStr()), result);
  return result;
}

}  // namespace screwline
