// Inverse kinematics of arms whose description is not quite what the maker drew: pi written down with few digits,
// calibrated places of joints. Every branch of the nominal arm is to be found, on the arm as it is.
//
// SCREWLINE_POSES: poses of each arm.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "calibrated.h"
#include "ik_gate.h"
#include "shipped_robots.h"
#include "singular_search.h"

namespace screwline {
namespace {

using test::calibrated;
using test::GateVerdict;
using test::IkGate;

constexpr unsigned kSeed = 20261125;

const char* const kArms[] = {"puma560", "stanford_arm", "kr6_r900",  "irb6640",    "m10ia",    "ur5",       "ur10e",
                             "panda",   "iiwa14",       "gen3_7dof", "jaco2_6dof", "six_r_16", "youbot_arm"};

/// The chain with another table: same joints and limits.
SerialChain withTable(const SerialChain& chain, const ModifiedDh& table) {
  std::vector<bool> prismatic;
  for (const Axis& axis : chain.axes()) prismatic.push_back(axis.prismatic);
  ChainDescription description;
  description.name = chain.name();
  description.base_link = chain.baseLink();
  description.tip_link = chain.tipLink();
  description.joints = chain.joints();
  description.axes = axesOf(table, prismatic);
  for (std::size_t i = 0; i < description.axes.size(); ++i) description.axes[i].source = static_cast<int>(i);
  description.home = homeOf(table);
  description.links = {{chain.tipLink(), chain.size(), description.home}};
  return SerialChain(description);
}

/// Angles with so many decimals.
SerialChain withDecimals(const SerialChain& chain, int decimals) {
  const double unit = std::pow(10.0, -decimals);
  ModifiedDh table = chain.modifiedDh();
  for (ModifiedDhRow& row : table.rows) {
    row.alpha = unit * std::round(row.alpha / unit);
    row.theta = unit * std::round(row.theta / unit);
  }
  return withTable(chain, table);
}

struct Imperfect {
  std::string name;
  SerialChain chain;
};

std::vector<Imperfect> imperfect(const SerialChain& chain, std::mt19937& random) {
  std::vector<Imperfect> arms;
  for (int decimals : {4, 6, 8, 10})
    arms.push_back({std::to_string(decimals) + " decimals", withDecimals(chain, decimals)});
  arms.push_back({"0.5 mm, 0.5 mrad", calibrated(chain, 5e-4, 5e-4, random)});
  arms.push_back({"0.02 mm, 0.02 mrad", calibrated(chain, 2e-5, 2e-5, random)});
  return arms;
}

VectorX within(const SerialChain& chain, std::mt19937& random) {
  VectorX q(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    const JointLimits& limits = chain.joint(i).limits;
    q[i] = std::uniform_real_distribution<double>(std::max(limits.lower, -kPi), std::min(limits.upper, kPi))(random);
  }
  return q;
}

/// The true arm's solution next to a nominal one, by Newton steps of least norm. Empty where the nominal one is near a
/// singularity: there solutions may vanish.
VectorX continued(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& nominal) {
  Matrix6X J;
  VectorX q = nominal;
  for (int k = 0; k < 30; ++k) {
    const TaskError error = taskError(task, target, geometricJacobian(chain, q, J));
    const MatrixX J_task = task.select(J);
    if (k == 0 && singularValues(J_task).minCoeff() < 0.03) return VectorX();
    const VectorX step = J_task.completeOrthogonalDecomposition().solve(task.select(error.twist));
    q += step;
    if ((q - nominal).norm() > 0.3) return VectorX();
    if (step.norm() < 1e-13) break;
  }
  return taskError(task, target, forwardKinematics(chain, q)).norm() < 1e-11 ? q : VectorX();
}

class ImperfectArm : public testing::TestWithParam<const char*> {};

TEST_P(ImperfectArm, HasEveryBranchOfTheNominalOne) {
  const unsigned poses = test::wished("SCREWLINE_POSES", 5);
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, GetParam());
  const InverseKinematics nominal(robot.chain, robot.task);
  std::mt19937 random(kSeed);
  for (const Imperfect& arm : imperfect(robot.chain, random)) {
    const InverseKinematics ik(arm.chain, robot.task);
    int complete = 0;
    int branches = 0;
    int lost = 0;
    for (unsigned k = 0; k < poses; ++k) {
      const VectorX q = within(arm.chain, random);
      SCOPED_TRACE(arm.name + ", " + ik.method() + ", seed " + std::to_string(kSeed));
      const IkGate gate(ik, q, true);
      const GateVerdict verdict = IkGate(gate).judge(VectorX::LinSpaced(q.size(), 8e-4, -5e-4));
      EXPECT_TRUE(verdict.isLawful()) << verdict.message << "\n  q = " << q.transpose();
      complete += verdict.complete ? 1 : 0;
      const IkResult result = ik.solve(gate.request());
      const IkRequest request = gate.request();
      for (const IkAnswer& answer : nominal.solve(request).solutions) {
        const VectorX expected = continued(arm.chain, robot.task, request.target, answer.position);
        if (expected.size() == 0) continue;
        ++branches;
        const bool known = gate.isKnown(expected, result, test::placeTolerance(arm.chain, robot.task, expected));
        lost += known ? 0 : 1;
        EXPECT_TRUE(known) << "nominal branch " << answer.branch << "\n  at " << expected.transpose()
                           << "\n  q = " << q.transpose() << "\n  complete " << result.complete;
      }
      if (k == 0 && result.complete) {
        EXPECT_EQ(test::missedSolutions(ik, q, 200), 0) << "q = " << q.transpose();
      }
    }
    std::printf("%-12s %-20s %3u poses, complete %3d, nominal branches %4d, lost %d; %s\n", GetParam(),
                arm.name.c_str(), poses, complete, branches, lost, ik.method().c_str());
  }
}

INSTANTIATE_TEST_SUITE_P(Arms, ImperfectArm, testing::ValuesIn(kArms));

/// A wrist that is almost aligned: where the nominal arm's is, elimination finds roots crowded together.
class AlmostAlignedWrist : public testing::TestWithParam<const char*> {};

TEST_P(AlmostAlignedWrist, LosesNothing) {
  const unsigned poses = test::wished("SCREWLINE_POSES", 8);
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, GetParam());
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> exponent(-4.0, -1.0);
  int asked = 0;
  int complete = 0;
  for (double off : {2e-5, 5e-4}) {
    const SerialChain chain = calibrated(robot.chain, off, off, random);
    const InverseKinematics ik(chain, robot.task);
    for (unsigned k = 0; k < poses; ++k) {
      VectorX q = within(chain, random);
      q[4] = std::copysign(std::pow(10.0, exponent(random)), q[4]);
      const IkGate gate(ik, q, true);
      const IkResult result = ik.solve(gate.request());
      ++asked;
      complete += result.complete ? 1 : 0;
      EXPECT_TRUE(gate.isKnown(q, result, test::placeTolerance(chain, robot.task, q)))
          << "seed " << kSeed << ", " << off << ", q = " << q.transpose() << "\n  " << result.message;
      if (k == 0 && result.complete) {
        EXPECT_EQ(test::missedSolutions(ik, q, 100), 0) << "q = " << q.transpose();
      }
    }
  }
  std::printf("%-12s almost aligned: %d poses, complete %d\n", GetParam(), asked, complete);
}

INSTANTIATE_TEST_SUITE_P(Arms, AlmostAlignedWrist,
                         testing::Values("puma560", "stanford_arm", "kr6_r900", "irb6640", "m10ia"));

/// The checker sees a branch that is not there.
TEST(ImperfectArmCheck, SeesAMissingBranch) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "puma560");
  const InverseKinematics ik(robot.chain, robot.task);
  std::mt19937 random(kSeed);
  const IkGate gate(ik, within(robot.chain, random), true);
  IkResult result = ik.solve(gate.request());
  ASSERT_GE(result.solutions.size(), 2U);
  const VectorX last = result.solutions.back().position;
  EXPECT_TRUE(gate.isKnown(last, result, 1e-6));
  result.solutions.pop_back();
  EXPECT_FALSE(gate.isKnown(last, result, 1e-6));
}

}  // namespace
}  // namespace screwline
