#include <gtest/gtest.h>

#include <cmath>

#include "ik_arms.h"
#include "screwline/ik/inverse_kinematics.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/ik/task_error.h"
#include "screwline/kinematics/forward.h"

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261122;

double difference(const SerialChain& chain, const VectorX& a, const VectorX& b) {
  double largest = 0.0;
  for (int i = 0; i < chain.size(); ++i) {
    const double d = a[i] - b[i];
    largest = std::max(largest, std::abs(chain.joint(i).isRevolute() ? std::remainder(d, kTwoPi) : d));
  }
  return largest;
}

IkResult solveFor(const InverseKinematics& ik, const VectorX& q, bool seeded) {
  IkRequest request;
  request.target = forwardKinematics(ik.chain(), q);
  if (seeded) request.seed = q;
  return ik.solve(request);
}

VectorX randomConfiguration(test::ArmMaker& maker, const SerialChain& chain) {
  VectorX q(chain.size());
  for (int i = 0; i < chain.size(); ++i) q[i] = maker.uniform(-3.1, 3.1) * (chain.joint(i).isRevolute() ? 1.0 : 0.3);
  return q;
}

/// The laws of every answer that has solutions.
void expectLawful(const InverseKinematics& ik, const IkResult& result, const Pose& target) {
  EXPECT_TRUE(result.complete || result.indistinct) << result.message;
  EXPECT_FALSE(result.complete && result.indistinct) << result.message;
  for (std::size_t i = 0; i < result.solutions.size(); ++i) {
    const IkAnswer& solution = result.solutions[i];
    const TaskError error = taskError(ik.task(), target, forwardByExponentials(ik.chain(), solution.position));
    EXPECT_LE(error.norm(), 1e-9);
    EXPECT_TRUE(solution.position.allFinite());
    EXPECT_EQ(solution.self_motion.rows() > 0, !solution.free_joints.empty());
    if (i > 0) {
      EXPECT_GE(solution.distance, result.solutions[i - 1].distance);
    }
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(difference(ik.chain(), solution.position, result.solutions[j].position), 1e-6)
          << "solutions " << j << " and " << i;
    }
  }
}

class IkLaws : public testing::TestWithParam<int> {
 protected:
  test::ArmMaker maker_{kSeed + static_cast<unsigned>(GetParam())};
};

TEST_P(IkLaws, FindsTheGeneratingConfigurationOfRandomArms) {
  for (int arm_index = 0; arm_index < 30; ++arm_index) {
    const test::ArmMaker::Arm arm = maker_.make(GetParam());
    SCOPED_TRACE(arm.structure + ", arm " + std::to_string(arm_index) + ", seed " + std::to_string(kSeed));
    const InverseKinematics ik(arm.chain, arm.task);
    ASSERT_TRUE(ik.complete()) << ik.method();
    for (int trial = 0; trial < 50; ++trial) {
      const VectorX q = randomConfiguration(maker_, arm.chain);
      const IkResult result = solveFor(ik, q, false);
      ASSERT_EQ(result.status, IkStatus::kSolved) << result.message;
      expectLawful(ik, result, forwardKinematics(arm.chain, q));
      EXPECT_TRUE(result.complete) << result.message;
      double nearest = 10.0;
      for (const IkAnswer& solution : result.solutions)
        nearest = std::min(nearest, difference(arm.chain, solution.position, q));
      EXPECT_LE(nearest, 1e-6) << "q = " << q.transpose();
    }
  }
}

TEST_P(IkLaws, ASeedThatSolvesComesBackFirstAtAndNearSpecialConfigurations) {
  const double special[] = {0.0, 0.5 * kPi, -0.5 * kPi, kPi};
  const double offsets[] = {0.0, 1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 1e-4, 1e-3};
  for (int arm_index = 0; arm_index < 20; ++arm_index) {
    const test::ArmMaker::Arm arm = maker_.make(GetParam());
    const InverseKinematics ik(arm.chain, arm.task);
    ASSERT_TRUE(ik.complete());
    for (double offset : offsets) {
      for (int trial = 0; trial < 10; ++trial) {
        VectorX q = randomConfiguration(maker_, arm.chain);
        for (int i = 0; i < q.size(); ++i) {
          if (maker_.index(2) == 0) q[i] = (arm.chain.joint(i).isRevolute() ? special[maker_.index(4)] : 0.0) + offset;
        }
        SCOPED_TRACE(arm.structure + ", arm " + std::to_string(arm_index) + ", offset " + std::to_string(offset));
        const IkResult result = solveFor(ik, q, true);
        ASSERT_EQ(result.status, IkStatus::kSolved) << result.message << " q = " << q.transpose();
        expectLawful(ik, result, forwardKinematics(arm.chain, q));
        EXPECT_TRUE(result.complete || offset < 1e-5) << result.message;
        EXPECT_LE((result.solutions.front().position - q).norm(), 1e-9) << "q = " << q.transpose();
      }
    }
  }
}

TEST_P(IkLaws, NoSolutionIsMissedThatAnExhaustiveSearchFinds) {
  for (int arm_index = 0; arm_index < 4; ++arm_index) {
    const test::ArmMaker::Arm arm = maker_.make(GetParam());
    SCOPED_TRACE(arm.structure);
    const InverseKinematics ik(arm.chain, arm.task);
    const VectorX q = randomConfiguration(maker_, arm.chain);
    const IkResult result = solveFor(ik, q, false);
    SearchOptions options;
    options.restarts = 150;
    options.timeout = 5.0;
    const SearchResult found = search(arm.chain, arm.task, forwardKinematics(arm.chain, q), {}, options);
    for (const VectorX& other : found.solutions) {
      double nearest = 10.0;
      for (const IkAnswer& solution : result.solutions)
        nearest = std::min(nearest, difference(arm.chain, solution.position, other));
      EXPECT_LE(nearest, 1e-5) << "the search found " << other.transpose();
    }
    EXPECT_EQ(found.solutions.size(), result.solutions.size());
  }
}

TEST_P(IkLaws, TheSameRequestGivesTheSameBytes) {
  const test::ArmMaker::Arm arm = maker_.make(GetParam());
  const InverseKinematics ik(arm.chain, arm.task);
  const VectorX q = randomConfiguration(maker_, arm.chain);
  const IkResult first = solveFor(ik, q, false);
  const IkResult second = solveFor(InverseKinematics(arm.chain, arm.task), q, false);
  ASSERT_EQ(first.solutions.size(), second.solutions.size());
  for (std::size_t i = 0; i < first.solutions.size(); ++i) {
    EXPECT_TRUE(first.solutions[i].position == second.solutions[i].position);
    EXPECT_EQ(first.solutions[i].branch, second.solutions[i].branch);
  }
}

TEST_P(IkLaws, BranchNamesDoNotChangeAlongShortSteps) {
  const test::ArmMaker::Arm arm = maker_.make(GetParam());
  const InverseKinematics ik(arm.chain, arm.task);
  for (int trial = 0; trial < 10; ++trial) {
    const VectorX q = randomConfiguration(maker_, arm.chain);
    VectorX next = q;
    for (int i = 0; i < q.size(); ++i) next[i] += maker_.uniform(-1e-5, 1e-5);
    const IkResult at = solveFor(ik, q, true);
    const IkResult beside = solveFor(ik, next, true);
    ASSERT_FALSE(at.solutions.empty());
    ASSERT_FALSE(beside.solutions.empty());
    EXPECT_EQ(at.solutions.front().branch, beside.solutions.front().branch);
    IkRequest request;
    request.target = forwardKinematics(arm.chain, next);
    request.branch = at.solutions.front().branch;
    const std::size_t comma = request.branch.find(", number");
    if (comma != std::string::npos) request.branch.resize(comma);
    EXPECT_EQ(ik.solve(request).status, IkStatus::kSolved);
  }
}

INSTANTIATE_TEST_SUITE_P(Structures, IkLaws, testing::Range(0, test::ArmMaker::kStructures));

}  // namespace
}  // namespace screwline
