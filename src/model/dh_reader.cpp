#include "screwline/model/dh_reader.h"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <set>

#include "screwline/exception.h"
#include "screwline/model/limits.h"
#include "screwline/spatial/rotation.h"
#include "text.h"
#include "yaml_brackets.h"

namespace screwline {
namespace {

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw ModelError("modified DH: " + where + ": " + what);
}

/// What a node is, for a message.
std::string described(const YAML::Node& node) {
  constexpr std::size_t kShown = 60;
  if (node.IsScalar()) return inQuotes(node.Scalar().substr(0, kShown) + (node.Scalar().size() > kShown ? "..." : ""));
  return node.IsMap() ? "a map" : node.IsSequence() ? "a list" : "empty";
}

/// Keys must be known and there once.
void checkKeys(const YAML::Node& node, const std::string& where, const std::set<std::string>& known) {
  if (!node.IsMap()) fail(where, "is " + described(node) + ", it must be a map of keys to values");
  std::set<std::string> seen;
  for (const auto& entry : node) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    if (known.count(key) == 0) {
      std::string names;
      for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
      fail(where, "unknown key '" + key + "'; known are " + names);
    }
    if (!seen.insert(key).second) fail(where, "key '" + key + "' is given twice");
  }
}

/// Value of "[+-] [number *] pi [/ number]", or of a number.
std::optional<double> angleOf(std::string text) {
  double value = 1.0;
  if (!text.empty() && (text[0] == '-' || text[0] == '+') && text.find("pi") != std::string::npos) {
    value = text[0] == '-' ? -1.0 : 1.0;
    text.erase(0, 1);
  }
  const std::size_t pi = text.find("pi");
  if (pi == std::string::npos) return numberOf(text);
  const auto trimmed = [](const std::string& part) {
    const std::size_t first = part.find_first_not_of(' ');
    return first == std::string::npos ? "" : part.substr(first, part.find_last_not_of(' ') - first + 1);
  };
  std::string before = trimmed(text.substr(0, pi));
  const std::string after = trimmed(text.substr(pi + 2));
  value *= kPi;
  if (!before.empty()) {
    if (before.back() != '*') return std::nullopt;
    before.pop_back();
    const std::optional<double> factor = numberOf(trimmed(before));
    if (!factor) return std::nullopt;
    value *= *factor;
  }
  if (!after.empty()) {
    const std::optional<double> divisor = numberOf(trimmed(after.substr(1)));
    if (after[0] != '/' || !divisor || *divisor == 0.0) return std::nullopt;
    value /= *divisor;
  }
  return value;
}

double numberAt(const YAML::Node& node, const std::string& where, bool angle) {
  const std::optional<double> value = !node.IsScalar() ? std::nullopt
                                      : angle          ? angleOf(node.Scalar())
                                                       : numberOf(node.Scalar());
  if (!value) fail(where, "is " + described(node) + ", it must be a number" + (angle ? " or a multiple of pi" : ""));
  if (std::abs(*value) > kMaxMagnitude) fail(where, "is " + node.Scalar() + ", beyond 1e+06 in magnitude");
  return *value;
}

Vector3 vectorAt(const YAML::Node& node, const std::string& where, bool angles) {
  if (!node.IsSequence() || node.size() != 3) fail(where, "must be a list of 3 numbers");
  Vector3 v;
  for (std::size_t k = 0; k < 3; ++k) {
    v[static_cast<Eigen::Index>(k)] = numberAt(node[k], where + "[" + std::to_string(k) + "]", angles);
  }
  return v;
}

/// {xyz: [..], rpy: [..]}, as in URDF: turned about the fixed x, y, z axes in this order.
Pose poseAt(const YAML::Node& root, const std::string& key) {
  Pose X;
  if (!root[key]) return X;
  const YAML::Node node = root[key];
  checkKeys(node, key, {"xyz", "rpy"});
  if (node["xyz"]) X.p = vectorAt(node["xyz"], key + ".xyz", false);
  if (!node["rpy"]) return X;
  const Vector3 rpy = vectorAt(node["rpy"], key + ".rpy", true);
  X.R = rotationAbout(Vector3::UnitZ(), rpy.z()) * rotationAbout(Vector3::UnitY(), rpy.y()) *
        rotationAbout(Vector3::UnitX(), rpy.x());
  return X;
}

/// One entry of `joints`.
class JointEntry {
 public:
  JointEntry(const YAML::Node& node, std::size_t index) : node_(node), where_("joints[" + std::to_string(index) + "]") {
    checkKeys(node_, where_,
              {"name", "type", "alpha", "a", "d", "theta", "lower", "upper", "velocity", "acceleration", "jerk"});
    joint_.name = textAt("name");
    where_ += " '" + joint_.name + "'";
    joint_.type = typeAt("type");
    row_ = {required("a", false), required("alpha", true), required("d", false), required("theta", true)};
    readLimits();
  }

  const Joint& joint() const { return joint_; }
  const ModifiedDhRow& row() const { return row_; }

 private:
  YAML::Node at(const std::string& key) const {
    const YAML::Node value = node_[key];
    if (!value) fail(where_, "key '" + key + "' is missing");
    return value;
  }

  std::string textAt(const std::string& key) const {
    const YAML::Node value = at(key);
    if (!value.IsScalar() || value.Scalar().empty()) fail(where_ + "." + key, "is " + described(value));
    return value.Scalar();
  }

  JointType typeAt(const std::string& key) const {
    const std::string text = textAt(key);
    for (const JointType type : {JointType::kRevolute, JointType::kContinuous, JointType::kPrismatic}) {
      if (text == toString(type)) return type;
    }
    fail(where_ + "." + key, "is '" + text + "', it must be revolute, continuous or prismatic");
  }

  double required(const std::string& key, bool angle) const { return numberAt(at(key), where_ + "." + key, angle); }

  double rate(const std::string& key) const {
    if (!node_[key]) return std::numeric_limits<double>::infinity();
    const double value = required(key, joint_.isRevolute());
    if (value <= 0.0) fail(where_ + "." + key, "is " + numberText(value) + ", it must be above 0");
    return value;
  }

  void readLimits() {
    JointLimits& limits = joint_.limits;
    if (joint_.type == JointType::kContinuous) {
      if (node_["lower"] || node_["upper"]) fail(where_, "a continuous joint has no lower and upper");
    } else {
      limits.lower = required("lower", joint_.isRevolute());
      limits.upper = required("upper", joint_.isRevolute());
      if (limits.lower > limits.upper) {
        fail(where_, "lower " + numberText(limits.lower) + " is above upper " + numberText(limits.upper));
      }
    }
    limits.velocity = rate("velocity");
    limits.acceleration = rate("acceleration");
    limits.jerk = rate("jerk");
    limits = withAssumedRates(limits);
  }

  YAML::Node node_;
  std::string where_;
  Joint joint_;
  ModifiedDhRow row_;
};

ChainDescription descriptionOf(const YAML::Node& root) {
  checkKeys(root, "document", {"name", "joints", "base", "tool"});
  ChainDescription result;
  if (!root["name"] || !root["name"].IsScalar() || root["name"].Scalar().empty()) fail("name", "is missing");
  result.name = root["name"].Scalar();
  const YAML::Node joints = root["joints"];
  if (!joints || !joints.IsSequence() || joints.size() == 0) fail("joints", "must be a list of at least one joint");
  if (joints.size() > kMaxJoints) {
    fail("joints", "has " + std::to_string(joints.size()) + " joints, at most " + std::to_string(kMaxJoints));
  }

  ModifiedDh dh;
  dh.base_transform = poseAt(root, "base");
  dh.tool_transform = poseAt(root, "tool");
  std::vector<bool> prismatic;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const JointEntry entry(joints[i], i);
    for (const Joint& other : result.joints) {
      if (other.name == entry.joint().name) fail("joints", "name '" + other.name + "' is used twice");
    }
    result.joints.push_back(entry.joint());
    dh.rows.push_back(entry.row());
    prismatic.push_back(!entry.joint().isRevolute());
  }

  result.base_link = "base_link";
  result.tip_link = "tip";
  result.axes = axesOf(dh, prismatic);
  result.home = homeOf(dh);
  result.links.push_back({"base_link", 0, {}});
  Pose X = dh.base_transform;
  for (std::size_t i = 0; i < dh.rows.size(); ++i) {
    const int number = static_cast<int>(i) + 1;
    X = X * dh.link(number, prismatic[i], 0.0);
    result.links.push_back({"link_" + std::to_string(number), number, X});
  }
  result.links.push_back({"tip", static_cast<int>(dh.rows.size()), result.home});
  result.dh = dh;
  return result;
}

}  // namespace

SerialChain readDhYaml(const std::string& yaml) {
  if (const auto wrong = wrongBrackets(yaml)) throw ModelError("modified DH: the YAML is malformed: " + *wrong);
  try {
    return SerialChain(descriptionOf(YAML::Load(yaml)));
  } catch (const YAML::Exception& error) {
    throw ModelError(std::string("modified DH: the YAML is malformed: ") + error.what());
  }
}

SerialChain readDhYamlFile(const std::string& path) {
  const std::optional<std::string> text = textOfFile(path);
  if (!text) throw ModelError("file '" + path + "' cannot be read");
  try {
    return readDhYaml(*text);
  } catch (const ModelError& error) {
    throw ModelError(path + ": " + error.what());
  }
}

}  // namespace screwline
