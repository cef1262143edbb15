// Continua whose members follow from the value of their one free joint: in closed form, against the plans' solutions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "screwline/ik/closed_form/parallel_plan.h"
#include "screwline/ik/inverse_kinematics.h"
#include "screwline/kinematics/forward.h"
#include "screwline/spatial/screw.h"
#include "shipped_robots.h"
#include "singular_poses.h"

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261128;
constexpr double kExact = 1e-13;  // [m, rad] of forward kinematics.
constexpr double kEnd = 1e-8;     // [rad] Ends are folds: what the plan takes for one has this width.

std::vector<VectorX> singularPosesOf(const test::ShippedRobot& robot, const std::string& way, unsigned count) {
  test::SingularPoses maker(robot.chain, kSeed);
  std::vector<VectorX> poses;
  for (const test::SingularKind& kind : test::singularKindsOf(robot.chain, robot.task)) {
    if (kind.name.find(way) == std::string::npos) continue;
    for (unsigned k = 0; k < count; ++k) {
      if (const std::optional<VectorX> q = maker.make(kind, 0.0)) poses.push_back(*q);
    }
  }
  return poses;
}

double errorOf(const SerialChain& chain, const PlanSolution& solution, const Pose& target) {
  return poseDifference(target, forwardKinematics(chain, jointsOf(solution, chain.size()))).norm();
}

/// What the plan itself finds on a sheet, one value at a time.
class ParallelWalk {
 public:
  ParallelWalk(const ParallelPlan& plan, const ParallelSheet& sheet, const Pose& target)
      : plan_(plan), target_(target), joint_(sheet.joint()), branch_(sheet.member(0.0, 1)) {}

  bool exists(double value) const {
    std::array<double, 6> preferred{};
    preferred[static_cast<std::size_t>(joint_)] = value;
    ParallelSolutions solutions;
    plan_.solve(target_, preferred.data(), solutions);
    for (int k = 0; k < solutions.count; ++k) {
      const PlanSolution& one = solutions.solutions[static_cast<std::size_t>(k)];
      const bool same = one.free == branch_.free && one.sign[0] == branch_.sign[0] && one.sign[2] == branch_.sign[2];
      if (same && (solutions.clamped >> k & 1U) == 0U) return true;
    }
    return false;
  }

  /// Between a value that has a solution and one that has none.
  double endBetween(double inside, double outside) const {
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (inside + outside);
      (exists(middle) ? inside : outside) = middle;
    }
    return inside;
  }

 private:
  const ParallelPlan& plan_;
  Pose target_;
  int joint_;
  PlanSolution branch_;
};

bool isWithin(const SheetStretch& stretch, double value) {
  const double from = stretch.from + kTwoPi * std::ceil((value - stretch.from) / kTwoPi - 1.0);
  return stretch.whole || value - from <= stretch.to - stretch.from;
}

double distanceFromEnds(const std::vector<SheetStretch>& stretches, double value) {
  double least = kTwoPi;
  for (const SheetStretch& stretch : stretches) {
    for (double end : {stretch.from, stretch.to})
      least = std::min(least, std::abs(std::remainder(value - end, kTwoPi)));
  }
  return least;
}

class ParallelSheets : public testing::TestWithParam<const char*> {
 protected:
  test::ShippedRobot robot_ = test::shippedRobot(SCREWLINE_SOURCE_DIR, GetParam());
  std::optional<ParallelPlan> plan_ = ParallelPlan::compile(robot_.chain);
};

TEST_P(ParallelSheets, EndsAreThoseThatTheWalkMeets) {
  ASSERT_TRUE(plan_);
  int ends = 0;
  int wholes = 0;
  for (const VectorX& q : singularPosesOf(robot_, "wrist", 60)) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", q = " << q.transpose());
    const Pose target = forwardKinematics(robot_.chain, q);
    for (const ParallelSheet& sheet : plan_->sheets(target)) {
      const std::vector<SheetStretch> stretches = sheet.stretches();
      const ParallelWalk walk(*plan_, sheet, target);
      for (double value = -3.0; value < 3.2; value += 0.05) {
        if (distanceFromEnds(stretches, value) < kEnd) continue;
        const bool within = std::any_of(stretches.begin(), stretches.end(),
                                        [&](const SheetStretch& one) { return isWithin(one, value); });
        EXPECT_EQ(walk.exists(value), within) << value;
      }
      for (const SheetStretch& one : stretches) {
        wholes += one.whole ? 1 : 0;
        if (one.whole || one.isPoint() || one.to - one.from < 0.1) continue;
        if (!one.passes_from && !walk.exists(one.from - 0.01)) {
          EXPECT_NEAR(walk.endBetween(one.from + 0.01, one.from - 0.01), one.from, kEnd);
          ++ends;
        }
        if (!one.passes_to && !walk.exists(one.to + 0.01)) {
          EXPECT_NEAR(walk.endBetween(one.to - 0.01, one.to + 0.01), one.to, kEnd);
          ++ends;
        }
      }
    }
  }
  EXPECT_GT(ends, 20);
  EXPECT_GT(wholes, 3);
}

TEST_P(ParallelSheets, MembersSolveThePose) {
  ASSERT_TRUE(plan_);
  int members = 0;
  for (const VectorX& q : singularPosesOf(robot_, "wrist", 60)) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", q = " << q.transpose());
    const Pose target = forwardKinematics(robot_.chain, q);
    for (const ParallelSheet& sheet : plan_->sheets(target)) {
      for (const SheetStretch& one : sheet.stretches()) {
        for (const double share : {0.0, 0.01, 0.3, 0.7, 1.0}) {
          for (int elbow : {1, -1}) {
            const PlanSolution member = sheet.member(one.from + share * (one.to - one.from), elbow);
            EXPECT_LE(errorOf(robot_.chain, member, target), kExact);
            EXPECT_TRUE(member.sign[1] == elbow || member.sign[1] == 0);
            ++members;
          }
        }
      }
    }
  }
  EXPECT_GT(members, 100);
}

/// One where the free joint turns back, two where it goes all the way round.
TEST_P(ParallelSheets, EachLoopIsAnsweredOnce) {
  ASSERT_TRUE(plan_);
  const InverseKinematics ik(robot_.chain, robot_.task);
  for (const VectorX& q : singularPosesOf(robot_, "wrist", 60)) {
    const Pose target = forwardKinematics(robot_.chain, q);
    int loops = 0;
    bool crosses = false;
    for (const ParallelSheet& sheet : plan_->sheets(target)) {
      for (const SheetStretch& one : sheet.stretches()) {
        crosses = crosses || one.passes_from || one.passes_to;
        if (!one.isPoint()) loops += one.whole && !one.straight ? 2 : 1;
      }
    }
    if (crosses) continue;
    IkRequest request;
    request.target = target;
    request.ignore_limits = true;
    const IkResult result = ik.solve(request);
    const auto continua = std::count_if(result.solutions.begin(), result.solutions.end(),
                                        [](const IkAnswer& answer) { return answer.self_motion.rows() == 1; });
    EXPECT_EQ(continua, loops) << "seed " << kSeed << ", q = " << q.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, ParallelSheets, testing::Values("ur5", "ur10e"));

class PlanSheets : public testing::TestWithParam<const char*> {
 protected:
  test::ShippedRobot robot_ = test::shippedRobot(SCREWLINE_SOURCE_DIR, GetParam());
  std::optional<ClosedFormPlan> plan_ = ClosedFormPlan::compile(robot_.chain, robot_.task);
};

/// What the whole plan finds on a solution's branch at another value of its free joint.
std::optional<PlanSolution> branchAt(const ClosedFormPlan& plan, const Pose& target, const PlanSolution& branch,
                                     int joint, double value) {
  std::array<double, 6> preferred = branch.q;
  preferred[static_cast<std::size_t>(joint)] = value;
  PlanSolutions solutions;
  plan.solve(target, preferred.data(), solutions);
  for (const PlanSolution& one : solutions) {
    if (one.free == branch.free && one.sign == branch.sign && one.rank == branch.rank) return one;
  }
  return std::nullopt;
}

TEST_P(PlanSheets, MembersAreThoseOfTheWholePlan) {
  ASSERT_TRUE(plan_);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> turn(-kPi, kPi);
  int sheets = 0;
  int missing = 0;
  for (const VectorX& q : singularPosesOf(robot_, "", 30)) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", q = " << q.transpose());
    const Pose target = forwardKinematics(robot_.chain, q);
    PlanSolutions solutions;
    plan_->solve(target, q.data(), solutions);
    for (const PlanSolution& branch : solutions) {
      const std::optional<PlanSheet> sheet = plan_->sheetOf(target, branch);
      if (!sheet) continue;
      ++sheets;
      const int joint = freeJointsOf(branch).front();
      for (int k = 0; k < 10; ++k) {
        const double value = turn(random);
        const std::optional<PlanSolution> expected = branchAt(*plan_, target, branch, joint, value);
        PlanSolution member;
        const bool exists = sheet->member(value, member);
        ASSERT_EQ(exists, expected.has_value()) << "value " << value;
        missing += exists ? 0 : 1;
        if (!exists) continue;
        const VectorX apart = jointsOf(member, 6) - jointsOf(*expected, 6);
        for (int i = 0; i < 6; ++i) EXPECT_NEAR(std::remainder(apart[i], kTwoPi), 0.0, 1e-11) << "joint " << i;
        EXPECT_EQ(member.free, branch.free);
      }
    }
  }
  EXPECT_GT(sheets, 10);
  std::printf("%s: %d sheets, %d values without a member\n", GetParam(), sheets, missing);
}

INSTANTIATE_TEST_SUITE_P(Robots, PlanSheets, testing::Values("kr6_r900", "irb6640", "m10ia", "stanford_arm"));

/// Where all joints that place the wrist move along, or none of them does, there is no such sheet.
TEST(PlanSheets, AreNotMadeUp) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "kr6_r900");
  const std::optional<ClosedFormPlan> plan = ClosedFormPlan::compile(robot.chain, robot.task);
  ASSERT_TRUE(plan);
  test::SingularPoses maker(robot.chain, kSeed);
  const VectorX q = maker.regular();
  const Pose target = forwardKinematics(robot.chain, q);
  PlanSolutions solutions;
  plan->solve(target, q.data(), solutions);
  ASSERT_GT(solutions.count, 0);
  for (PlanSolution solution : solutions) {
    EXPECT_FALSE(plan->sheetOf(target, solution));
    solution.free = 1U;  // A joint that is not free.
    EXPECT_FALSE(plan->sheetOf(target, solution));
    solution.free = 1U << 3;  // One of the wrist's.
    EXPECT_FALSE(plan->sheetOf(target, solution));
  }
}

}  // namespace
}  // namespace screwline
