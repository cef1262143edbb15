// Chains that move on at every pose, fewer joints than they need or more: each continuum is one answer.

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "ik_gate.h"
#include "random_urdf.h"
#include "screwline/ik/numerical/nearest_on_manifold.h"
#include "screwline/model/urdf_reader.h"

namespace screwline {
namespace {

constexpr unsigned kFirst = 1;
constexpr unsigned kDocuments = 250;
constexpr double kPush = 1e-3;

VectorX someConfiguration(const SerialChain& chain, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  return VectorX::NullaryExpr(chain.size(), [&] { return 1.5 * unit(random); });
}

int nullityAt(const SerialChain& chain, const VectorX& q) {
  return chain.size() - taskRank(taskJacobian(chain, q, Task())).rank;
}

class SearchedContinua : public testing::Test {
 protected:
  /// Whether a walk along the answer's own continuum towards a random goal leaves the range that it tells.
  bool leavesRange(const SerialChain& chain, const Pose& target, const IkAnswer& answer) {
    NearestOptions options;
    options.honour_limits = false;
    const VectorX goal = answer.position + someConfiguration(chain, random_);
    const VectorX q = nearestOnManifold(chain, Task(), target, answer.position, goal, options).q;
    for (std::size_t k = 0; k < answer.free_joints.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const double value = q[answer.free_joints[k]];
      const JointLimits& limits = chain.joint(answer.free_joints[k]).limits;
      if (value < limits.lower || value > limits.upper) continue;
      if (value < answer.self_motion_lower[i] - 1e-3 || value > answer.self_motion_upper[i] + 1e-3) return true;
    }
    return false;
  }

  IkRequest requestFor(const SerialChain& chain, const VectorX& q) const {
    IkRequest request;
    request.target = forwardKinematics(chain, q);
    request.ignore_limits = true;
    request.timeout = 20.0;
    return request;
  }

  std::mt19937 random_{kFirst};
};

TEST_F(SearchedContinua, EachIsOneAnswerWithItsFreedoms) {
  int chains = 0;
  int left = 0;
  int walked = 0;
  for (unsigned seed = kFirst; seed < kFirst + kDocuments; ++seed) {
    test::RandomUrdf robot(seed);
    const SerialChain chain = readUrdf(robot.text(), {"first", "last"});
    const InverseKinematics ik(chain, Task());
    const VectorX q = someConfiguration(chain, random_);
    const int nullity = nullityAt(chain, q);
    if (ik.complete() || nullity == 0 || chain.size() == 7) continue;
    SCOPED_TRACE("seed " + std::to_string(seed));
    ++chains;
    IkRequest request = requestFor(chain, q);
    request.seed = q + VectorX::Constant(chain.size(), kPush);
    const IkResult result = ik.solve(request);
    ASSERT_FALSE(result.solutions.empty()) << result.message;
    EXPECT_LE(result.solutions.size(), 16U);
    EXPECT_LE(result.solutions.front().distance, static_cast<double>(chain.size()) * kPush);
    for (const IkAnswer& answer : result.solutions) {
      EXPECT_EQ(answer.self_motion.rows(), nullityAt(chain, answer.position));
      EXPECT_FALSE(answer.free_joints.empty());
      ++walked;
      left += leavesRange(chain, request.target, answer) ? 1 : 0;
    }
  }
  std::printf("%d chains, %d continua, %d walks beyond the range told\n", chains, walked, left);
  EXPECT_GE(chains, 20);
  EXPECT_LE(left, walked / 20);  // A walk that stops at a nearest place may stop short of the end.
}

TEST_F(SearchedContinua, ARangeCutShortIsSeen) {
  test::RandomUrdf robot(1);
  const SerialChain chain = readUrdf(robot.text(), {"first", "last"});
  const VectorX q = someConfiguration(chain, random_);
  const IkRequest request = requestFor(chain, q);
  IkResult result = InverseKinematics(chain, Task()).solve(request);
  ASSERT_FALSE(result.solutions.empty());
  IkAnswer answer = result.solutions.front();
  ASSERT_FALSE(answer.free_joints.empty());
  const auto leaves = [&] {
    int count = 0;
    for (int k = 0; k < 50; ++k) count += leavesRange(chain, request.target, answer) ? 1 : 0;
    return count;
  };
  EXPECT_EQ(leaves(), 0);
  for (std::size_t k = 0; k < answer.free_joints.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    answer.self_motion_lower[i] = answer.self_motion_upper[i] = answer.position[answer.free_joints[k]];
  }
  EXPECT_GT(leaves(), 10);
}

/// The same chain's answers do not depend on when they are asked.
TEST_F(SearchedContinua, TheSameRequestGivesTheSameAnswers) {
  test::RandomUrdf robot(88);
  const SerialChain chain = readUrdf(robot.text(), {"first", "last"});
  const InverseKinematics ik(chain, Task());
  const IkRequest request = requestFor(chain, someConfiguration(chain, random_));
  const IkResult first = ik.solve(request);
  const IkResult second = ik.solve(request);
  ASSERT_EQ(first.solutions.size(), second.solutions.size());
  for (std::size_t i = 0; i < first.solutions.size(); ++i) {
    EXPECT_TRUE(first.solutions[i].position == second.solutions[i].position);
    EXPECT_TRUE(first.solutions[i].self_motion_upper == second.solutions[i].self_motion_upper);
  }
}

}  // namespace
}  // namespace screwline
