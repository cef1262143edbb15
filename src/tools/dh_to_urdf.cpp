// Turns a modified-DH table in YAML into a URDF on standard output. Needs no ROS master.

#include <iostream>
#include <string>

#include "screwline/exception.h"
#include "screwline/model/dh_reader.h"

namespace {

constexpr int kUsageError = 2;

constexpr const char* kUsage =
    "usage: dh_to_urdf TABLE.yaml > ROBOT.urdf\n"
    "Turns a modified Denavit-Hartenberg table (Craig) into a URDF. The table:\n"
    "  name: my_arm\n"
    "  joints:  # base to tip; lengths in m, angles in rad, 'pi/2' is understood\n"
    "    - {name: theta1, type: revolute, alpha: 0, a: 0, d: 0.3, theta: 0, lower: -pi, upper: pi, velocity: 2}\n"
    "    - {name: d2, type: prismatic, alpha: -pi/2, a: 0, d: 0, theta: 0, lower: 0, upper: 1}\n"
    "  base: {xyz: [0, 0, 0], rpy: [0, 0, 0]}    # optional, around the table\n"
    "  tool: {xyz: [0.1, 0, 0], rpy: [0, 0, 0]}  # optional\n";

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && (std::string(argv[1]) == "-h" || std::string(argv[1]) == "--help")) {
    std::cout << kUsage;
    return 0;
  }
  if (argc != 2) {
    std::cerr << kUsage;
    return kUsageError;
  }
  try {
    std::cout << screwline::toUrdf(screwline::readDhYamlFile(argv[1])) << std::flush;
  } catch (const screwline::ModelError& error) {
    std::cerr << "dh_to_urdf: " << error.what() << "\n";
    return 1;
  }
  if (!std::cout) {
    std::cerr << "dh_to_urdf: standard output cannot be written\n";
    return 1;
  }
  return 0;
}
