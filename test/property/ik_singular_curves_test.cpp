// Self-motions of seven-joint arms without an arm angle, where the Jacobian tells least: two kinds of singularity at
// once, and beside them, where curves cross, come near to each other, or are smaller than the arm's rounding.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ik_gate.h"
#include "redundant_arms.h"
#include "screwline/ik/redundant/self_motion_solver.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/spatial/screw.h"
#include "shipped_robots.h"
#include "singular_poses.h"
#include "singular_search.h"

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261128;
constexpr std::size_t kMostNodes = 15000;  // Of a curve: a bound of its time.

struct Arm {
  explicit Arm(const char* name)
      : robot(test::shippedRobot(SCREWLINE_SOURCE_DIR, name)),
        ik(robot.chain, robot.task),
        solver(SelfMotionSolver::compile(robot.chain).value()) {}

  SelfMotionSet traced(const VectorX& q) const {
    SelfMotionQuestion question;
    question.target = forwardKinematics(robot.chain, q);
    question.ignore_limits = true;
    return solver.trace(question);
  }

  test::ShippedRobot robot;
  InverseKinematics ik;
  SelfMotionSolver solver;
};

class SingularCurves : public testing::TestWithParam<const char*> {};

TEST_P(SingularCurves, NothingIsLostAndCurvesComeRound) {
  const Arm arm(GetParam());
  const unsigned seed = test::wished("SCREWLINE_SEED", kSeed);
  const unsigned poses = test::wished("SCREWLINE_POSES", 1);
  test::SingularPoses maker(arm.robot.chain, seed);
  int asked = 0;
  int open = 0;
  int incomplete = 0;
  std::size_t turn = 0;
  for (const test::SingularKind& kind : test::singularKindsOf(arm.robot.chain, arm.robot.task)) {
    for (std::size_t i = turn++ % 2; i < test::singularOffsets().size(); i += 2) {
      const double offset = test::singularOffsets()[i];
      for (unsigned k = 0; k < poses; ++k) {
        const std::optional<VectorX> q = maker.make(kind, offset);
        if (!q) continue;
        const auto where = [&] {
          std::ostringstream text;
          text.precision(17);
          text << GetParam() << ", seed " << seed << ", " << kind.name << " + " << offset << ": q = " << q->transpose();
          return text.str();
        };
        const Pose target = forwardKinematics(arm.robot.chain, *q);
        const SelfMotionSet set = arm.traced(*q);
        for (const SelfMotionCurve& curve : set.curves) {
          open += curve.closed ? 0 : 1;
          EXPECT_LE(curve.nodes.size(), kMostNodes) << where();
          for (const SelfMotionNode& node : curve.nodes)
            ASSERT_LE(poseDifference(target, forwardKinematics(arm.robot.chain, node.q)).norm(), 1e-9) << where();
        }
        const test::IkGate gate(arm.ik, *q, true);
        const IkResult result = arm.ik.solve(gate.request());
        EXPECT_TRUE(gate.isKnown(*q, result, test::placeTolerance(arm.robot.chain, arm.ik.task(), *q))) << where();
        incomplete += result.complete ? 0 : 1;
        ++asked;
      }
    }
  }
  std::printf("%-10s %4d poses, curves that do not come round %d, lists not complete %d\n", GetParam(), asked, open,
              incomplete);
  EXPECT_LE(incomplete, asked / 100);
}

INSTANTIATE_TEST_SUITE_P(Robots, SingularCurves, testing::Values("panda", "gen3_7dof"));

/// Also where the wrist turns at one value of a rail alone, near the end of its reach.
TEST(SingularCurvesOfRandomArms, NothingIsLost) {
  const unsigned seed = test::wished("SCREWLINE_SEED", kSeed);
  for (int kind : {0, 1, 3, test::RedundantArmMaker::kParallelOnRail}) {
    test::RedundantArmMaker maker(seed);
    for (int k = 0; k < 4; ++k) {
      const SerialChain chain = maker.makeArm(kind, false);
      const InverseKinematics ik(chain, Task());
      test::SingularPoses poses(chain, seed + static_cast<unsigned>(k));
      for (const test::SingularKind& one : test::singularKindsOf(chain, Task())) {
        for (double offset : {0.0, 1e-12, 1e-9, 1e-6, 1e-3}) {
          const std::optional<VectorX> q = poses.make(one, offset);
          if (!q) continue;
          const test::IkGate gate(ik, *q, true);
          const IkResult result = ik.solve(gate.request());
          EXPECT_TRUE(gate.isKnown(*q, result, test::placeTolerance(chain, Task(), *q)))
              << "seed " << seed << ", arm " << kind << "/" << k << ", " << one.name << " + " << offset << ": "
              << result.message << "\n  q = " << q->transpose();
        }
      }
    }
  }
}

/// 1e-4 rad long, 1e-6 wide, about a configuration that would be the only one. Newton's method from anywhere beside it
/// ends on it.
TEST(SmallLoops, HoldWhatNewtonsMethodFindsBesideThem) {
  const Arm arm("gen3_7dof");
  const auto kinds = test::singularKindsOf(arm.robot.chain, arm.robot.task);
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [](const test::SingularKind& one) {
    return one.name == "axes 2, 4 parallel + axes 3, 5 parallel";
  });
  ASSERT_NE(kind, kinds.end());
  test::SingularPoses maker(arm.robot.chain, kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int loops = 0;
  for (int k = 0; k < 12; ++k) {
    const std::optional<VectorX> q = maker.make(*kind, 1e-6);
    if (!q) continue;
    const SelfMotionSet set = arm.traced(*q);
    const bool small = !set.curves.empty() && std::all_of(set.curves.begin(), set.curves.end(), [](const auto& curve) {
      return curve.nodes.back().arc < 0.01;
    });
    if (!small) continue;  // The other side of the singularity: curves of the usual size.
    ++loops;
    EXPECT_TRUE(set.complete) << set.note;
    const Pose target = forwardKinematics(arm.robot.chain, *q);
    for (int i = 0; i < 20; ++i) {
      VectorX found = *q;
      for (int joint = 0; joint < found.size(); ++joint) found[joint] += 3e-5 * uniform(random);
      polish(arm.robot.chain, Task(), target, found);
      if (poseDifference(target, forwardKinematics(arm.robot.chain, found)).norm() > 1e-15) continue;
      double nearest = 1.0;
      for (const SelfMotionCurve& curve : set.curves) {
        for (std::size_t n = 0; n + 1 < curve.nodes.size(); ++n) {
          const Vector7 chord = curve.nodes[n + 1].q - curve.nodes[n].q;
          Vector7 from = found - curve.nodes[n].q;
          for (int joint = 0; joint < kRedundantJoints; ++joint) from[joint] = std::remainder(from[joint], kTwoPi);
          const double share = std::clamp(from.dot(chord) / chord.squaredNorm(), 0.0, 1.0);
          nearest = std::min(nearest, (from - share * chord).norm());
        }
      }
      EXPECT_LE(nearest, 2e-6) << "k " << k << ", i " << i;
    }
  }
  EXPECT_GE(loops, 4);
}

/// Two conditions met to 1e-12: the pose leaves open two joints' values, to 1e-10. Of any, the others follow.
TEST(Surfaces, HoldMembersForAnyTwoTurns) {
  const Arm arm("panda");
  const auto kinds = test::singularKindsOf(arm.robot.chain, arm.robot.task);
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [](const test::SingularKind& one) {
    return one.name == "shoulder aligned + axes 3, 5 parallel";
  });
  ASSERT_NE(kind, kinds.end());
  test::SingularPoses maker(arm.robot.chain, kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> angle(-kPi, kPi);
  for (double offset : {1e-12, 1e-12, 1e-11}) {
    const std::optional<VectorX> q = maker.make(*kind, offset);
    ASSERT_TRUE(q);
    const Pose target = forwardKinematics(arm.robot.chain, *q);
    const SelfMotionSet set = arm.traced(*q);
    EXPECT_TRUE(set.complete) << set.note;
    const auto surface = std::find_if(set.sheets.begin(), set.sheets.end(), [](const SelfMotionSheet& sheet) {
      return sheet.free.size() == 2 && !sheet.parameter_moves;
    });
    ASSERT_NE(surface, set.sheets.end());
    for (int k = 0; k < 30; ++k) {
      const VectorX wished = VectorX::NullaryExpr(7, [&] { return angle(random); });
      VectorX member;
      ASSERT_TRUE(surface->member_at(wished, member));
      for (int joint : surface->free) EXPECT_NEAR(member[joint], wished[joint], 1e-12);
      EXPECT_LE(poseDifference(target, forwardKinematics(arm.robot.chain, member)).norm(), 2e-10);
    }
    const IkResult result = arm.ik.solve(test::IkGate(arm.ik, *q, true).request());
    EXPECT_TRUE(std::any_of(result.solutions.begin(), result.solutions.end(),
                            [](const IkAnswer& answer) { return answer.self_motion.rows() == 2; }));
    EXPECT_EQ(test::missedSolutions(arm.ik, *q, 8), 0);
  }
}

/// A curve that goes over crossings and sharp bends is the same from wherever it is traced.
TEST(Crossings, TheSeedDoesNotChangeTheCurves) {
  for (const char* name : {"panda", "gen3_7dof"}) {
    const Arm arm(name);
    test::SingularPoses maker(arm.robot.chain, kSeed + 1);
    int same = 0;
    int asked = 0;
    for (const test::SingularKind& kind : test::singularKindsOf(arm.robot.chain, arm.robot.task)) {
      const std::optional<VectorX> q = maker.make(kind, 1e-10);
      if (!q) continue;
      const SelfMotionSet set = arm.traced(*q);
      if (set.curves.empty()) continue;
      const auto lengthsOf = [](const SelfMotionSet& all) {
        std::vector<double> lengths;
        for (const SelfMotionCurve& curve : all.curves) lengths.push_back(curve.nodes.back().arc);
        std::sort(lengths.begin(), lengths.end());
        return lengths;
      };
      SelfMotionQuestion question;
      question.target = forwardKinematics(arm.robot.chain, *q);
      question.ignore_limits = true;
      const SelfMotionCurve& last = set.curves.back();
      question.seed = last.nodes[last.nodes.size() / 3].q;
      const std::vector<double> before = lengthsOf(set);
      const std::vector<double> after = lengthsOf(arm.solver.trace(question));
      ++asked;
      same += before.size() == after.size() &&
                      std::equal(before.begin(), before.end(), after.begin(),
                                 [](double a, double b) { return std::abs(a - b) <= 1e-2 * (a + b); })
                  ? 1
                  : 0;
    }
    std::printf("%-10s %d of %d the same from another seed\n", name, same, asked);
    EXPECT_GE(same, asked - 2);
  }
}

}  // namespace
}  // namespace screwline
