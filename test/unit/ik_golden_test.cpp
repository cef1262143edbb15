#include <gtest/gtest.h>

#include <cmath>

#include "golden.h"
#include "screwline/ik/inverse_kinematics.h"
#include "screwline/kinematics/forward.h"

namespace screwline {
namespace {

constexpr double kTolerance = 1e-9;

double difference(const SerialChain& chain, const VectorX& a, const VectorX& b) {
  double largest = 0.0;
  for (int i = 0; i < chain.size(); ++i) {
    const double d = a[i] - b[i];
    largest = std::max(largest, std::abs(chain.joint(i).isRevolute() ? std::remainder(d, kTwoPi) : d));
  }
  return largest;
}

bool isMember(const SerialChain& chain, const golden::IkFamily& family, const VectorX& q) {
  double relation = 0.0;
  for (int i = 0; i < chain.size(); ++i) {
    const std::string& name = chain.joint(i).name;
    const auto fixed = family.fixed.find(name);
    if (fixed != family.fixed.end()) {
      const double d = q[i] - fixed->second;
      if (std::abs(chain.joint(i).isRevolute() ? std::remainder(d, kTwoPi) : d) > kTolerance) return false;
    }
    const auto coefficient = family.relation.find(name);
    if (coefficient != family.relation.end()) relation += coefficient->second * q[i];
  }
  return family.relation.empty() || std::abs(std::remainder(relation - family.relation_value, kTwoPi)) <= kTolerance;
}

class IkGolden : public testing::TestWithParam<std::string> {
 protected:
  const golden::File& file_ = *golden::load(GetParam());

  IkResult solve(const golden::Case& c, const Task& task) const {
    IkRequest request;
    request.target = c.pose;
    return InverseKinematics(file_.chain, task).solve(request);
  }
};

TEST_P(IkGolden, FiniteSetsAreEqual) {
  int checked = 0;
  for (const golden::Case& c : file_.cases) {
    if (c.ik.infinite) continue;
    SCOPED_TRACE(c.id);
    const IkResult result = solve(c, c.ik.task);
    EXPECT_TRUE(result.complete) << result.message;
    EXPECT_EQ(result.solutions.size(), c.ik.solutions.size());
    for (const golden::IkAnswer& expected : c.ik.solutions) {
      double nearest = 10.0;
      for (const IkAnswer& solution : result.solutions) {
        nearest = std::min(nearest, difference(file_.chain, solution.position, expected.q));
        EXPECT_EQ(solution.self_motion.rows(), 0);
      }
      EXPECT_LE(nearest, kTolerance) << "missing " << expected.q.transpose();
    }
    ++checked;
  }
  EXPECT_GT(checked, 0);
}

TEST_P(IkGolden, ContinuaAreTheFamilies) {
  for (const golden::Case& c : file_.cases) {
    if (!c.ik.infinite) continue;
    SCOPED_TRACE(c.id);
    const IkResult result = solve(c, c.ik.task);
    EXPECT_TRUE(result.complete) << result.message;
    EXPECT_EQ(result.solutions.size(), c.ik.families.size());
    for (const golden::IkFamily& family : c.ik.families) {
      int members = 0;
      for (const IkAnswer& solution : result.solutions) {
        if (!isMember(file_.chain, family, solution.position)) continue;
        ++members;
        EXPECT_EQ(solution.self_motion.rows(), static_cast<Eigen::Index>(family.free.size()));
        EXPECT_TRUE(solution.singular);
        // A step along each direction stays in the family, unless the family only looks straight.
        for (Eigen::Index k = 0; k < solution.self_motion.rows(); ++k) {
          EXPECT_TRUE(isMember(file_.chain, family, solution.position + 0.1 * solution.self_motion.row(k).transpose()));
        }
      }
      EXPECT_EQ(members, 1);
    }
  }
}

TEST_P(IkGolden, UnreachablePosesAreProvedSo) {
  for (const golden::UnreachablePose& unreachable : file_.unreachable) {
    SCOPED_TRACE(unreachable.reason);
    IkRequest request;
    request.target = unreachable.pose;
    const IkResult result = InverseKinematics(file_.chain, file_.cases.front().ik.task).solve(request);
    EXPECT_EQ(result.status, IkStatus::kUnreachable) << result.message;
    EXPECT_GT(result.distance_to_reachable, 1e-6);
    EXPECT_EQ(result.closest.position.size(), file_.chain.size());
  }
}

TEST_P(IkGolden, FullPoseTellsWhichSolutionsMatchTheOrientation) {
  for (const golden::Case& c : file_.cases) {
    if (c.ik.infinite || c.singular) continue;
    SCOPED_TRACE(c.id);
    const IkResult result = solve(c, Task());
    std::size_t matches = 0;
    for (const golden::IkAnswer& expected : c.ik.solutions) {
      if (!expected.full_pose_matches) continue;
      ++matches;
      double nearest = 10.0;
      for (const IkAnswer& solution : result.solutions)
        nearest = std::min(nearest, difference(file_.chain, solution.position, expected.q));
      EXPECT_LE(nearest, kTolerance);
    }
    EXPECT_EQ(result.solutions.size(), matches);
  }
}

/// The checker itself fails on a set with a wrong solution.
TEST(IkGoldenChecker, SeesAWrongSolution) {
  const golden::File& file = *golden::load(golden::names().front());
  VectorX wrong = file.cases.front().ik.solutions.front().q;
  wrong[wrong.size() - 1] += 1e-6;
  EXPECT_GT(difference(file.chain, wrong, file.cases.front().ik.solutions.front().q), kTolerance);
}

INSTANTIATE_TEST_SUITE_P(Mechanisms, IkGolden, testing::ValuesIn(golden::names()));

}  // namespace
}  // namespace screwline
