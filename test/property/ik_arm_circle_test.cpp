// Self-motions of S-R-S arms as circles of the arm angle, where the Jacobian tells least: axes in line, a straight
// elbow, several at once, and beside them.

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "ik_gate.h"
#include "redundant_arms.h"
#include "screwline/ik/redundant/self_motion_solver.h"
#include "shipped_robots.h"
#include "singular_poses.h"
#include "singular_search.h"

namespace screwline {
namespace {

using test::GateVerdict;
using test::IkGate;

TEST(ArmCircleLaw, EverySingularPoseIsAnsweredCompletely) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "iiwa14");
  const InverseKinematics ik(robot.chain, robot.task);
  const unsigned seed = test::wished("SCREWLINE_SEED", 20261128);
  test::SingularPoses maker(robot.chain, seed);
  const unsigned poses = test::wished("SCREWLINE_POSES", 1);
  for (const test::SingularKind& kind : test::singularKindsOf(robot.chain, robot.task)) {
    for (double offset : test::singularOffsets()) {
      for (unsigned k = 0; k < poses; ++k) {
        const std::optional<VectorX> q = maker.make(kind, offset);
        if (!q) continue;
        const GateVerdict verdict = IkGate(ik, *q, true).judge(VectorX::LinSpaced(7, 8e-4, -5e-4));
        EXPECT_TRUE(verdict.isLawful() && verdict.complete && !verdict.lost)
            << "seed " << seed << ", " << kind.name << " + " << offset << ": " << verdict.message
            << "\n  q = " << q->transpose();
      }
    }
  }
}

/// All axes upright: the arm straight up, whatever its first, third and fifth joint do.
TEST(ArmCircleLaw, ContinuaHaveTheirDimension) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "iiwa14");
  const InverseKinematics ik(robot.chain, robot.task);
  struct Case {
    std::vector<int> bent;  ///< Joints of 2, 4, 6 that are not zero.
    int dimension;
  };
  for (const Case& one : {Case{{}, 3}, Case{{2}, 2}, Case{{6}, 2}, Case{{2, 6}, 1}, Case{{2, 4, 6}, 1}}) {
    VectorX q = VectorX::Zero(7);
    for (int joint : one.bent) q[joint - 1] = 0.5 + 0.1 * joint;
    IkRequest request;
    request.target = forwardKinematics(robot.chain, q);
    request.seed = q;
    const IkResult result = ik.solve(request);
    ASSERT_EQ(result.status, IkStatus::kSolved) << result.message;
    EXPECT_TRUE(result.complete) << result.message;
    EXPECT_LE((result.solutions.front().position - q).norm(), 1e-9);
    EXPECT_EQ(result.solutions.front().self_motion.rows(), one.dimension) << q.transpose();
  }
}

/// Joints that are zero but for 1e-13 ... 3e-8: what rounding leaves a straight elbow bent makes surfaces of curves.
/// The search finds solutions anywhere on them.
TEST(ArmCircleLaw, SurfacesBesideAStraightElbowAreTold) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "iiwa14");
  const InverseKinematics ik(robot.chain, robot.task);
  const unsigned seed = test::wished("SCREWLINE_SEED", 20261128);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> angle(-kPi, kPi);
  std::uniform_real_distribution<double> share(0.1, 1.0);
  const VectorX push = VectorX::LinSpaced(7, -1e-3, 7e-4);
  const std::vector<std::vector<int>> joints = {{2, 4}, {4, 6}, {2, 4, 6}};
  for (const std::vector<int>& small : joints) {
    for (double offset : {1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 3e-8}) {
      VectorX q = VectorX::NullaryExpr(7, [&] { return angle(random); });
      for (int joint : small) q[joint - 1] = offset * share(random);
      IkRequest request = IkGate(ik, q, true).request();
      request.seed = q + push;
      const IkResult result = ik.solve(request);
      ASSERT_FALSE(result.solutions.empty());
      EXPECT_GE(result.solutions.front().self_motion.rows(), 2) << "seed " << seed << ", q = " << q.transpose();
      if (small.size() > 2) continue;  // Surfaces that cross are not all told, and that is said.
      EXPECT_TRUE(result.complete) << result.message;
      EXPECT_LE(result.solutions.front().distance, push.norm()) << "seed " << seed << ", q = " << q.transpose();
      EXPECT_EQ(test::missedSolutions(ik, q, 8), 0) << "seed " << seed << ", q = " << q.transpose();
    }
  }
}

/// Any two turns of the group that is almost in line have a member, to 1e-12.
TEST(ArmCircleLaw, MembersOfSurfacesAreExact) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "iiwa14");
  const std::optional<SelfMotionSolver> solver = SelfMotionSolver::compile(robot.chain);
  ASSERT_TRUE(solver);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(-kPi, kPi);
  for (int almost : {2, 6}) {
    for (double offset : {1e-12, 1e-10, 1e-8}) {
      Vector7 q = Vector7::NullaryExpr([&] { return angle(random); });
      q[3] = offset;
      q[almost - 1] = -0.7 * offset;
      SelfMotionQuestion question;
      question.target = forwardKinematics(robot.chain, q);
      const SelfMotionSet set = solver->trace(question);
      EXPECT_TRUE(set.complete);
      EXPECT_TRUE(set.curves.empty());
      ASSERT_EQ(set.sheets.size(), 2U);
      for (const SelfMotionSheet& sheet : set.sheets) {
        ASSERT_EQ(sheet.free, (almost == 2 ? std::vector<int>{0, 2} : std::vector<int>{4, 6}));
        for (int k = 0; k < 50; ++k) {
          const VectorX wished = VectorX::NullaryExpr(7, [&] { return angle(random); });
          // Where the two axes between are in line too, the elbow would have to bend too far.
          const double sine = std::abs(std::sin(wished[almost == 2 ? 2 : 4]));
          VectorX member;
          if (!sheet.member_at(wished, member)) {
            EXPECT_LT(sine, 4e6 * offset);
            continue;
          }
          for (int joint : sheet.free) member[joint] = wished[joint];
          EXPECT_LE(taskError(Task(), question.target, forwardKinematics(robot.chain, member)).norm(), 2e-12);
        }
      }
    }
  }
}

/// Of a plane on which a sum of three angles is given, in whatever turns the seed has them.
TEST(ArmCircleLaw, MembersOfAPlaneAreNearestToTheSeed) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "iiwa14");
  const InverseKinematics ik(robot.chain, robot.task);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle(-kPi, kPi);
  const VectorX push = VectorX::LinSpaced(7, -1e-3, 7e-4);
  int farther = 0;
  for (int k = 0; k < 40; ++k) {
    VectorX q(7);
    for (int i = 0; i < 7; ++i) q[i] = i == 1 || i == 3 ? 0.0 : angle(random);
    IkRequest request;
    request.target = forwardKinematics(robot.chain, q);
    request.ignore_limits = true;
    const double sum = q[0] + q[2] + q[4];
    q[0] = angle(random);
    q[2] = k % 2 == 0 ? -kPi : angle(random);
    q[4] = std::remainder(sum - q[0] - q[2], kTwoPi);
    ASSERT_LE(taskError(Task(), request.target, forwardKinematics(robot.chain, q)).norm(), 1e-9);
    request.seed = q + push;
    const IkResult result = ik.solve(request);
    ASSERT_FALSE(result.solutions.empty());
    farther += result.solutions.front().distance > 1.001 * push.norm() ? 1 : 0;
  }
  EXPECT_EQ(farther, 0);
}

/// The same curves as along the null space: tangents annihilate the Jacobian, nodes meet the pose.
TEST(ArmCircleLaw, NodesAndTangentsAreExact) {
  test::RedundantArmMaker maker(7);
  for (int trial = 0; trial < 20; ++trial) {
    const SerialChain chain = maker.makeArm(2, false);
    const std::optional<SelfMotionSolver> solver = SelfMotionSolver::compile(chain);
    ASSERT_TRUE(solver);
    EXPECT_NE(solver->method().find("arm angle"), std::string::npos);
    SelfMotionQuestion question;
    question.target = forwardKinematics(chain, test::randomWithin(maker, chain));
    question.ignore_limits = true;
    const SelfMotionSet set = solver->trace(question);
    EXPECT_EQ(set.curves.size(), 8U);
    Matrix6X J;
    for (const SelfMotionCurve& curve : set.curves) {
      EXPECT_TRUE(curve.closed);
      for (const SelfMotionNode& node : curve.nodes) {
        const Pose tip = geometricJacobian(chain, node.q, J);
        EXPECT_LE(taskError(Task(), question.target, tip).norm(), 1e-12);
        EXPECT_LE((J * node.tangent).norm(), 1e-11);
      }
    }
  }
}

}  // namespace
}  // namespace screwline
