#include "golden.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include <dirent.h>
#include <yaml-cpp/yaml.h>

namespace screwline {
namespace golden {
namespace {

/// Recursive descent over sums, products, powers, signs, brackets, sqrt, names and numbers.
class Evaluator {
 public:
  Evaluator(const std::string& text, const std::map<std::string, double>& symbols) : text_(text), symbols_(symbols) {}

  double run() {
    const double value = sum();
    if (next() != '\0') fail();
    return value;
  }

 private:
  char next() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool accept(const std::string& mark) {
    next();
    if (text_.compare(at_, mark.size(), mark) != 0) return false;
    at_ += mark.size();
    return true;
  }

  double sum() {
    double value = product();
    for (;;) {
      if (accept("+")) {
        value += product();
      } else if (accept("-")) {
        value -= product();
      } else {
        return value;
      }
    }
  }

  double product() {
    double value = signedPower();
    for (;;) {
      if (next() == '*' && text_.compare(at_, 2, "**") != 0) {
        ++at_;
        value *= signedPower();
      } else if (accept("/")) {
        value /= signedPower();
      } else {
        return value;
      }
    }
  }

  double signedPower() {
    if (accept("-")) return -signedPower();
    const double base = atom();
    return accept("**") ? std::pow(base, signedPower()) : base;
  }

  double atom() {
    if (accept("(")) {
      const double value = sum();
      if (!accept(")")) fail();
      return value;
    }
    const char c = next();
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) return named();
    if (std::isdigit(static_cast<unsigned char>(c)) == 0 && c != '.') fail();
    std::size_t length = 0;
    const double value = std::stod(text_.substr(at_), &length);
    at_ += length;
    return value;
  }

  double named() {
    const std::size_t start = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_'))
      ++at_;
    const std::string name = text_.substr(start, at_ - start);
    if (name == "pi") return kPi;
    if (name == "sqrt") return std::sqrt(atom());
    const auto found = symbols_.find(name);
    if (found == symbols_.end()) fail();
    return found->second;
  }

  [[noreturn]] void fail() const { throw std::runtime_error("cannot read '" + text_ + "' at " + std::to_string(at_)); }

  const std::string& text_;
  const std::map<std::string, double>& symbols_;
  std::size_t at_ = 0;
};

VectorX vectorOf(const YAML::Node& node) {
  VectorX v(static_cast<Eigen::Index>(node.size()));
  for (std::size_t i = 0; i < node.size(); ++i) v[static_cast<Eigen::Index>(i)] = node[i].as<double>();
  return v;
}

MatrixX matrixOf(const YAML::Node& node) {
  if (!node || node.size() == 0) return {};
  MatrixX M(static_cast<Eigen::Index>(node.size()), static_cast<Eigen::Index>(node[0].size()));
  for (std::size_t i = 0; i < node.size(); ++i) M.row(static_cast<Eigen::Index>(i)) = vectorOf(node[i]).transpose();
  return M;
}

Pose poseOf(const YAML::Node& node) {
  const MatrixX T = matrixOf(node);
  return {T.topLeftCorner<3, 3>(), T.topRightCorner<3, 1>()};
}

Task taskOf(const std::string& name) {
  static const std::map<std::string, std::vector<int>> kRows = {{"xyz", {0, 1, 2}},    {"xy", {0, 1}},
                                                                {"xy_phi", {0, 1, 5}}, {"xyz_phi", {0, 1, 2, 5}},
                                                                {"R", {3, 4, 5}},      {"pose", {0, 1, 2, 3, 4, 5}}};
  return Task::fromRows(kRows.at(name));
}

Task detRowsOf(const YAML::Node& node) {
  static const std::vector<std::string> kNames = {"vx", "vy", "vz", "wx", "wy", "wz"};
  std::vector<int> rows;
  for (const YAML::Node& name : node) {
    const auto found = std::find(kNames.begin(), kNames.end(), name.as<std::string>());
    rows.push_back(static_cast<int>(found - kNames.begin()));
  }
  return Task::fromRows(rows);
}

std::map<std::string, double> numbersOf(const YAML::Node& node) {
  std::map<std::string, double> numbers;
  for (const auto& entry : node) numbers[entry.first.as<std::string>()] = entry.second.as<double>();
  return numbers;
}

ChainDescription descriptionOf(const std::string& name, const YAML::Node& model) {
  ChainDescription description;
  description.name = name;
  description.base_link = "base";
  description.tip_link = "tool";
  for (const YAML::Node& node : model["joints"]) {
    Joint joint;
    joint.name = node["name"].as<std::string>();
    joint.type = node["type"].as<std::string>() == "prismatic" ? JointType::kPrismatic : JointType::kContinuous;
    description.joints.push_back(joint);
  }
  description.home = poseOf(model["home_pose"]);
  return description;
}

SerialChain finished(ChainDescription description) {
  description.links = {{description.base_link, 0, Pose()},
                       {description.tip_link, static_cast<int>(description.axes.size()), description.home}};
  return SerialChain(std::move(description));
}

SerialChain chainOf(const std::string& name, const YAML::Node& model) {
  ChainDescription description = descriptionOf(name, model);
  const MatrixX screws = matrixOf(model["screw_axes_space_w_v"]);
  for (Eigen::Index i = 0; i < screws.rows(); ++i) {
    const Vector3 w = screws.row(i).head<3>();
    const Vector3 v = screws.row(i).tail<3>();
    Axis axis;
    axis.source = static_cast<int>(i);
    axis.prismatic = description.joints[static_cast<std::size_t>(i)].type == JointType::kPrismatic;
    axis.direction = axis.prismatic ? v : w;
    if (!axis.prismatic) axis.point = w.cross(v);
    description.axes.push_back(axis);
  }
  return finished(std::move(description));
}

/// A joint may enter its row with a minus: its axis is then driven with multiplier -1, which keeps the row's frame.
SerialChain tableOf(const std::string& name, const YAML::Node& model, const std::map<std::string, double>& parameters) {
  ChainDescription description = descriptionOf(name, model);
  std::map<std::string, double> symbols = parameters;
  for (const Joint& joint : description.joints) symbols[joint.name] = 0.0;
  ModifiedDh dh;
  std::vector<bool> prismatic;
  std::vector<double> multipliers;
  for (std::size_t i = 0; i < description.joints.size(); ++i) {
    const YAML::Node node = model["modified_dh"]["rows"][i];
    const Joint& joint = description.joints[i];
    const auto read = [&](const char* key) { return evaluate(node[key].as<std::string>(), symbols); };
    const ModifiedDhRow row = {read("a_prev"), read("alpha_prev"), read("d"), read("theta")};
    symbols[joint.name] = 1.0;
    prismatic.push_back(joint.type == JointType::kPrismatic);
    multipliers.push_back(std::round(prismatic.back() ? read("d") - row.d : read("theta") - row.theta));
    symbols[joint.name] = 0.0;
    dh.rows.push_back(row);
  }
  dh.tool_transform = poseOf(model["modified_dh"]["tool"]);
  description.axes = axesOf(dh, prismatic);
  for (std::size_t i = 0; i < description.axes.size(); ++i) {
    description.axes[i].source = static_cast<int>(i);
    description.axes[i].multiplier = multipliers[i];
  }
  description.home = homeOf(dh);
  description.dh = dh;
  return finished(std::move(description));
}

Ik ikOf(const YAML::Node& node) {
  Ik ik;
  ik.task = taskOf(node["task"].as<std::string>());
  ik.infinite = node["status"].as<std::string>() == "infinite";
  for (const YAML::Node& solution : node[ik.infinite ? "samples" : "solutions"]) {
    ik.solutions.push_back({vectorOf(solution["q"]), solution["full_pose_matches"].as<bool>()});
  }
  for (const YAML::Node& entry : node["families"]) {
    IkFamily family;
    family.free = entry["free"].as<std::vector<std::string>>();
    family.fixed = numbersOf(entry["fixed"]);
    if (const YAML::Node relation = entry["relation"]) {
      for (std::size_t i = 0; i < relation["sum_of"].size(); ++i) {
        family.relation[relation["sum_of"][i].as<std::string>()] = relation["coefficients"][i].as<double>();
      }
      family.relation_value = relation["equals_mod_2pi"].as<double>();
    }
    ik.families.push_back(family);
  }
  return ik;
}

Case caseOf(const YAML::Node& node) {
  Case c;
  c.id = node["id"].as<std::string>();
  c.singular = node["kind"].as<std::string>() == "singular";
  c.q = vectorOf(node["q"]);
  c.pose = poseOf(node["pose"]);
  c.jacobian_base = matrixOf(node["jacobian_base"]);
  c.jacobian_tool = matrixOf(node["jacobian_tool"]);
  c.det_task = node["det_task"].as<double>();
  c.rank_task = node["rank_task"].as<int>();
  c.rank_full = node["rank_full"].as<int>();
  c.singular_values_task = vectorOf(node["singular_values_task"]);
  c.singular_values_full = vectorOf(node["singular_values_full"]);
  c.manipulability_task = node["manipulability_task"].as<double>();
  c.lost_task_directions = matrixOf(node["lost_task_directions"]);
  c.null_joint_rates = matrixOf(node["null_joint_rates"]);
  const YAML::Node velocity = node["velocity"];
  c.qd = vectorOf(velocity["qd"]);
  c.twist_base = vectorOf(velocity["twist_base"]);
  c.twist_tool = vectorOf(velocity["twist_tool"]);
  c.link_w = matrixOf(velocity["link_w"]);
  c.link_v = matrixOf(velocity["link_v"]);
  const YAML::Node statics = node["statics"];
  c.wrench = vectorOf(statics["wrench"]);
  c.tau_if_wrench_in_tool = vectorOf(statics["tau_if_wrench_in_tool"]);
  c.tau_if_wrench_in_base = vectorOf(statics["tau_if_wrench_in_base"]);
  c.link_f = matrixOf(statics["link_f"]);
  c.link_n = matrixOf(statics["link_n"]);
  c.ik = ikOf(node["ik"]);
  return c;
}

std::vector<std::string> listed() {
  std::vector<std::string> found;
  DIR* folder = opendir(SCREWLINE_TEST_DATA "/golden");
  if (folder == nullptr) throw std::runtime_error("no folder " SCREWLINE_TEST_DATA "/golden");
  while (const dirent* entry = readdir(folder)) {
    const std::string name = entry->d_name;
    const std::size_t dot = name.rfind(".yaml");
    if (dot != std::string::npos) found.push_back(name.substr(0, dot));
  }
  closedir(folder);
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

double evaluate(const std::string& expression, const std::map<std::string, double>& symbols) {
  return Evaluator(expression, symbols).run();
}

const std::vector<std::string>& names() {
  static const std::vector<std::string> all = listed();
  return all;
}

const File* load(const std::string& name) {
  static std::map<std::string, std::unique_ptr<File>> files;
  std::unique_ptr<File>& file = files[name];
  if (file) return file.get();
  const YAML::Node root = YAML::LoadFile(SCREWLINE_TEST_DATA "/golden/" + name + ".yaml");
  const YAML::Node model = root["model"];
  const std::map<std::string, double> parameters = numbersOf(model["parameters"]);
  file.reset(new File{
      name, parameters, detRowsOf(model["det_rows"]), chainOf(name, model), tableOf(name, model, parameters), {}, {}});
  for (const YAML::Node& node : root["cases"]) file->cases.push_back(caseOf(node));
  for (const YAML::Node& node : root["unreachable_poses"]) {
    file->unreachable.push_back({node["reason"].as<std::string>(), poseOf(node["pose"])});
  }
  return file.get();
}

}  // namespace golden
}  // namespace screwline
