#include "screwline/ros/params.h"

#include <limits>

#include "screwline/ros/robot_loader.h"
#include "unit/ros_arm.h"

namespace screwline {
namespace ros_bridge {
namespace {

using XmlRpc::XmlRpcValue;

/// A struct of one key.
template <typename T>
XmlRpcValue with(const std::string& key, const T& value) {
  XmlRpcValue values;
  values[key] = value;
  return values;
}

XmlRpcValue texts(const std::vector<std::string>& entries) {
  XmlRpcValue list;
  list.setSize(static_cast<int>(entries.size()));
  for (std::size_t i = 0; i < entries.size(); ++i) list[static_cast<int>(i)] = entries[i];
  return list;
}

void expectBad(const XmlRpcValue& values, const std::string& words) {
  expectModelError([&] { readKinematicsParams(values); }, words);
}

TEST(KinematicsParams, Defaults) {
  const KinematicsParams params = readKinematicsParams(XmlRpcValue());
  EXPECT_EQ(params.ik_timeout, 0.1);
  EXPECT_EQ(params.threads, 0);
  EXPECT_EQ(params.max_batch, 1000000);
  EXPECT_EQ(params.robot.max_joints, 64);
  EXPECT_EQ(params.rotation_weight, 1.0);
  EXPECT_TRUE(params.robot.task.empty());
  EXPECT_TRUE(params.robot.base_link.empty());
}

TEST(KinematicsParams, EveryKey) {
  XmlRpcValue values;
  values["base_link"] = "b";
  values["tip_link"] = "t";
  values["task"] = texts({"x", "rz"});
  values["ik_timeout"] = 2;
  values["threads"] = 3;
  values["max_batch"] = 10;
  values["max_joints"] = 7;
  values["rotation_weight"] = 0.5;
  values["robot_description"] = "<robot/>";
  const KinematicsParams params = readKinematicsParams(values);
  EXPECT_EQ(params.robot.base_link, "b");
  EXPECT_EQ(params.robot.tip_link, "t");
  EXPECT_EQ(params.robot.task, (std::vector<std::string>{"x", "rz"}));
  EXPECT_EQ(params.ik_timeout, 2.0);
  EXPECT_EQ(params.threads, 3);
  EXPECT_EQ(params.max_batch, 10);
  EXPECT_EQ(params.robot.max_joints, 7);
  EXPECT_EQ(params.rotation_weight, 0.5);
}

TEST(KinematicsParams, WrongTypesNameTheKey) {
  expectBad(with("ik_timeout", "soon"), "~ik_timeout is a string, it must be a number");
  expectBad(with("threads", 1.5), "~threads is a number, it must be an integer");
  expectBad(with("max_batch", true), "~max_batch is a boolean, it must be an integer");
  expectBad(with("base_link", 3), "~base_link is an integer, it must be a string");
  expectBad(with("task", "x"), "~task is a string, it must be a list of strings");
  XmlRpcValue mixed = texts({"x", "y"});
  mixed[1] = 2;
  expectBad(with("task", mixed), "~task[1] is an integer, it must be a string");
  expectBad(XmlRpcValue(3), "~ is an integer, it must be a struct");
}

TEST(KinematicsParams, WrongValuesNameTheBound) {
  expectBad(with("ik_timeout", 0.0), "~ik_timeout is 0, it must be above 0 and at most 3600");
  expectBad(with("ik_timeout", std::numeric_limits<double>::quiet_NaN()), "~ik_timeout is nan");
  expectBad(with("ik_timeout", std::numeric_limits<double>::infinity()), "~ik_timeout is inf");
  expectBad(with("threads", -1), "~threads is -1, it must be from 0 to 1024");
  expectBad(with("max_joints", 65), "~max_joints is 65, it must be from 1 to 64");
  expectBad(with("conditions_timeout", -0.5), "~conditions_timeout is -0.5, it must be from 0 to");
  EXPECT_EQ(readKinematicsParams(with("conditions_timeout", 0)).conditions_timeout, 0.0);
  expectBad(with("rotation_weight", -0.1), "~rotation_weight is -0.1");
  expectBad(with("task", texts({})), "~task has no rows");
}

TEST(KinematicsParams, UnknownKey) {
  expectBad(with("ik_timout", 0.1),
            "~ik_timout is no parameter; known are base_link, batch_timeout, conditions_timeout, derive_timeout");
}

TEST(PlanningLimits, FlagsAreObeyed) {
  XmlRpcValue values;
  values["a"]["max_acceleration"] = 3;
  values["a"]["has_jerk_limits"] = false;
  values["a"]["max_jerk"] = 4.0;
  values["b"]["has_velocity_limits"] = true;
  values["b"]["max_velocity"] = 5.0;
  values["b"]["has_position_limits"] = true;
  const PlanningLimits limits = readPlanningLimits(values, "limits");
  EXPECT_EQ(limits.rates.at("a").acceleration, 3.0);
  EXPECT_FALSE(limits.rates.at("a").jerk);
  EXPECT_FALSE(limits.rates.at("a").velocity);
  EXPECT_EQ(limits.rates.at("b").velocity, 5.0);
  EXPECT_EQ(limits.with_positions, std::vector<std::string>{"b"});
  EXPECT_TRUE(readPlanningLimits(XmlRpcValue(), "limits").rates.empty());
}

TEST(PlanningLimits, WhatIsRefused) {
  const auto refused = [](const XmlRpcValue& joint, const std::string& words) {
    expectModelError([&] { readPlanningLimits(with("a", joint), "limits"); }, words);
  };
  refused(with("has_jerk_limits", true), "limits/a/has_jerk_limits is true, max_jerk is missing");
  refused(with("has_jerk_limits", 1), "limits/a/has_jerk_limits is an integer, it must be a boolean");
  refused(with("max_jerk", "much"), "limits/a/max_jerk is a string");
  refused(with("max_acceleration", 0), "limits/a/max_acceleration is 0, it must be above 0");
  refused(XmlRpcValue(3), "limits/a/ is an integer, it must be a struct");
  expectModelError([] { readPlanningLimits(XmlRpcValue(3), "limits"); }, "limits must be a struct");
}

bool noted(const ServedRobot& robot, const std::string& words) {
  for (const std::string& note : robot.notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

RobotParams toCamera() {
  RobotParams params;
  params.base_link = "base";
  params.tip_link = "camera";
  return params;
}

TEST(RobotLoader, AssumesAndNotes) {
  const ServedRobot robot = makeRobot({armUrdf(), "/robot_description", {}}, toCamera());
  EXPECT_EQ(robot.chain->size(), 3);
  EXPECT_EQ(robot.chain->joint(0).limits.acceleration, 8.0);
  EXPECT_EQ(robot.task.names(), (std::vector<std::string>{"x", "y", "rz"}));
  EXPECT_TRUE(noted(robot, "the task x, y, rz is derived"));
  EXPECT_TRUE(noted(robot, "acceleration limits are assumed (full speed in 0.25 s): a, b, c"));
  EXPECT_TRUE(noted(robot, "jerk limits are assumed (full acceleration in 0.05 s): a, b, c"));
}

TEST(RobotLoader, PlanningLimits) {
  XmlRpcValue limits;
  limits["b"]["max_acceleration"] = 3.0;
  limits["b"]["max_jerk"] = 30.0;
  limits["b"]["max_velocity"] = 1.0;
  limits["gripper"]["max_jerk"] = 1.0;
  const ServedRobot robot = makeRobot({armUrdf(), "/robot_description", limits}, toCamera());
  EXPECT_EQ(robot.chain->joint(1).limits.acceleration, 3.0);
  EXPECT_EQ(robot.chain->joint(1).limits.jerk, 30.0);
  EXPECT_EQ(robot.chain->joint(1).limits.velocity, 2.0);
  EXPECT_TRUE(noted(robot, "velocity limit of b is 2 from the robot description; max_velocity 1 is not read"));
  EXPECT_TRUE(noted(robot, "jerk limits are assumed (full acceleration in 0.05 s): a, c"));
}

TEST(RobotLoader, WhatIsRefused) {
  RobotParams params = toCamera();
  params.task = {"x", "q"};
  expectModelError([&] { makeRobot({armUrdf(), "d", {}}, params); }, "~task: ");
  params = toCamera();
  params.max_joints = 2;
  expectModelError([&] { makeRobot({armUrdf(), "d", {}}, params); }, "chain 'arm' has 3 joints, ~max_joints is 2");
  expectModelError([&] { makeRobot({"<robot", "d", {}}, {}); }, "");
  params = toCamera();
  params.tip_link = "hand";
  expectModelError([&] { makeRobot({armUrdf(), "d", {}}, params); }, "'hand'");
}

}  // namespace
}  // namespace ros_bridge
}  // namespace screwline
