#include "screwline/ros/conversions.h"

#include <cmath>
#include <limits>
#include <random>

#include "screwline/kinematics/forward.h"
#include "screwline/ros/checks.h"
#include "screwline/ros/frame_resolver.h"
#include "screwline/ros/joint_values.h"
#include "screwline/spatial/rotation.h"
#include "unit/ros_arm.h"

namespace screwline {
namespace ros_bridge {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

sensor_msgs::JointState jointState(const std::vector<std::string>& names, const std::vector<double>& position) {
  sensor_msgs::JointState state;
  state.name = names;
  state.position = position;
  return state;
}

TEST(Conversions, PosesComeBack) {
  std::mt19937 random(20260101);
  std::uniform_real_distribution<double> number(-3.0, 3.0);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 axis = Vector3(number(random), number(random), number(random)).normalized();
    const Pose pose{rotationAbout(axis, i % 10 == 0 ? kPi : number(random)),
                    Vector3(number(random), number(random), number(random))};
    const geometry_msgs::Pose message = toPose(pose);
    EXPECT_GE(message.orientation.w, 0.0);
    EXPECT_TRUE(isApprox(fromPose(message, "pose"), pose, 1e-14)) << i;
  }
}

TEST(Conversions, QuaternionsOffUnitLength) {
  geometry_msgs::Quaternion quaternion;
  quaternion.w = 1.0009;
  EXPECT_TRUE(fromQuaternion(quaternion, "q").isApprox(Matrix3::Identity(), 1e-15));
  quaternion.w = -0.9991;
  EXPECT_TRUE(fromQuaternion(quaternion, "q").isApprox(Matrix3::Identity(), 1e-15));
  for (const double bad : {1.0011, 0.9989, 0.0}) {
    quaternion.w = bad;
    expectRefused([&] { fromQuaternion(quaternion, "q"); }, AnswerCode::kInvalidGoal, "q has norm " + numberText(bad));
  }
  for (const double bad : {kNan, kInf, -2e6}) {
    quaternion.y = bad;
    expectRefused([&] { fromQuaternion(quaternion, "q"); }, AnswerCode::kInvalidGoal, "q.y is ");
  }
}

TEST(Conversions, NumbersBeyondTheBound) {
  geometry_msgs::Point point;
  point.x = 1e6;
  EXPECT_EQ(fromPoint(point, "p"), Vector3(1e6, 0.0, 0.0));
  for (const double bad : {kNan, kInf, -kInf, 1.0000001e6, -1e300}) {
    point.z = bad;
    expectRefused([&] { fromPoint(point, "p"); }, AnswerCode::kInvalidGoal, "p.z is " + numberText(bad));
    EXPECT_EQ(fromPoint(point, "p", {true, true, false}), Vector3(1e6, 0.0, 0.0));
  }
}

TEST(Conversions, WhatATaskReads) {
  const Task task = Task::parse({"y", "rz"});
  EXPECT_EQ(readMask(task, 0, true), (ReadMask{false, true, false}));
  EXPECT_EQ(readMask(task, 0, false), kReadAll);
  EXPECT_EQ(readMask(task, 3, true), (ReadMask{false, false, true}));
  EXPECT_EQ(readMask(Task::parse({"rz"}), 0, false), (ReadMask{false, false, false}));
}

TEST(Conversions, ArraysAndTwists) {
  MatrixX matrix(2, 3);
  matrix << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ(rowMajor(matrix), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(rowMajor(MatrixX(0, 4)), std::vector<double>());
  EXPECT_EQ(arrayOf(VectorX()), std::vector<double>());
  Vector6 twist;
  twist << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ(toTwist(twist).linear.z, 3.0);
  EXPECT_EQ(toTwist(twist).angular.x, 4.0);
  EXPECT_EQ(toWrench(twist).force.y, 2.0);
  EXPECT_EQ(toWrench(twist).torque.z, 6.0);
}

TEST(Conversions, NamesInMessages) {
  EXPECT_EQ(quoted("a\nb"), "'a?b'");
  EXPECT_EQ(quoted(std::string(80, 'x')), "'" + std::string(80, 'x') + "'");
  EXPECT_EQ(quoted(std::string(81, 'x')), "'" + std::string(80, 'x') + "...'");
  EXPECT_EQ(quoted(std::string(79, 'x') + "\xc3\xa9" + "y"), "'" + std::string(79, 'x') + "...'");
}

TEST(JointValues, NamesInAnyOrder) {
  const auto chain = arm();
  EXPECT_EQ(jointPositions(*chain, jointState({}, {1, 2, 3})), Vector3(1, 2, 3));
  EXPECT_EQ(jointPositions(*chain, jointState({"c", "a", "b"}, {3, 1, 2})), Vector3(1, 2, 3));
}

TEST(JointValues, WhatIsRefused) {
  const auto chain = arm();
  const auto refused = [&](const std::vector<std::string>& names, const std::vector<double>& values,
                           const std::string& words) {
    expectRefused([&] { jointPositions(*chain, jointState(names, values)); }, AnswerCode::kInvalidRobotState, words);
  };
  refused({}, {1, 2}, "joint_state.position has 2 values, chain 'arm' has 3 joints");
  refused({}, {1}, "joint_state.position has 1 value, chain");
  refused({}, {}, "joint_state.position has 0 values");
  refused({"a", "b", "c"}, {1, 2}, "joint_state.position has 2 values, joint_state.name has 3 names");
  refused({"a", "b"}, {1, 2}, "joint_state.name lacks joint 'c' of chain 'arm'");
  refused({"a", "x", "c"}, {1, 2, 3}, "joint_state.name[1] is 'x', chain 'arm' has no such joint");
  refused({"a", "b", "a"}, {1, 2, 3}, "joint_state.name[2] is 'a', as joint_state.name[0] is already");
  refused({"c", "b", "a"}, {kNan, 2, 3}, "joint_state.position[0] is nan");
  refused({}, {1, 2, 1e7}, "joint_state.position[2] is 10000000");
}

TEST(FrameResolver, LinksAndOtherFrames) {
  const auto chain = arm();
  const Pose lab{rotationAbout(Vector3::UnitZ(), 0.5), Vector3(1, 2, 3)};
  const FrameResolver frames(
      chain, [&](const std::string& frame) { return frame == "lab" ? std::optional<Pose>(lab) : std::nullopt; });
  const Vector3 q(0.1, 0.2, 0.3);
  EXPECT_TRUE(isApprox(frames.atConfiguration("", q, "f"), Pose(), 0.0));
  EXPECT_TRUE(isApprox(frames.atConfiguration("l3", q, "f"), forwardKinematics(*chain, q), 1e-15));
  EXPECT_TRUE(isApprox(frames.atConfiguration("lab", q, "f"), lab, 0.0));
  EXPECT_TRUE(isApprox(frames.withoutConfiguration("base", "f"), Pose(), 0.0));
  EXPECT_TRUE(isApprox(frames.withoutConfiguration("table", "f"), {Matrix3::Identity(), Vector3(0, 0, 1)}, 0.0));
  EXPECT_EQ(frames.nameOf(""), "base");
  expectRefused([&] { frames.atConfiguration("nowhere", q, "frame_id"); }, AnswerCode::kFrameTransformFailure,
                "frame_id 'nowhere' is neither a link of chain 'arm' nor known to tf2");
  expectRefused([&] { frames.withoutConfiguration("l2", "frame_id"); }, AnswerCode::kFrameTransformFailure,
                "frame_id 'l2' moves with the chain");
}

TEST(FrameResolver, WithoutTf) {
  const FrameResolver frames(arm(), nullptr);
  expectRefused([&] { frames.withoutConfiguration("lab", "f"); }, AnswerCode::kFrameTransformFailure, "'lab'");
}

}  // namespace
}  // namespace ros_bridge
}  // namespace screwline
