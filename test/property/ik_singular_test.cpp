// Laws of inverse kinematics at singular poses of every kind, and beside them, for all robots.
//
// SCREWLINE_POSES: poses of each robot, kind and offset. benchmark/singular_sweep prints the table of the same sweep.

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cstdio>
#include <string>
#include <utility>

#include "ik_arms.h"
#include "ik_gate.h"
#include "shipped_robots.h"
#include "singular_poses.h"
#include "singular_search.h"

namespace screwline {
namespace {

using test::GateVerdict;
using test::IkGate;
using test::SingularKind;
using test::SingularPoses;

constexpr unsigned kSeed = 20261125;

class SingularLaws : public testing::TestWithParam<const char*> {
 protected:
  SingularLaws() : robot_(test::shippedRobot(SCREWLINE_SOURCE_DIR, GetParam())), ik_(robot_.chain, robot_.task) {}

  VectorX push() const { return VectorX::LinSpaced(robot_.chain.size(), 8e-4, -5e-4); }

  test::ShippedRobot robot_;
  InverseKinematics ik_;
};

/// Poses of each kind and offset: more of the arms that lost solutions when there were few.
unsigned usualPoses(const std::string& robot) {
  return robot == "rrr_orthogonal" || robot == "puma560" ? 10 : 2;
}

TEST_P(SingularLaws, EveryPoseIsAnsweredAndNoBranchLost) {
  const unsigned poses = test::wished("SCREWLINE_POSES", usualPoses(GetParam()));
  SingularPoses maker(robot_.chain, kSeed);
  int asked = 0;
  int complete = 0;
  int continua = 0;
  int lost = 0;
  for (const SingularKind& kind : test::singularKindsOf(robot_.chain, robot_.task)) {
    for (double offset : test::singularOffsets()) {
      for (unsigned k = 0; k < poses; ++k) {
        const std::optional<VectorX> q = maker.make(kind, offset);
        if (!q) continue;
        const GateVerdict verdict = IkGate(ik_, *q, true).judge(push());
        EXPECT_TRUE(verdict.isLawful()) << kind.name << " + " << offset << ", seed " << kSeed << "\n  "
                                        << verdict.message << "\n  lost " << verdict.lost << ", complete "
                                        << verdict.complete << ", worst error " << verdict.worst_error
                                        << "\n  q = " << q->transpose();
        ++asked;
        complete += verdict.complete ? 1 : 0;
        continua += verdict.continua > 0 ? 1 : 0;
        lost += verdict.lost ? 1 : 0;
      }
    }
  }
  std::printf("%-16s %4d poses, complete %4d, with continua %4d, lost and said so %4d\n", GetParam(), asked, complete,
              continua, lost);
  // Of poses that do not tell isolated solutions from a continuum, to rounding.
  EXPECT_LE(lost, asked / 500);
}

/// Every robot with as many joints as rows.
const char* const kHeld[] = {"rr_planar",     "rrr_planar",   "planar_3r", "rrr_articulated", "rrr_orthogonal",
                             "rrp_spherical", "rrp_offset",   "scara",     "rpp_cylindrical", "spherical_wrist",
                             "orienting_3r",  "prrr_arm",     "scara_600", "prrr_column",     "youbot_arm",
                             "rrprrr",        "stanford_arm", "puma560",   "kr6_r900",        "irb6640",
                             "m10ia",         "ur5",          "ur10e",     "jaco2_6dof",      "six_r_16"};

INSTANTIATE_TEST_SUITE_P(Robots, SingularLaws, testing::ValuesIn(kHeld));

/// Seven joints: where curves meet some may be missing, and then the list is not said to be complete. Every fourth
/// offset of these is looked at, in turn from kind to kind.
class RedundantSingularLaws : public SingularLaws {};

TEST_P(RedundantSingularLaws, EveryPoseIsAnsweredAndNothingMissingIsCalledComplete) {
  SingularPoses maker(robot_.chain, kSeed);
  int asked = 0;
  int lost = 0;
  std::size_t turn = 0;
  for (const SingularKind& kind : test::singularKindsOf(robot_.chain, robot_.task)) {
    for (std::size_t i = turn++ % 4; i < test::singularOffsets().size(); i += 4) {
      const double offset = test::singularOffsets()[i];
      const std::optional<VectorX> q = maker.make(kind, offset);
      if (!q) continue;
      const GateVerdict verdict = IkGate(ik_, *q, true).judge(push());
      const bool lawful = verdict.answered && verdict.seed_first && verdict.finite && verdict.worst_error < 1e-9 &&
                          !verdict.proved_unreachable && !verdict.threw && !(verdict.lost && verdict.complete);
      EXPECT_TRUE(lawful) << kind.name << " + " << offset << ", seed " << kSeed << "\n  " << verdict.message
                          << "\n  lost " << verdict.lost << ", complete " << verdict.complete << ", worst error "
                          << verdict.worst_error << "\n  q = " << q->transpose();
      ++asked;
      lost += verdict.lost ? 1 : 0;
    }
  }
  std::printf("%-16s %4d poses, lost and said so %4d\n", GetParam(), asked, lost);
  EXPECT_EQ(lost, 0);
}

INSTANTIATE_TEST_SUITE_P(Robots, RedundantSingularLaws, testing::Values("panda", "iiwa14", "gen3_7dof"));

/// At a straight elbow with the wrist above the shoulder the two roots that q stands for leave the real numbers by
/// rounding; two others, 2e-3 away, are none of its.
TEST(AlmostSingular, ADoubleRootIsNotGivenUpForOthersBesideIt) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "puma560");
  const InverseKinematics ik(robot.chain, robot.task);
  VectorX q(6);
  q << 0.66322315802093046, -1.5704094468656533, -1.5245917433764647, 1.3212822275665126, -1.2601167137553382,
      -0.032661087338988537;
  const GateVerdict verdict = IkGate(ik, q, true).judge(VectorX::LinSpaced(6, 8e-4, -5e-4));
  EXPECT_TRUE(verdict.isLawful() && !verdict.lost) << verdict.message;
}

/// The polynomial that elimination leaves should touch zero here, and stays 400 times its noise away.
TEST(AlmostSingular, ADoubleRootIsMetAlsoWhereThePolynomialIsWorseThanItsNoise) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "jaco2_6dof");
  const InverseKinematics ik(robot.chain, robot.task);
  VectorX q(6);
  q << 1.1547307247902285, 2.7353058544696474, 2.470465270089762, 2.3410746049231284, 2.797793276948771,
      -1.7239447501091896;
  const GateVerdict verdict = IkGate(ik, q, true).judge(VectorX::LinSpaced(6, 8e-4, -5e-4));
  EXPECT_TRUE(verdict.isLawful() && !verdict.lost) << verdict.message;
}

/// Places from which Newton's method goes to and fro beside a root that rounding has taken out of the real numbers
/// (checked with 64 bits of mantissa: none is there), and two roots between which the pose is met to rounding.
TEST(AlmostSingular, WhatThePoseDoesNotTellApartIsOne) {
  const std::vector<std::pair<const char*, std::vector<double>>> poses = {
      {"puma560",
       {-1.2151808341216537, -1.5707963257948965, 1.6177742441429797, -0.60743510304228154, 1.4891127844426042,
        2.4532784400765602}},
      {"ur10e",
       {1.4691135140519398, -0.64632344466069702, 3.1330254227916692, -2.1832256808708776, 2.8485296437570033,
        -2.6801969458253256}},
      {"ur10e",
       {0.02122215167201702, -1.029603045895737, -1.3315352190102667, 0.075393375932659268, -3.1292546929314673,
        -1.3992965019640029}}};
  for (const auto& [name, values] : poses) {
    const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, name);
    const InverseKinematics ik(robot.chain, robot.task);
    const VectorX q = Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()));
    const GateVerdict verdict = IkGate(ik, q, true).judge(VectorX::LinSpaced(6, 8e-4, -5e-4));
    EXPECT_TRUE(verdict.isLawful() && verdict.complete) << name << ": " << verdict.message;
  }
}

TEST(AlmostSingular, TheGateTellsTwoSolutionsThatAlmostMeet) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "rrr_planar");
  const InverseKinematics ik(robot.chain, robot.task);
  for (double elbow : {2e-6, 2e-5, 1e-3}) {
    VectorX q(3);
    q << 0.3, elbow, -0.4;
    const IkGate gate(ik, q, true);
    const IkResult result = ik.solve(gate.request());
    ASSERT_EQ(result.solutions.size(), 2u) << elbow;
    const VectorX& nearer = result.solutions[0].position;
    const VectorX& farther = result.solutions[1].position;
    EXPECT_FALSE(gate.isSameToRounding(nearer, farther)) << elbow;
    EXPECT_TRUE(gate.isSameToRounding(nearer, nearer)) << elbow;
  }
}

/// Turns joint 5 until axis 6 is in line with axis 4; false where it cannot.
bool alignWrist(const SerialChain& chain, VectorX& q) {
  const Vector3& h4 = chain.axes()[3].direction;
  const Vector3& h5 = chain.axes()[4].direction;
  const Vector3& h6 = chain.axes()[5].direction;
  if (std::abs(std::abs(h4.dot(h5)) - std::abs(h6.dot(h5))) > 1e-12) return false;
  const Vector3 to = std::copysign(1.0, h4.dot(h5) * h6.dot(h5)) * (h4 - h5 * h5.dot(h4));
  const Vector3 from = h6 - h5 * h5.dot(h6);
  q[4] = std::atan2(h5.dot(from.cross(to)), from.dot(to));
  return true;
}

/// Also of arms whose position is a quartic's root, and of arms near singularities of their own.
TEST(AlignedWrists, OfRandomArmsAreContinua) {
  for (int structure : {10, 11, 12}) {
    test::ArmMaker maker(kSeed + static_cast<unsigned>(structure));
    int poses = 0;
    int described = 0;
    for (int k = 0; k < 20; ++k) {
      const test::ArmMaker::Arm arm = maker.make(structure);
      const InverseKinematics ik(arm.chain, arm.task);
      for (int i = 0; i < 20; ++i) {
        VectorX q(arm.chain.size());
        for (int joint = 0; joint < q.size(); ++joint) {
          q[joint] = maker.uniform(-3.1, 3.1) * (arm.chain.joint(joint).isRevolute() ? 1.0 : 0.3);
        }
        if (!alignWrist(arm.chain, q)) continue;
        IkRequest request;
        request.target = forwardKinematics(arm.chain, q);
        const IkResult result = ik.solve(request);
        const auto isContinuum = [](const IkAnswer& answer) { return answer.self_motion.rows() > 0; };
        const bool found = std::any_of(result.solutions.begin(), result.solutions.end(), isContinuum);
        EXPECT_TRUE(found || !result.complete) << arm.structure << ", seed " << kSeed << ", q = " << q.transpose();
        ++poses;
        described += found ? 1 : 0;
      }
    }
    EXPECT_GE(described, poses - poses / 200) << "structure " << structure << ", of " << poses;
    EXPECT_GE(poses, 100);
  }
}

/// Arms drawn in to almost nothing: by a second-order effect that is below rounding the pose is not that of the
/// continuum, and any value of the second joint meets it.
TEST(ToldFromContinua, WhatThePoseDoesNotTellIsNotCalledComplete) {
  const std::vector<std::pair<const char*, std::vector<double>>> poses = {
      {"rrp_offset", {-2.1282814890692419, 1.5619137918690971, 1e-8}},
      {"stanford_arm",
       {0.60212628043297611, -1.5706218670820415, 1e-9, -1.9971362327387991, 1.5012524622812071, -2.3}}};
  for (const auto& [name, values] : poses) {
    const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, name);
    const InverseKinematics ik(robot.chain, robot.task);
    const VectorX q = Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()));
    const IkResult result = ik.solve(IkGate(ik, q, true).request());
    EXPECT_FALSE(result.solutions.empty()) << name;
    EXPECT_FALSE(result.complete) << name;
    EXPECT_NE(result.message.find("rounding hides"), std::string::npos) << result.message;
    // Drawn in no farther than to a millimetre, the pose tells all.
    VectorX beside = q;
    beside[2] = 1e-3;
    EXPECT_TRUE(ik.solve(IkGate(ik, beside, true).request()).complete) << name;
  }
}

/// Two conditions within 1e-9: between the answers and the configuration lies no other pose, to rounding, and of two
/// weak directions neither need be the one along which it is met.
TEST(ToldFromContinua, ThreeParallelAxesAndTwoWeakDirectionsAreAskedToo) {
  const std::vector<std::pair<const char*, std::vector<double>>> poses = {
      {"ur5",
       {0.72407875867684268, -1.7333931906738169, -3.0381000193756691, 2.1329346538713621, 1.0000000000000001e-09,
        -0.39201357775443357}},
      {"puma560",
       {1.3049995290294247, -1.5707963257948965, 1.6177742441429797, 0.32100511546436539, 1.0000000000000001e-09,
        -1.7330240139035327}}};
  for (const auto& [name, values] : poses) {
    const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, name);
    const InverseKinematics ik(robot.chain, robot.task);
    const VectorX q = Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()));
    const IkResult result = ik.solve(IkGate(ik, q, true).request());
    for (const IkAnswer& answer : result.solutions) {
      EXPECT_GT(test::jointDifference(robot.chain, answer.position, q), 0.1) << name;
    }
    EXPECT_FALSE(result.complete) << name;
    EXPECT_NE(result.message.find("rounding hides"), std::string::npos) << result.message;
  }
}

TEST(AlwaysSingular, ArmsAreAnswered) {
  for (const test::AlwaysSingularArm& arm : test::alwaysSingularArms()) {
    const InverseKinematics ik(arm.chain, Task());
    SingularPoses maker(arm.chain, kSeed);
    for (int k = 0; k < 10; ++k) {
      const VectorX q = maker.regular();
      const GateVerdict verdict = IkGate(ik, q, true).judge(VectorX::LinSpaced(q.size(), 8e-4, -5e-4));
      EXPECT_TRUE(verdict.isLawful()) << arm.name << ", " << ik.method() << "\n  " << verdict.message
                                      << "\n  q = " << q.transpose();
    }
  }
}

/// Follows a continuum by its tangents, small steps brought back to the pose, both ways until a joint breaks a limit or
/// the start is met again: knows of no closed form. Lowest and highest values of all joints.
void follow(const SerialChain& chain, const Pose& target, const VectorX& start, VectorX& lower, VectorX& upper) {
  constexpr double kStep = 4e-3;
  lower = upper = start;
  Matrix6X J;
  for (double way : {1.0, -1.0}) {
    VectorX q = start;
    VectorX ahead;
    for (int k = 0; k < 20000; ++k) {
      geometricJacobian(chain, q, J);
      VectorX tangent = Svd(MatrixX(J), Eigen::ComputeFullV).matrixV().col(5);
      if (k == 0) ahead = way * tangent;
      tangent *= tangent.dot(ahead) < 0.0 ? -1.0 : 1.0;
      VectorX next = q + kStep * tangent;
      for (int newton = 0; newton < 2; ++newton) {
        const Pose tip = geometricJacobian(chain, next, J);
        Eigen::CompleteOrthogonalDecomposition<MatrixX> solver;
        solver.setThreshold(1e-2 * kStep);
        next += solver.compute(J).solve(taskError(Task(), target, tip).twist);
      }
      ahead = tangent;
      double share = 1.0;
      for (int i = 0; i < chain.size(); ++i) {
        const JointLimits& limits = chain.joint(i).limits;
        const double limit = next[i] > q[i] ? limits.upper : limits.lower;
        if (next[i] > limits.upper || next[i] < limits.lower)
          share = std::min(share, (limit - q[i]) / (next[i] - q[i]));
      }
      next = q + share * (next - q);
      lower = lower.cwiseMin(next);
      upper = upper.cwiseMax(next);
      if (share < 1.0 || (k > 10 && test::jointDifference(chain, next, start) < kStep)) break;
      q = next;
    }
  }
}

TEST(ContinuumRanges, AreThoseMetOnTheWay) {
  int compared = 0;
  for (const auto& [name, way] : {std::pair<const char*, const char*>{"kr6_r900", "shoulder"},
                                  {"irb6640", "shoulder"},
                                  {"stanford_arm", "extension"},
                                  {"stanford_arm", "wrist"},
                                  {"ur5", "wrist"}}) {
    const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, name);
    const InverseKinematics ik(robot.chain, robot.task);
    SingularPoses maker(robot.chain, kSeed);
    for (const SingularKind& kind : test::singularKindsOf(robot.chain, robot.task)) {
      if (kind.name != way) continue;
      const VectorX q = *maker.make(kind, 0.0);
      const IkRequest request = IkGate(ik, q, false).request();
      for (const IkAnswer& answer : ik.solve(request).solutions) {
        if (answer.self_motion.rows() != 1) continue;
        VectorX lower;
        VectorX upper;
        follow(robot.chain, request.target, answer.position, lower, upper);
        for (std::size_t k = 0; k < answer.free_joints.size(); ++k) {
          const int i = answer.free_joints[k];
          const auto at = static_cast<Eigen::Index>(k);
          EXPECT_NEAR(answer.self_motion_lower[at], lower[i], 1e-4) << name << ' ' << way << ", joint " << i;
          EXPECT_NEAR(answer.self_motion_upper[at], upper[i], 1e-4) << name << ' ' << way << ", joint " << i;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 10);
}

TEST(SingularPosesMaker, TheSearchSeesWhatOneBranchLeavesOut) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "rrr_planar");
  const InverseKinematics ik(robot.chain, robot.task);
  VectorX q(3);
  q << 0.3, 0.9, -0.4;
  EXPECT_EQ(test::missedSolutions(ik, q, 60), 0);
  EXPECT_EQ(test::missedSolutions(ik, q, 60, 1), 1);
}

}  // namespace
}  // namespace screwline
