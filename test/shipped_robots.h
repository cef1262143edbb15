#ifndef SCREWLINE_TEST_SHIPPED_ROBOTS_H
#define SCREWLINE_TEST_SHIPPED_ROBOTS_H

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "screwline/model/task.h"
#include "screwline/model/urdf_reader.h"

namespace screwline {
namespace test {

/// A robot of urdf/ with the task of config/robots/.
struct ShippedRobot {
  std::string name;
  SerialChain chain;
  Task task;
};

inline const std::vector<std::string>& shippedRobotNames() {
  static const std::vector<std::string> names = {"rr_planar",       "rrr_planar",    "planar_3r",  "rrr_articulated",
                                                 "rrr_orthogonal",  "rrp_spherical", "rrp_offset", "rpp_cylindrical",
                                                 "spherical_wrist", "orienting_3r",  "scara",      "scara_600",
                                                 "prrr_arm",        "prrr_column",   "youbot_arm", "rrprrr",
                                                 "puma560",         "stanford_arm",  "kr6_r900",   "irb6640",
                                                 "m10ia",           "ur5",           "ur10e",      "jaco2_6dof",
                                                 "six_r_16",        "panda",         "iiwa14",     "gen3_7dof"};
  return names;
}

/// `folder`: of the sources.
inline ShippedRobot shippedRobot(const std::string& folder, const std::string& name) {
  const YAML::Node config = YAML::LoadFile(folder + "/config/robots/" + name + ".yaml");
  return {name, readUrdfFile(folder + "/urdf/" + name + ".urdf"),
          Task::parse(config["task"].as<std::vector<std::string>>())};
}

}  // namespace test
}  // namespace screwline

#endif  // SCREWLINE_TEST_SHIPPED_ROBOTS_H
