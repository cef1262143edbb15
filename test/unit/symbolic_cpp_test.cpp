// Headers that are written for robots: compiled by the compiler that built this test, compared with the core.

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "quartic_arms.h"
#include "screwline/ik/method_summary.h"
#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/task_selection.h"
#include "screwline/spatial/rotation.h"
#include "screwline/symbolic/cpp_header.h"
#include "shipped_robots.h"

namespace screwline {
namespace {

constexpr int kConfigurations = 30;
constexpr double kAgreement = 1e-12;
constexpr double kSameSolution = 1e-7;  // [rad, m]

const std::vector<std::string>& robots() {
  static const std::vector<std::string> names = {"rrp_spherical", "orienting_3r", "scara", "rrprrr",    "puma560",
                                                 "stanford_arm",  "ur5",          "panda", "gen3_7dof", "jaco2_6dof"};
  return names;
}

/// These, an arm with five rows, and arms with a quartic of a turn and of a slide.
std::vector<test::ShippedRobot> arms() {
  std::vector<test::ShippedRobot> all;
  for (const std::string& name : robots()) all.push_back(test::shippedRobot(SCREWLINE_SOURCE_DIR, name));
  const SerialChain youbot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "youbot_arm").chain;
  all.push_back({"youbot_arm", youbot, deriveTask(youbot)});
  for (const int structure : {4, 1}) {
    const test::ArmMaker::Arm arm = test::QuarticArmMaker(320).make(structure);
    ChainDescription description = arm.chain.description();
    description.name = "quartic_" + std::to_string(structure);
    all.push_back({description.name, SerialChain(description), arm.task});
  }
  return all;
}

/// Prints, for each line of joint values, pose and Jacobian and then the inverse solutions of that pose.
const char* const kDriver = R"(
#include <cstdio>
#include <iostream>
#include <string>

namespace {

template <typename Pose, typename Jacobian>
void print(const Pose& X, const Jacobian& J) {
  for (const auto& row : X.R) {
    for (const double entry : row) std::printf("%.17g ", entry);
  }
  for (const double entry : X.p) std::printf("%.17g ", entry);
  for (const auto& row : J) {
    for (const double entry : row) std::printf("%.17g ", entry);
  }
}

template <typename Joints>
void read(Joints& q) {
  for (double& value : q) std::cin >> value;
}

)";

std::string callOf(const std::string& name, const std::optional<InverseFormulas>& inverse) {
  std::string text = "void run_" + name + "() {\n  " + name + "::Joints q{};\n  read(q);\n  const " + name +
                     "::Pose X = " + name + "::forward(q);\n  print(X, " + name + "::jacobian(q));\n";
  if (!inverse) return text + "  std::printf(\"0\\n\");\n}\n\n";
  const std::string given = inverse->given >= 0 ? ", q[" + std::to_string(inverse->given) + "]" : "";
  return text + "  const auto solutions = " + name + "::inverse(X" + given +
         ");\n  std::printf(\"%d \", static_cast<int>(solutions.size()));\n"
         "  for (const auto& solution : solutions) {\n"
         "    for (const double value : solution.q) std::printf(\"%.17g \", value);\n  }\n  "
         "std::printf(\"\\n\");\n}\n\n";
}

std::optional<InverseFormulas> formulasOf(const test::ShippedRobot& robot) {
  const std::optional<InverseOutline> outline = InverseKinematics(robot.chain, robot.task).outline();
  return outline ? inverseFormulasOf(robot.chain, robot.task, *outline) : std::nullopt;
}

double nearest(const SerialChain& chain, const VectorX& q, const std::vector<VectorX>& all) {
  double least = 1e9;
  for (const VectorX& other : all) {
    double worst = 0.0;
    for (int i = 0; i < chain.size(); ++i)
      worst = std::max(worst, std::abs(chain.joint(i).isRevolute() ? wrapAngle(q[i] - other[i]) : q[i] - other[i]));
    least = std::min(least, worst);
  }
  return least;
}

/// One line of the driver's output against the core.
void expectAgreement(const test::ShippedRobot& robot, const InverseKinematics* ik, const VectorX& q,
                     std::istream& line) {
  const auto next = [&line] {
    double value = std::numeric_limits<double>::quiet_NaN();
    line >> value;
    return value;
  };
  Matrix6X J(6, robot.chain.size());
  const Pose X = geometricJacobian(robot.chain, q, J);
  const double scale = std::max(1.0, X.p.norm());
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(next(), X.R(i / 3, i % 3), kAgreement);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(next(), X.p[i], kAgreement * scale);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < robot.chain.size(); ++j) EXPECT_NEAR(next(), J(i, j), kAgreement * scale);
  }
  const auto count = static_cast<int>(next());
  if (ik == nullptr) return;
  std::vector<VectorX> found;
  for (int k = 0; k < count; ++k) {
    found.emplace_back(robot.chain.size());
    for (int i = 0; i < robot.chain.size(); ++i) found.back()[i] = next();
  }
  const std::vector<VectorX> expected = everySolution(*ik)(X, q);
  EXPECT_EQ(found.size(), expected.size());
  for (const VectorX& solution : expected) EXPECT_LE(nearest(robot.chain, solution, found), kSameSolution);
}

/// Configuration `number` of a fixed sequence.
VectorX configuration(const SerialChain& chain, int number) {
  std::mt19937 random(static_cast<unsigned>(number) + 1);
  VectorX q(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    const double unit = static_cast<double>(random()) / 2147483648.0 - 1.0;
    q[i] = unit * (chain.joint(i).isRevolute() ? kPi : 0.7);
  }
  return q;
}

int run(const std::string& command) {
  return std::system(command.c_str());
}

TEST(SymbolicCpp, HeadersCompileAndAgreeWithTheCore) {
  const std::string folder = testing::TempDir() + "screwline_cpp_" + std::to_string(std::rand());
  ASSERT_EQ(run("mkdir -p '" + folder + "'"), 0);
  std::string includes;
  std::string functions;
  std::string calls;
  const std::vector<test::ShippedRobot> all = arms();
  std::vector<bool> has_inverse;
  std::ofstream input(folder + "/input.txt");
  input.precision(17);
  for (const test::ShippedRobot& robot : all) {
    const std::optional<InverseFormulas> inverse = formulasOf(robot);
    has_inverse.push_back(inverse.has_value());
    std::ofstream(folder + "/" + robot.name + ".h") << cppHeaderOf(robot.chain, inverse);
    includes += "#include \"" + robot.name + ".h\"\n";
    const std::string space = robot.chain.name();
    functions += callOf(space, inverse);
    for (int k = 0; k < kConfigurations; ++k) {
      calls += "  run_" + space + "();\n";
      input << configuration(robot.chain, k).transpose().format(Eigen::IOFormat(17)) << "\n";
    }
  }
  input.close();
  std::ofstream(folder + "/main.cpp") << includes << kDriver << functions << "}  // namespace\n\nint main() {\n"
                                      << calls << "}\n";
  ASSERT_EQ(run(std::string(SCREWLINE_CXX_COMPILER) +
                " -std=c++17 -O0 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror '" + folder +
                "/main.cpp' -o '" + folder + "/main'"),
            0);
  ASSERT_EQ(run("'" + folder + "/main' < '" + folder + "/input.txt' > '" + folder + "/output.txt'"), 0);
  std::ifstream output(folder + "/output.txt");
  int with_inverse = 0;
  for (std::size_t r = 0; r < all.size(); ++r) {
    SCOPED_TRACE(all[r].name);
    const InverseKinematics ik(all[r].chain, all[r].task);
    if (has_inverse[r]) ++with_inverse;
    for (int k = 0; k < kConfigurations; ++k) {
      std::string line;
      ASSERT_TRUE(std::getline(output, line));
      std::istringstream stream(line);
      expectAgreement(all[r], has_inverse[r] ? &ik : nullptr, configuration(all[r].chain, k), stream);
    }
  }
  EXPECT_EQ(with_inverse, static_cast<int>(all.size()) - 1);  // All but the one that is solved by elimination.
  run("rm -r '" + folder + "'");
}

TEST(SymbolicCpp, AHeaderNeedsOnlyTheStandardLibrary) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "puma560");
  std::istringstream header(cppHeaderOf(robot.chain, formulasOf(robot)));
  std::vector<std::string> included;
  for (std::string line; std::getline(header, line);) {
    if (line.rfind("#include", 0) == 0) included.push_back(line);
  }
  EXPECT_EQ(included, (std::vector<std::string>{"#include <array>", "#include <cmath>", "#include <vector>"}));
}

}  // namespace
}  // namespace screwline
