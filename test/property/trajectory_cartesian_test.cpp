#include <gtest/gtest.h>

#include "property/cartesian_support.h"
#include "screwline/trajectory/branch_following.h"

namespace screwline {
namespace trajectory_test {
namespace {

constexpr int kSamples = 2000;

double worstOffLine(const Arm& arm, const Pose& A, const Pose& B, const JointTrajectory& trajectory) {
  TrajectoryPoint point(arm.chain.size());
  double worst = 0.0;
  for (int k = 0; k <= kSamples; ++k) {
    trajectory.sample(trajectory.duration() * k / kSamples, point);
    worst = std::max(worst, offLine(arm.task, A, B, forwardKinematics(arm.chain, point.position)));
  }
  return worst;
}

class CartesianLine : public testing::TestWithParam<const char*> {};

TEST_P(CartesianLine, RandomLinesKeepTheirWordOrSayWhy) {
  const unsigned seed = 11;
  SCOPED_TRACE(std::string(GetParam()) + ", seed " + std::to_string(seed));
  Random random(seed);
  const Arm arm(GetParam());
  const int count = arm.chain.size() > 6 ? 6 : 25;
  int planned = 0;
  for (int k = 0; k < count; ++k) {
    const VectorX q = arm.random(random);
    const VectorX there = arm.chain.clamped(q + random.vector(arm.chain.size(), -0.5, 0.5));
    const Pose A = forwardKinematics(arm.chain, q);
    const Pose B = forwardKinematics(arm.chain, there);
    try {
      const PlanResult result = plan(arm.request("cartesian_line", {A, B}, q));
      ++planned;
      EXPECT_LT(worstOffLine(arm, A, B, result.trajectory), 2e-6) << joined(result.notes);
      EXPECT_LE(largestUse(result.trajectory, arm.limits(), kSamples), 1.0 + 1e-6);
      EXPECT_GT(largestUse(result.trajectory, arm.limits(), kSamples), 0.9);
    } catch (const InputError& error) {
      EXPECT_EQ(error.code(), AnswerCode::kPathNotContinuous) << error.what();
      EXPECT_NE(std::string(error.what()).find(" %)"), std::string::npos) << error.what();
    }
  }
  EXPECT_GE(planned, count / 2);
}

/// Along a followed branch the solver, asked anew, finds the followed joint values, and calls them by the same name.
TEST_P(CartesianLine, BranchesAreThoseOfInverseKinematicsAllAlong) {
  const unsigned seed = 12;
  SCOPED_TRACE(std::string(GetParam()) + ", seed " + std::to_string(seed));
  Random random(seed);
  const Arm arm(GetParam());
  if (arm.chain.size() > 6) GTEST_SKIP() << "a redundant chain's solver answers with the nearest of a continuum";
  for (int k = 0; k < 8; ++k) {
    const VectorX q = arm.random(random);
    const Pose A = forwardKinematics(arm.chain, q);
    const Pose B = forwardKinematics(arm.chain, arm.chain.clamped(q + random.vector(arm.chain.size(), -0.5, 0.5)));
    ToolPathOptions options;
    options.length_scale = arm.chain.characteristicLength();
    const ToolPath path = linesThrough({A, B}, options).path;
    FollowRequest question;
    question.seed = q;
    const FollowResult result = followPath(arm.kinematics, path, question);
    ASSERT_FALSE(result.branches.empty());
    for (const FollowedBranch& branch : result.branches) {
      for (std::size_t piece = 0; piece < branch.curve.segments(); piece += 5) {
        VectorX at(arm.chain.size());
        for (int i = 0; i < at.size(); ++i) at[i] = branch.curve.piece(piece, i)(0.0);
        IkRequest ask;
        ask.target = path.pose(branch.curve.piece(piece, arm.chain.size())(0.0));
        ask.seed = at;
        ask.ignore_limits = true;
        const IkResult answer = arm.kinematics.solve(ask);
        ASSERT_FALSE(answer.solutions.empty());
        EXPECT_LT((answer.solutions.front().position - at).cwiseAbs().maxCoeff(), 1e-6);
        if (answer.solutions.front().singular) continue;
        EXPECT_EQ(answer.solutions.front().branch, branch.branch);
      }
    }
  }
}

TEST_P(CartesianLine, BackwardsIsTheSameWay) {
  const unsigned seed = 13;
  Random random(seed);
  const Arm arm(GetParam());
  if (arm.chain.size() > 6) GTEST_SKIP() << "the shortest joint motion depends on where it came from";
  for (int k = 0; k < 6; ++k) {
    const VectorX q = arm.random(random);
    const Pose A = forwardKinematics(arm.chain, q);
    const Pose B = forwardKinematics(arm.chain, arm.chain.clamped(q + random.vector(arm.chain.size(), -0.3, 0.3)));
    PlanRequest forth = arm.request("cartesian_line", {A, B}, q);
    if (errorOf(forth) != AnswerCode::kSuccess) continue;
    const PlanResult there = plan(forth);
    const PlanResult back = plan(arm.request("cartesian_line", {B, A}, there.waypoints.back()));
    EXPECT_LT((back.waypoints.back() - there.waypoints.front()).cwiseAbs().maxCoeff(), 1e-6) << "seed " << seed;
    EXPECT_NEAR(back.trajectory.duration(), there.trajectory.duration(), 0.02 * there.trajectory.duration());
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, CartesianLine,
                         testing::Values("puma560", "ur5", "rrr_planar", "scara", "youbot_arm", "panda"));

TEST(CartesianChecker, SeesAJointPathThatIsOffTheLine) {
  const Arm arm("puma560");
  const VectorX q = vector({0.3, -0.7, 0.6, 0.4, 0.5, -0.9});
  const VectorX there = vector({0.6, -0.5, 0.4, 0.4, 0.8, -0.7});
  const Pose A = forwardKinematics(arm.chain, q);
  const Pose B = forwardKinematics(arm.chain, there);
  const JointTrajectory joints = plan(request("polynomial_345", {q, there}, arm.limits())).trajectory;
  EXPECT_GT(worstOffLine(arm, A, B, joints), 1e-3);
  EXPECT_GT(largestUse(JointTrajectory::scaled(q, there - q, TimeLaw::cubic(), 0.05), arm.limits(), 100), 1.5);
}

}  // namespace
}  // namespace trajectory_test
}  // namespace screwline
