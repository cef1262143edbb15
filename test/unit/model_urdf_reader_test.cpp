#include "screwline/model/urdf_reader.h"

#include <console_bridge/console.h>
#include <gtest/gtest.h>

#include <clocale>
#include <locale>
#include <string>

#include "screwline/exception.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

std::string robot(const std::string& body) {
  return "<robot name=\"arm\">" + body + "</robot>";
}

std::string link(const std::string& name) {
  return "<link name=\"" + name + "\"/>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& inner = "") {
  return link(child) + "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/>" + inner + "</joint>";
}

const std::string kLimit = "<limit lower=\"-1\" upper=\"2\" velocity=\"3\" effort=\"4\"/>";
const std::string kZ = "<axis xyz=\"0 0 1\"/>";

/// world -f0- base -j1- upper -j2- lower -f1- tool, a camera on upper, a finger on tool.
std::string arm() {
  return robot(link("world") + joint("f0", "fixed", "world", "base", "<origin xyz=\"0 0 0.5\"/>") +
               joint("j1", "revolute", "base", "upper", "<origin xyz=\"0 0 1\"/>" + kZ + kLimit) +
               joint("j2", "prismatic", "upper", "lower", "<origin xyz=\"0 2 0\"/><axis xyz=\"2 0 0\"/>" + kLimit) +
               joint("f1", "fixed", "lower", "tool", "<origin xyz=\"0 0 3\"/>") +
               joint("f2", "fixed", "upper", "camera", "<origin xyz=\"0.1 0 0\"/>") +
               joint("j3", "revolute", "tool", "finger", kLimit));
}

std::string messageOf(const std::string& urdf, const ChainChoice& choice = {}) {
  try {
    readUrdf(urdf, choice);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

testing::AssertionResult says(const std::string& message, const std::string& part) {
  if (message.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "no \"" << part << "\" in \"" << message << "\"";
}

TEST(UrdfReader, TakesTheChosenChain) {
  const SerialChain chain = readUrdf(arm(), {"base", "tool"});
  EXPECT_EQ(chain.name(), "arm");
  EXPECT_EQ(chain.baseLink(), "base");
  EXPECT_EQ(chain.tipLink(), "tool");
  ASSERT_EQ(chain.jointNames(), (std::vector<std::string>{"j1", "j2"}));
  EXPECT_EQ(chain.joint(0).type, JointType::kRevolute);
  EXPECT_EQ(chain.joint(1).type, JointType::kPrismatic);
  EXPECT_FALSE(chain.hasMimic());
  EXPECT_TRUE(isApprox(chain.home(), Pose{Matrix3::Identity(), Vector3(0, 2, 4)}, 1e-15));
  EXPECT_TRUE(chain.axes()[0].point.isApprox(Vector3(0, 0, 1)));
  EXPECT_TRUE(chain.axes()[1].direction.isApprox(Vector3(1, 0, 0))) << "an axis is made a unit vector";
}

TEST(UrdfReader, KeepsLinksThatFixedJointsHold) {
  const SerialChain chain = readUrdf(arm(), {"base", "tool"});
  ASSERT_NE(chain.findLink("camera"), nullptr);
  EXPECT_EQ(chain.findLink("camera")->axis_count, 1);
  EXPECT_TRUE(chain.findLink("camera")->home.p.isApprox(Vector3(0.1, 0, 1)));
  ASSERT_NE(chain.findLink("world"), nullptr) << "above the base too";
  EXPECT_EQ(chain.findLink("world")->axis_count, 0);
  EXPECT_TRUE(chain.findLink("world")->home.p.isApprox(Vector3(0, 0, -0.5)));
  EXPECT_EQ(chain.findLink("lower")->axis_count, 2);
  EXPECT_EQ(chain.findLink("finger"), nullptr) << "j3 moves it against the chain";
  EXPECT_EQ(chain.links().size(), 6U);
}

TEST(UrdfReader, TakesTheOnlyChainByItself) {
  const std::string body = link("root") + joint("j1", "continuous", "root", "b", kZ) + joint("f", "fixed", "b", "tool");
  const SerialChain chain = readUrdf(robot(body));
  EXPECT_EQ(chain.baseLink(), "root");
  EXPECT_EQ(chain.tipLink(), "tool");
}

TEST(UrdfReader, HalfAChoiceIsCompleted) {
  EXPECT_EQ(readUrdf(arm(), {"", "tool"}).baseLink(), "world");
  EXPECT_EQ(readUrdf(arm(), {"lower", ""}).tipLink(), "finger");
  EXPECT_TRUE(says(messageOf(arm()), "several chains start at link 'world', they end at 'camera', 'finger'"));
}

TEST(UrdfReader, BaseMayBeInTheMiddle) {
  const SerialChain chain = readUrdf(arm(), {"upper", "finger"});
  EXPECT_EQ(chain.jointNames(), (std::vector<std::string>{"j2", "j3"}));
  EXPECT_EQ(chain.findLink("base"), nullptr);
}

TEST(UrdfReader, LeavesThatNoJointMovesDoNotCount) {
  const std::string body =
      link("root") + joint("f", "fixed", "root", "base_frame") + joint("j1", "continuous", "root", "tool", kZ);
  EXPECT_EQ(readUrdf(robot(body)).tipLink(), "tool");
}

TEST(UrdfReader, ChoicesThatDoNotFitAreRefused) {
  EXPECT_TRUE(says(messageOf(arm(), {"nowhere", ""}), "base_link 'nowhere' is not a link of robot 'arm'"));
  EXPECT_TRUE(says(messageOf(arm(), {"", "nowhere"}), "tip_link 'nowhere' is not a link of robot 'arm'"));
  EXPECT_TRUE(says(messageOf(arm(), {"", "nowhere"}), "'camera'"));
  EXPECT_TRUE(says(messageOf(arm(), {"tool", "base"}), "tip_link 'base' is not below base_link 'tool'"));
  EXPECT_TRUE(says(messageOf(arm(), {"tool", "tool"}), "base_link and tip_link are both 'tool'"));
  EXPECT_TRUE(says(messageOf(arm(), {"lower", "tool"}), "no moving joint between 'lower' and 'tool'"));
  EXPECT_TRUE(says(messageOf(arm(), {"camera", ""}), "no moving joint below link 'camera'"));
}

TEST(UrdfReader, LimitsAreReadAndTheRestAssumed) {
  const JointLimits limits = readUrdf(arm(), {"base", "tool"}).joint(0).limits;
  EXPECT_EQ(limits.lower, -1.0);
  EXPECT_EQ(limits.upper, 2.0);
  EXPECT_EQ(limits.velocity, 3.0);
  EXPECT_EQ(limits.acceleration, 3.0 / kAssumedAccelerationTime);
  EXPECT_EQ(limits.jerk, 3.0 / kAssumedAccelerationTime / kAssumedJerkTime);
  EXPECT_FALSE(limits.velocity_assumed);
  EXPECT_TRUE(limits.acceleration_assumed);
  EXPECT_TRUE(limits.jerk_assumed);
}

TEST(UrdfReader, VelocityThatIsMissingOrZeroIsAssumed) {
  for (const std::string velocity : {"", "velocity=\"0\" effort=\"1\"", "effort=\"1\""}) {
    const std::string limit = "<limit lower=\"-1\" upper=\"1\" " + velocity + "/>";
    const JointLimits limits = readUrdf(robot(link("a") + joint("j", "revolute", "a", "b", limit))).joint(0).limits;
    EXPECT_EQ(limits.velocity, kAssumedVelocity) << limit;
    EXPECT_TRUE(limits.velocity_assumed) << limit;
  }
}

TEST(UrdfReader, ContinuousJointsHaveNoBounds) {
  for (const std::string& limit : {std::string(), kLimit}) {
    const SerialChain chain = readUrdf(robot(link("a") + joint("j", "continuous", "a", "b", limit)));
    EXPECT_EQ(chain.joint(0).type, JointType::kContinuous);
    EXPECT_TRUE(std::isinf(chain.lower()[0]));
    EXPECT_TRUE(std::isinf(chain.upper()[0]));
  }
}

TEST(UrdfReader, OneBoundIsEnoughTheOtherIsZeroAsUrdfSays) {
  const SerialChain chain = readUrdf(robot(link("a") + joint("j", "revolute", "a", "b", "<limit upper=\"1\"/>")));
  EXPECT_EQ(chain.lower()[0], 0.0);
  EXPECT_EQ(chain.upper()[0], 1.0);
}

TEST(UrdfReader, AxisIsXWhereNoneIsGiven) {
  const SerialChain chain = readUrdf(robot(link("a") + joint("j", "continuous", "a", "b")));
  EXPECT_EQ(chain.axes()[0].direction, Vector3(1, 0, 0));
}

TEST(UrdfReader, MimicIsAnAxisOfItsSource) {
  const std::string body = link("a") + joint("j1", "revolute", "a", "b", kZ + kLimit) +
                           joint("j2", "revolute", "b", "c",
                                 "<origin xyz=\"1 0 0\"/>" + kZ +
                                     "<limit lower=\"-1\" upper=\"1.5\" velocity=\"3\" effort=\"1\"/>"
                                     "<mimic joint=\"j1\" multiplier=\"-2\" offset=\"0.5\"/>");
  const SerialChain chain = readUrdf(robot(body));
  ASSERT_EQ(chain.size(), 1);
  ASSERT_EQ(chain.axes().size(), 2U);
  EXPECT_TRUE(chain.hasMimic());
  EXPECT_EQ(chain.axes()[1].source, 0);
  EXPECT_EQ(chain.axes()[1].multiplier, -2.0);
  EXPECT_TRUE(chain.home().R.isApprox(rotationAbout(Vector3::UnitZ(), 0.5))) << "the offset is in the zero pose";
  EXPECT_DOUBLE_EQ(chain.lower()[0], -0.5) << "-2 q + 0.5 <= 1.5";
  EXPECT_DOUBLE_EQ(chain.upper()[0], 0.75) << "-2 q + 0.5 >= -1";
  EXPECT_DOUBLE_EQ(chain.joint(0).limits.velocity, 1.5);
}

TEST(UrdfReader, MimicOfMimicIsFollowedAndMayComeBeforeItsSource) {
  const std::string wide = "<limit lower=\"-99\" upper=\"99\" velocity=\"99\" effort=\"1\"/>";
  const std::string body =
      link("a") + joint("j1", "revolute", "a", "b", wide + "<mimic joint=\"j2\" multiplier=\"3\" offset=\"0.25\"/>") +
      joint("j2", "prismatic", "b", "c", wide + "<mimic joint=\"j3\" multiplier=\"2\" offset=\"0.5\"/>") +
      joint("j3", "revolute", "c", "d", kLimit);
  const SerialChain chain = readUrdf(robot(body));
  ASSERT_EQ(chain.jointNames(), std::vector<std::string>{"j3"});
  EXPECT_EQ(chain.axes()[0].multiplier, 6.0);
  EXPECT_EQ(chain.axes()[1].multiplier, 2.0);
  EXPECT_TRUE(chain.axes()[1].prismatic);
  EXPECT_TRUE(chain.findLink("b")->home.R.isApprox(rotationAbout(Vector3::UnitX(), 3 * 0.5 + 0.25)));
  EXPECT_EQ(chain.lower()[0], -1.0);
}

TEST(UrdfReader, MimicBoundsAContinuousSource) {
  const std::string body = link("a") + joint("j1", "continuous", "a", "b") +
                           joint("j2", "revolute", "b", "c", kLimit + "<mimic joint=\"j1\"/>");
  const SerialChain chain = readUrdf(robot(body));
  EXPECT_EQ(chain.joint(0).type, JointType::kRevolute);
  EXPECT_EQ(chain.lower()[0], -1.0);
  EXPECT_EQ(chain.upper()[0], 2.0);
}

TEST(UrdfReader, MimicWithMultiplierZeroStands) {
  const std::string body =
      link("a") + joint("j1", "revolute", "a", "b", kLimit) +
      joint("j2", "prismatic", "b", "c", kLimit + "<mimic joint=\"j1\" multiplier=\"0\" offset=\"0.5\"/>");
  const SerialChain chain = readUrdf(robot(body));
  EXPECT_EQ(chain.axes().size(), 1U);
  EXPECT_TRUE(chain.home().p.isApprox(Vector3(0.5, 0, 0)));
}

TEST(UrdfReader, MimicBesideTheChainIsPassedOver) {
  const std::string body = link("a") + joint("j1", "revolute", "a", "b", kLimit) +
                           joint("j2", "revolute", "b", "finger", kLimit + "<mimic joint=\"j1\"/>") +
                           joint("f", "fixed", "b", "tool");
  const SerialChain chain = readUrdf(robot(body), {"", "tool"});
  EXPECT_EQ(chain.axes().size(), 1U);
  EXPECT_TRUE(says(messageOf(robot(body), {"b", "finger"}), "mimics joint 'j1', which is not in the chain"));
}

TEST(UrdfReader, WhatIsNotKinematicsDoesNotMatter) {
  const std::string body =
      "<!-- a comment --><material name=\"red\"/><gazebo/><transmission name=\"t\"/>"
      "<link name=\"a\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" "
      "izz=\"1\"/>"
      "</inertial></link>" +
      joint("j", "revolute", "a", "b",
            kLimit +
                "<dynamics damping=\"1\"/><safety_controller soft_lower_limit=\"0\" soft_upper_limit=\"0.1\" "
                "k_position=\"1\" k_velocity=\"1\"/>");
  const SerialChain chain = readUrdf("<?xml version=\"1.0\"?>\n" + robot(body));
  EXPECT_EQ(chain.lower()[0], -1.0) << "a safety controller's limits are not the joint's";
}

TEST(UrdfReader, NamesMayHaveMarkup) {
  const SerialChain chain =
      readUrdf(robot(link("a &amp; b") + joint("&lt;j&quot;&gt;", "continuous", "a &amp; b", "c")));
  EXPECT_EQ(chain.baseLink(), "a & b");
  EXPECT_EQ(chain.joint(0).name, "<j\">");
}

TEST(UrdfReader, SaysNothingOnTheConsoleAndRestoresItsHandler) {
  console_bridge::OutputHandler* const before = console_bridge::getOutputHandler();
  const console_bridge::LogLevel level = console_bridge::getLogLevel();
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  messageOf(robot(link("a") + joint("j", "hinge", "a", "b")));
  readUrdf(robot(link("a") + joint("j", "continuous", "a", "b")));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(console_bridge::getOutputHandler(), before);
  EXPECT_EQ(console_bridge::getLogLevel(), level);
}

class DecimalComma : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
};

TEST(UrdfReader, DecimalPointWhateverTheLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale(), new DecimalComma));
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"}) {
    if (std::setlocale(LC_NUMERIC, name) != nullptr) break;
  }
  const std::string limit = "<origin xyz=\"0.125 0 0\"/><limit lower=\"-0.5\" upper=\"1.5\"/>";
  const SerialChain chain = readUrdf(robot(link("a") + joint("j", "revolute", "a", "b", limit)));
  const std::string message = messageOf(robot(link("a") + joint("j", "revolute", "a", "b", "<limit lower=\"1.5\"/>")));
  std::locale::global(before);
  std::setlocale(LC_NUMERIC, "C");
  EXPECT_EQ(chain.home().p.x(), 0.125);
  EXPECT_EQ(chain.lower()[0], -0.5);
  EXPECT_TRUE(says(message, "lower limit 1.5"));
}

}  // namespace
}  // namespace screwline
