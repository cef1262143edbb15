// Self-motions of S-R-S arms as circles of the arm angle, where the Jacobian tells least: axes in line, a straight
// elbow, several at once, and beside them.

#include <gtest/gtest.h>

#include <random>

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
  EXPECT_LE(farther, 6);  // Known: a few seeds still end at a member that is only locally the nearest.
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
