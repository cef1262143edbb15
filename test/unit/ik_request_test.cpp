#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ik_arms.h"
#include "screwline/exception.h"
#include "screwline/ik/inverse_kinematics.h"
#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/singularity.h"

namespace screwline {
namespace {

/// A planar arm of three turns (links 0.7, 0.5, 0.2) with the limits given to every joint.
SerialChain planarArm(double lower, double upper) {
  const Vector3 z = Vector3::UnitZ();
  ChainDescription description;
  description.name = "arm";
  description.base_link = "base_link";
  description.tip_link = "tool0";
  const double x[] = {0.0, 0.7, 1.2};
  for (int i = 0; i < 3; ++i) {
    Joint joint;
    joint.name = "joint" + std::to_string(i + 1);
    joint.limits.lower = lower;
    joint.limits.upper = upper;
    description.joints.push_back(joint);
    description.axes.push_back(test::ArmMaker::turn(z, {x[i], 0, 0}));
    description.axes.back().source = i;
  }
  description.home.p = Vector3(1.4, 0, 0);
  description.links = {{"tool0", 3, description.home}};
  return SerialChain(description);
}

const Task kPlane = Task::fromRows({0, 1, 5});

IkRequest requestAt(const SerialChain& chain, const std::vector<double>& q) {
  IkRequest request;
  request.target = forwardKinematics(chain, Eigen::Map<const VectorX>(q.data(), static_cast<Eigen::Index>(q.size())));
  return request;
}

void expectRefused(const InverseKinematics& ik, const IkRequest& request, AnswerCode code, const std::string& part) {
  try {
    ik.solve(request);
    ADD_FAILURE() << "not refused: " << part;
  } catch (const InputError& error) {
    EXPECT_EQ(error.code(), code);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(IkRequest, LimitsExcludeAndAreCounted) {
  const SerialChain chain = planarArm(0.0, 3.0);
  const IkResult result = InverseKinematics(chain, kPlane).solve(requestAt(chain, {0.9, 0.8, 0.3}));
  ASSERT_EQ(result.solutions.size(), 1U);
  EXPECT_EQ(result.outside_limits, 1);
  EXPECT_TRUE(result.complete);
  EXPECT_NE(result.message.find("1 more break joint limits"), std::string::npos) << result.message;
}

TEST(IkRequest, IgnoredLimitsAreStillTold) {
  const SerialChain chain = planarArm(0.0, 3.0);
  IkRequest request = requestAt(chain, {0.9, 0.8, 0.3});
  request.ignore_limits = true;
  const IkResult result = InverseKinematics(chain, kPlane).solve(request);
  ASSERT_EQ(result.solutions.size(), 2U);
  EXPECT_NE(result.solutions[0].within_limits, result.solutions[1].within_limits);
}

TEST(IkRequest, AllOutsideLimitsIsToldApartFromUnreachable) {
  const SerialChain chain = planarArm(-0.1, 0.1);
  IkRequest request = requestAt(planarArm(-4, 4), {0.9, 0.8, 0.3});
  const IkResult outside = InverseKinematics(chain, kPlane).solve(request);
  EXPECT_EQ(outside.status, IkStatus::kOutsideLimits);
  EXPECT_EQ(outside.outside_limits, 2);
  EXPECT_TRUE(outside.closest.within_limits);
  request.target.p = Vector3(9, 0, 0);
  EXPECT_EQ(InverseKinematics(chain, kPlane).solve(request).status, IkStatus::kUnreachable);
}

TEST(IkRequest, UnreachableTellsTheDistanceToTheReach) {
  const SerialChain chain = planarArm(-4, 4);
  IkRequest request;
  request.target.p = Vector3(0.0, 2.0, 0.0);
  const IkResult position_only = InverseKinematics(chain, Task::fromRows({0, 1})).solve(request);
  EXPECT_EQ(position_only.status, IkStatus::kNotFound);  // Redundant: searched, so nothing is proved.
  EXPECT_NEAR(position_only.distance_to_reachable, 0.6, 1e-8);
  const SerialChain two = [] {
    test::ArmMaker maker(1);
    return maker.chain({maker.turn(Vector3::UnitZ(), {0, 0, 0}), maker.turn(Vector3::UnitZ(), {0.7, 0, 0})},
                       {Matrix3::Identity(), {1.2, 0, 0}}, {});
  }();
  const IkResult result = InverseKinematics(two, Task::fromRows({0, 1})).solve(request);
  EXPECT_EQ(result.status, IkStatus::kUnreachable);
  EXPECT_NEAR(result.distance_to_reachable, 0.8, 1e-8);
  request.target.p = Vector3(0.0, 0.05, 0.0);
  EXPECT_NEAR(InverseKinematics(two, Task::fromRows({0, 1})).solve(request).distance_to_reachable, 0.15, 1e-8);
}

TEST(IkRequest, EveryTurnInsideTheLimitsOnRequest) {
  const SerialChain chain = planarArm(-2.0 * kPi, 2.0 * kPi);
  IkRequest request = requestAt(chain, {0.9, 0.8, 0.3});
  request.all_turns = true;
  const IkResult result = InverseKinematics(chain, kPlane).solve(request);
  EXPECT_EQ(result.solutions.size(), 16U);  // Two turns of three joints, on two branches.
  for (const IkAnswer& solution : result.solutions) EXPECT_LE(solution.position.cwiseAbs().maxCoeff(), 2.0 * kPi);
}

TEST(IkRequest, TurnsFollowTheSeedAndElseAreWrapped) {
  const SerialChain chain = planarArm(-10, 10);
  IkRequest request = requestAt(chain, {0.9 + kTwoPi, 0.8, 0.3 - kTwoPi});
  const InverseKinematics ik(chain, kPlane);
  for (const IkAnswer& solution : ik.solve(request).solutions) EXPECT_LE(solution.position.cwiseAbs().maxCoeff(), kPi);
  request.seed = VectorX(3);
  request.seed << 0.9 + kTwoPi, 0.8, 0.3 - kTwoPi;
  EXPECT_LE((ik.solve(request).solutions.front().position - request.seed).norm(), 1e-9);
}

TEST(IkRequest, ValueOnALimitIsWithin) {
  const SerialChain chain = planarArm(-0.5, 0.8);
  const IkResult result = InverseKinematics(chain, kPlane).solve(requestAt(chain, {-0.5, 0.8, 0.8}));
  ASSERT_EQ(result.solutions.size(), 1U);
  EXPECT_LE(result.solutions[0].position.maxCoeff(), 0.8);
  EXPECT_GE(result.solutions[0].position.minCoeff(), -0.5);
}

TEST(IkRequest, BranchesAreNamedAndCanBeAskedFor) {
  const SerialChain chain = planarArm(-4, 4);
  const InverseKinematics ik(chain, kPlane);
  IkRequest request = requestAt(chain, {0.9, 0.8, 0.3});
  for (const char* branch : {"elbow up", "elbow down"}) {
    request.branch = branch;
    const IkResult result = ik.solve(request);
    ASSERT_EQ(result.solutions.size(), 1U);
    EXPECT_EQ(result.solutions[0].branch, branch);
    EXPECT_EQ(result.solutions[0].position[1] < 0.0, request.branch == "elbow up");
  }
  // Straight, the arm is on both branches.
  request = requestAt(chain, {0.9, 0.0, 0.3});
  request.branch = "elbow up";
  const IkResult straight = ik.solve(request);
  ASSERT_EQ(straight.solutions.size(), 1U);
  EXPECT_EQ(straight.solutions[0].branch, "elbow straight");
  EXPECT_TRUE(straight.solutions[0].singular);
}

TEST(IkRequest, MaxSolutionsCutsTheListAndSaysSo) {
  const SerialChain chain = planarArm(-4, 4);
  IkRequest request = requestAt(chain, {0.9, 0.8, 0.3});
  request.max_solutions = 1;
  const IkResult result = InverseKinematics(chain, kPlane).solve(request);
  EXPECT_EQ(result.solutions.size(), 1U);
  EXPECT_FALSE(result.complete);
  EXPECT_NE(result.message.find("1 left out by max_solutions"), std::string::npos) << result.message;
}

TEST(IkRequest, AContinuumTellsItsRangeWithinLimits) {
  // Wrist aligned: theta4 + theta6 is fixed at 0.4, each within [-1, 1].
  const Vector3 z = Vector3::UnitZ();
  SerialChain wrist = [&] {
    ChainDescription description;
    description.name = "wrist";
    description.base_link = "base_link";
    description.tip_link = "tool0";
    const Vector3 directions[] = {z, Vector3::UnitY(), z};
    for (int i = 0; i < 3; ++i) {
      Joint joint;
      joint.name = "joint" + std::to_string(i + 1);
      joint.limits.lower = -1.0;
      joint.limits.upper = 1.0;
      description.joints.push_back(joint);
      description.axes.push_back(test::ArmMaker::turn(directions[i], {0, 0, 0}));
      description.axes.back().source = i;
    }
    description.links = {{"tool0", 3, Pose()}};
    return SerialChain(description);
  }();
  IkRequest request = requestAt(wrist, {0.3, 0.0, 0.1});
  request.seed = VectorX::Zero(3);
  const IkResult result = InverseKinematics(wrist, Task::fromRows({3, 4, 5})).solve(request);
  ASSERT_EQ(result.solutions.size(), 1U);
  const IkAnswer& solution = result.solutions[0];
  EXPECT_EQ(solution.branch, "wrist aligned");
  EXPECT_NEAR(solution.position[0], 0.2, 1e-9);  // The member nearest to the seed.
  EXPECT_NEAR(solution.position[2], 0.2, 1e-9);
  ASSERT_EQ(solution.free_joints, (std::vector<int>{0, 2}));
  EXPECT_NEAR(solution.self_motion_lower[0], -0.6, 1e-12);
  EXPECT_NEAR(solution.self_motion_upper[0], 1.0, 1e-12);
  EXPECT_NEAR(std::abs(solution.self_motion(0, 0) + solution.self_motion(0, 2)), 0.0, 1e-9);
}

TEST(IkRequest, BadInputIsRefusedByName) {
  const SerialChain chain = planarArm(-4, 4);
  const InverseKinematics ik(chain, kPlane);
  const IkRequest good = requestAt(chain, {0.9, 0.8, 0.3});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  IkRequest bad = good;
  bad.seed = VectorX::Zero(2);
  expectRefused(ik, bad, AnswerCode::kInvalidRobotState, "seed.position has 2 values, chain 'arm' has 3 joints");
  bad.seed = VectorX::Constant(3, nan);
  expectRefused(ik, bad, AnswerCode::kInvalidRobotState, "joint1");
  bad = good;
  bad.target.p.y() = nan;
  expectRefused(ik, bad, AnswerCode::kInvalidGoal, "pose.position.y");
  bad = good;
  bad.target.p.x() = 2e6;
  expectRefused(ik, bad, AnswerCode::kInvalidGoal, "pose.position.x");
  bad = good;
  bad.target.R = bad.target.R * rotationAbout(Vector3::UnitX(), 2e-6);
  expectRefused(ik, bad, AnswerCode::kInvalidGoal, "turned off the base's z axis by 2e-06");
  bad = good;
  bad.branch = "elbow sideways";
  expectRefused(ik, bad, AnswerCode::kInvalidGoal, "known are elbow up, elbow down");
  bad = good;
  bad.max_solutions = -1;
  expectRefused(ik, bad, AnswerCode::kInvalidGoal, "max_solutions is -1");
  bad = good;
  bad.redundancy = {0.5};
  expectRefused(ik, bad, AnswerCode::kInvalidGoal, "redundancy has 1 values");
  bad = good;
  bad.timeout = -1.0;
  expectRefused(ik, bad, AnswerCode::kInvalidGoal, "timeout");
}

SerialChain generalArm(int joints) {
  test::ArmMaker maker(3);
  std::vector<Axis> axes;
  for (int i = 0; i < joints; ++i) axes.push_back(maker.turn(maker.direction(), maker.vector(0.5)));
  return maker.chain(axes, maker.pose(), maker.pose());
}

TEST(IkRequest, SixJointsInGeneralAreSolvedCompletely) {
  const SerialChain chain = generalArm(6);
  const InverseKinematics ik(chain, Task());
  EXPECT_TRUE(ik.complete());
  IkRequest request = requestAt(chain, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
  request.seed = VectorX::LinSpaced(6, 0.1, 0.6);
  const IkResult result = ik.solve(request);
  EXPECT_TRUE(result.complete) << result.message;
  ASSERT_FALSE(result.solutions.empty());
  EXPECT_LE(result.solutions.front().distance, 1e-9);
  request.target.p.array() += 100.0;
  EXPECT_EQ(ik.solve(request).status, IkStatus::kUnreachable);
}

TEST(IkRequest, ChainsWithoutAnExactMethodSaySo) {
  const SerialChain chain = generalArm(8);
  const InverseKinematics ik(chain, Task());
  EXPECT_FALSE(ik.complete());
  IkRequest request = requestAt(chain, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8});
  request.seed = VectorX::Constant(8, 0.3);
  const IkResult result = ik.solve(request);
  EXPECT_EQ(result.status, IkStatus::kSolved);
  EXPECT_FALSE(result.complete);
  EXPECT_NE(result.message.find("may be incomplete"), std::string::npos);
}

TEST(IkRequest, SevenJointsAreSolvedByCurvesOrAtOneValue) {
  test::ArmMaker maker(5);
  std::vector<Axis> axes;
  for (int i = 0; i < 4; ++i) axes.push_back(maker.turn(maker.direction(), maker.vector(0.5)));
  const Vector3 center(0.4, 0.3, 0.9);
  for (int i = 0; i < 3; ++i) axes.push_back(maker.turn(maker.direction(), center));
  const SerialChain chain = maker.chain(axes, maker.pose(), maker.pose());
  const InverseKinematics ik(chain, Task());
  EXPECT_TRUE(ik.complete());
  IkRequest request = requestAt(chain, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7});
  const VectorX q = VectorX::LinSpaced(7, 0.1, 0.7);
  request.seed = q;
  const IkResult curves = ik.solve(request);
  ASSERT_FALSE(curves.solutions.empty()) << curves.message;
  EXPECT_LE(curves.solutions.front().distance, 1e-9);
  EXPECT_EQ(curves.solutions.front().self_motion.rows(), 1);
  request.redundancy = {q[0]};
  const IkResult points = ik.solve(request);
  ASSERT_FALSE(points.solutions.empty()) << points.message;
  EXPECT_LE(points.solutions.front().distance, 1e-9);
  EXPECT_TRUE(points.complete);
  // The joint that is given takes no part of an error.
  for (const IkAnswer& answer : points.solutions) {
    Matrix6X J;
    geometricJacobian(chain, answer.position, J);
    const double smallest = singularValues(J.rightCols(6))[5];
    const double residual = std::hypot(answer.position_error, answer.orientation_error);
    EXPECT_GE(answer.joint_error * smallest, 0.999 * residual);
    EXPECT_LE(answer.joint_error * smallest, residual + 1e-15 * (1.0 + chain.characteristicLength()));
  }
  request.redundancy = {0.1, 0.2};
  EXPECT_THROW(ik.solve(request), InputError);
}

}  // namespace
}  // namespace screwline
