#ifndef SCREWLINE_BENCHMARK_ROBOTS_H
#define SCREWLINE_BENCHMARK_ROBOTS_H

#include <yaml-cpp/yaml.h>

#include <kdl/chain.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "screwline/model/task.h"
#include "screwline/model/urdf_reader.h"

namespace screwline {
namespace benchmark_support {

constexpr unsigned kSeed = 20261122;

inline const std::vector<std::string>& robotNames() {
  static const std::vector<std::string> names = {
      "prrr_arm",   "rrp_spherical",   "rr_planar",       "rrr_planar", "rrr_articulated",
      "rrp_offset", "rpp_cylindrical", "spherical_wrist", "scara",      "prrr_column",
      "rrprrr",     "rrr_orthogonal",  "orienting_3r",    "planar_3r"};
  return names;
}

/// A shipped robot for both libraries, and configurations of it that are the same in every run.
struct Robot {
  explicit Robot(const std::string& name)
      : path(std::string(SCREWLINE_SOURCE_DIR) + "/urdf/" + name + ".urdf"), chain(readUrdfFile(path)) {
    const YAML::Node config = YAML::LoadFile(std::string(SCREWLINE_SOURCE_DIR) + "/config/robots/" + name + ".yaml");
    task = Task::parse(config["task"].as<std::vector<std::string>>());
    KDL::Tree tree;
    if (!kdl_parser::treeFromFile(path, tree) || !tree.getChain(chain.baseLink(), chain.tipLink(), kdl)) {
      throw std::runtime_error("KDL does not read " + path);
    }
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int k = 0; k < 256; ++k) {
      VectorX q(chain.size());
      for (int i = 0; i < chain.size(); ++i) q[i] = (chain.joint(i).isRevolute() ? 3.0 : 0.3) * unit(random);
      configurations.push_back(q);
    }
  }

  const VectorX& next() { return configurations[index++ % configurations.size()]; }

  std::string path;
  SerialChain chain;
  Task task;
  KDL::Chain kdl;
  std::vector<VectorX> configurations;
  std::size_t index = 0;
};

}  // namespace benchmark_support
}  // namespace screwline

#endif  // SCREWLINE_BENCHMARK_ROBOTS_H
