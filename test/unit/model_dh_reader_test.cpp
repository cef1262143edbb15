#include "screwline/model/dh_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "screwline/exception.h"
#include "screwline/kinematics/forward.h"
#include "screwline/model/urdf_reader.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

const std::string kJoint = "name: j1, type: revolute, alpha: 0, a: 0, d: 0, theta: 0, lower: -1, upper: 1";

std::string table(const std::string& joint, const std::string& rest = "") {
  return "name: arm\njoints:\n  - {" + joint + "}\n" + rest;
}

TEST(DhReader, ReadsATable) {
  const SerialChain chain = readDhYaml(
      "name: arm\n"
      "joints:\n"
      "  - {name: theta1, type: revolute, alpha: 0, a: 0, d: 0.3, theta: 0, lower: -pi, upper: pi, velocity: 2}\n"
      "  - {name: d2, type: prismatic, alpha: -pi/2, a: 0.1, d: 0, theta: 0, lower: 0, upper: 1}\n"
      "  - {name: theta3, type: continuous, alpha: 0, a: 0, d: 0, theta: 2*pi/3, velocity: 1, acceleration: 5, jerk: "
      "7}\n"
      "base: {xyz: [1, 2, 3]}\n"
      "tool: {xyz: [0.1, 0, 0], rpy: [0, pi/2, 0]}\n");
  EXPECT_EQ(chain.name(), "arm");
  EXPECT_EQ(chain.jointNames(), (std::vector<std::string>{"theta1", "d2", "theta3"}));
  EXPECT_EQ(chain.joint(1).type, JointType::kPrismatic);
  EXPECT_EQ(chain.joint(2).type, JointType::kContinuous);
  EXPECT_EQ(chain.lower()[0], -kPi);
  EXPECT_EQ(chain.modifiedDh().rows[1].alpha, -kPi / 2);
  EXPECT_DOUBLE_EQ(chain.modifiedDh().rows[2].theta, 2 * kPi / 3);
  EXPECT_TRUE(chain.axes()[0].point.isApprox(Vector3(1, 2, 3.3)));
  EXPECT_TRUE(chain.axes()[1].direction.isApprox(Vector3(0, 1, 0)));
  EXPECT_EQ(chain.joint(0).limits.velocity, 2.0);
  EXPECT_TRUE(chain.joint(0).limits.acceleration_assumed);
  EXPECT_TRUE(chain.joint(1).limits.velocity_assumed);
  EXPECT_EQ(chain.joint(2).limits.jerk, 7.0);
  EXPECT_FALSE(chain.joint(2).limits.jerk_assumed);
  EXPECT_EQ(chain.links().size(), 5U);
  EXPECT_EQ(chain.findLink("link_2")->axis_count, 2);
}

/// X = Rx(alpha) Tx(a) Rz(theta) Tz(d), written out as Craig's eq. 3.6.
Pose craig(double alpha, double a, double theta, double d) {
  Pose X;
  const double ct = std::cos(theta), st = std::sin(theta), ca = std::cos(alpha), sa = std::sin(alpha);
  X.R << ct, -st, 0, st * ca, ct * ca, -sa, st * sa, ct * sa, ca;
  X.p << a, -sa * d, ca * d;
  return X;
}

TEST(DhReader, RowsAreCraigs) {
  const SerialChain chain = readDhYaml(
      "name: arm\njoints:\n"
      "  - {name: a, type: revolute, alpha: 0.3, a: 0.4, d: 0.5, theta: 0.6, lower: -3, upper: 3}\n"
      "  - {name: b, type: prismatic, alpha: -1.3, a: -0.2, d: 0.7, theta: 1.6, lower: -3, upper: 3}\n");
  const VectorX q = (VectorX(2) << 0.9, -0.35).finished();
  const Pose expected = craig(0.3, 0.4, 0.6 + 0.9, 0.5) * craig(-1.3, -0.2, 1.6, 0.7 - 0.35);
  EXPECT_TRUE(isApprox(forwardKinematics(chain, q), expected, 1e-14));
  EXPECT_TRUE(isApprox(forwardByExponentials(chain, q), expected, 1e-14));
}

TEST(DhReader, AnglesMayBeMultiplesOfPi) {
  const std::vector<std::pair<std::string, double>> cases = {
      {"pi", kPi},
      {"-pi", -kPi},
      {"+pi/2", kPi / 2},
      {"-2*pi/3", -2 * kPi / 3},
      {"0.5*pi", kPi / 2},
      {"pi / 4", kPi / 4},
      {"2 * pi / 3", 2 * kPi / 3},
      {"1.25", 1.25},
      {"-1e-3", -1e-3},
      {"'pi/6'", kPi / 6},
      {"-.5", -0.5},
      {"0", 0.0},
  };
  for (const auto& [text, value] : cases) {
    const SerialChain chain =
        readDhYaml(table("name: j, type: revolute, alpha: " + text + ", a: 0, d: 0, theta: 0, lower: -1, upper: 1"));
    EXPECT_NEAR(chain.modifiedDh().rows[0].alpha, value, 1e-15) << text;
  }
}

struct BadTable {
  std::string yaml;
  std::vector<std::string> said;
};

void expectRefused(const BadTable& bad) {
  try {
    readDhYaml(bad.yaml);
    ADD_FAILURE() << "was read:\n" << bad.yaml;
  } catch (const ModelError& error) {
    for (const std::string& part : bad.said) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
          << "no \"" << part << "\" in: " << error.what() << "\n"
          << bad.yaml;
    }
  }
}

TEST(DhReader, BadTablesAreRefusedAndTheMessageSaysWhy) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string joint = kJoint;
    joint.replace(joint.find(from), from.size(), to);
    return table(joint);
  };
  const std::vector<BadTable> cases = {
      {"", {"document", "map"}},
      {"just text", {"document", "'just text'"}},
      {"[1, 2]", {"document", "a list"}},
      {"name: [", {"YAML", "malformed"}},
      {"name: arm\nbase: {xyz: [0, 0, 0], rpy:]}\n", {"malformed", "line 2", "']' closes no '['"}},
      {"name: arm\n", {"joints", "list of at least one"}},
      {"name: arm\njoints: []\n", {"joints", "list of at least one"}},
      {"name: arm\njoints: {a: 1}\n", {"joints", "list of at least one"}},
      {"joints:\n  - {" + kJoint + "}\n", {"name", "missing"}},
      {table(kJoint, "colour: red\n"), {"document", "unknown key 'colour'", "base"}},
      {table(kJoint, "name: again\n"), {"document", "'name'", "twice"}},
      {table(kJoint + ", mass: 3"), {"joints[0]", "unknown key 'mass'"}},
      {table(kJoint + ", a: 3"), {"joints[0]", "'a'", "twice"}},
      {table(kJoint + "}\n  - {" + kJoint), {"'j1'", "twice"}},
      {"name: arm\njoints: [3]\n", {"joints[0]", "'3'", "map"}},
      {with("name: j1, ", ""), {"joints[0]", "'name'", "missing"}},
      {with("type: revolute, ", ""), {"'j1'", "'type'", "missing"}},
      {with("revolute", "hinge"), {"'j1'", "'hinge'", "prismatic"}},
      {with("alpha: 0, ", ""), {"'j1'", "'alpha'", "missing"}},
      {with("theta: 0, ", ""), {"'j1'", "'theta'", "missing"}},
      {with("d: 0", "d: pi"), {"'j1'", ".d", "'pi'", "number"}},
      {with("d: 0", "d: 0,5"), {"joints[0]", "unknown key '5'"}},
      {with("d: 0", "d: '0,5'"), {"'j1'", ".d", "'0,5'"}},
      {with("d: 0", "d: .nan"), {"'j1'", ".d", "'.nan'"}},
      {with("d: 0", "d: .inf"), {"'j1'", ".d", "'.inf'"}},
      {with("d: 0", "d: nan"), {"'j1'", ".d", "'nan'"}},
      {with("d: 0", "d: 1e7"), {"'j1'", ".d", "1e7", "1e+06"}},
      {with("d: 0", "d: [1]"), {"'j1'", ".d", "a list"}},
      {with("d: 0", "d: "), {"'j1'", ".d", "empty"}},
      {with("alpha: 0", "alpha: pi/0"), {"'j1'", ".alpha", "'pi/0'"}},
      {with("alpha: 0", "alpha: 2pi"), {"'j1'", ".alpha", "'2pi'"}},
      {with("alpha: 0", "alpha: pipi"), {"'j1'", ".alpha", "'pipi'"}},
      {with("alpha: 0", "alpha: 90 deg"), {"'j1'", ".alpha", "'90 deg'"}},
      {with("lower: -1, ", ""), {"'j1'", "'lower'", "missing"}},
      {with("upper: 1", "upper: -2"), {"'j1'", "lower -1", "upper -2"}},
      {with("revolute", "continuous"), {"'j1'", "continuous", "lower"}},
      {table(kJoint + ", velocity: 0"), {"'j1'", ".velocity", "0", "above 0"}},
      {table(kJoint + ", jerk: -3"), {"'j1'", ".jerk", "-3"}},
      {table(kJoint, "base: {xyz: [1, 2]}\n"), {"base.xyz", "3 numbers"}},
      {table(kJoint, "tool: {rpy: [1, 2, x]}\n"), {"tool.rpy[2]", "'x'"}},
      {table(kJoint, "tool: {quaternion: [1, 2, 3]}\n"), {"tool", "'quaternion'", "xyz"}},
      {table(kJoint, "base: 3\n"), {"base", "'3'", "map"}},
  };
  for (const BadTable& bad : cases) expectRefused(bad);
}

TEST(DhReader, TooManyJointsAreRefused) {
  std::string yaml = "name: arm\njoints:\n";
  for (int i = 0; i < 65; ++i) {
    yaml += "  - {name: j" + std::to_string(i) + ", type: continuous, alpha: 0, a: 0.1, d: 0, theta: 0}\n";
    EXPECT_TRUE(i != 63 || readDhYaml(yaml).size() == 64);
  }
  try {
    readDhYaml(yaml);
    FAIL();
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find("65 joints, at most 64"), std::string::npos) << error.what();
  }
}

TEST(DhReader, FileThatIsNotThereIsRefused) {
  EXPECT_THROW(readDhYamlFile("/nowhere/arm.yaml"), ModelError);
  EXPECT_THROW(readDhYamlFile("/"), ModelError);
}

TEST(DhReader, ShippedTablesAreReadAndTurnedIntoUrdf) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(SCREWLINE_SOURCE_DIR) + "/config/dh")) {
    const SerialChain chain = readDhYamlFile(entry.path().string());
    const SerialChain again = readUrdf(toUrdf(chain));
    const VectorX q = VectorX::LinSpaced(chain.size(), 0.1, 0.7);
    EXPECT_TRUE(isApprox(forwardKinematics(again, q), forwardKinematics(chain, q), 1e-13)) << entry.path();
    EXPECT_EQ(again.jointNames(), chain.jointNames());
    ++count;
  }
  EXPECT_GE(count, 2);
}

TEST(UrdfWriter, EscapesNames) {
  std::string yaml = table(kJoint);
  yaml.replace(yaml.find("arm"), 3, "'a & <b> \"c\"'");
  EXPECT_EQ(readUrdf(toUrdf(readDhYaml(yaml))).name(), "a & <b> \"c\"");
}

}  // namespace
}  // namespace screwline
