// Batches of inverse kinematics against the same poses asked one by one.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "screwline/exception.h"
#include "screwline/ik/batch.h"
#include "screwline/kinematics/forward.h"
#include "unit/kinematics_arms.h"

namespace screwline {
namespace {

JointLimits limits(double bound) {
  JointLimits result;
  result.lower = -bound;
  result.upper = bound;
  return result;
}

std::vector<Pose> posesOf(const SerialChain& chain, int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> value(-2.0, 2.0);
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const VectorX q = VectorX::NullaryExpr(chain.size(), [&] { return value(random); });
    poses.push_back(forwardKinematics(chain, q));
    if (i % 5 == 4) poses.back().p.x() += 30.0;
  }
  return poses;
}

IkBatchRequest requestFor(const std::vector<Pose>& poses) {
  IkBatchRequest request;
  request.targets = poses.data();
  request.count = poses.size();
  return request;
}

void expectSame(const IkBatchResult& a, const IkBatchResult& b) {
  EXPECT_EQ(a.counts, b.counts);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.complete, b.complete);
  EXPECT_EQ(a.without_solution, b.without_solution);
  EXPECT_EQ(a.not_begun, b.not_begun);
}

void expectOneByOne(const InverseKinematics& solver, const IkBatchRequest& request, const IkBatchResult& result) {
  ASSERT_EQ(result.counts.size(), request.count);
  ASSERT_EQ(result.complete.size(), request.count);
  const auto n = static_cast<std::size_t>(solver.chain().size());
  std::size_t place = 0;
  std::size_t without = 0;
  for (std::size_t row = 0; row < request.count; ++row) {
    IkRequest question = request.each;
    question.target = request.targets[row];
    const IkResult single = solver.solve(question);
    ASSERT_EQ(result.counts[row], single.solutions.size());
    EXPECT_EQ(result.complete[row] != 0, single.complete);
    without += single.solutions.empty() ? 1 : 0;
    for (const IkAnswer& solution : single.solutions) {
      EXPECT_EQ(VectorX(VectorX::Map(&result.positions[place], solver.chain().size())), solution.position);
      place += n;
    }
  }
  EXPECT_EQ(place, result.positions.size());
  EXPECT_EQ(without, result.without_solution);
}

TEST(IkBatch, EqualsOneByOne) {
  const InverseKinematics solver(arms::offsetArmWithWrist(limits(2.5)), Task());
  const std::vector<Pose> poses = posesOf(solver.chain(), 203);
  for (const bool ignore_limits : {false, true}) {
    for (const int most : {0, 2}) {
      IkBatchRequest request = requestFor(poses);
      request.each.ignore_limits = ignore_limits;
      request.each.max_solutions = most;
      const IkBatchResult result = solveBatch(solver, request);
      expectOneByOne(solver, request, result);
      EXPECT_GT(result.positions.size(), 0U);
      EXPECT_EQ(result.without_solution, 40U);
      EXPECT_FALSE(result.timed_out);
    }
  }
}

TEST(IkBatch, AnyNumberOfThreadsGivesTheSame) {
  const InverseKinematics solver(arms::offsetArmWithWrist(), Task());
  const std::vector<Pose> poses = posesOf(solver.chain(), 501);
  IkBatchRequest request = requestFor(poses);
  const IkBatchResult expected = solveBatch(solver, request);
  for (int threads = 0; threads <= 5; ++threads) {
    request.threads = threads;
    expectSame(solveBatch(solver, request), expected);
  }
}

TEST(IkBatch, NoPosesNoSolutions) {
  const InverseKinematics solver(arms::planarArm(3), Task::parse({"x", "y"}));
  const IkBatchResult result = solveBatch(solver, {});
  EXPECT_TRUE(result.counts.empty());
  EXPECT_TRUE(result.positions.empty());
}

TEST(IkBatch, ABadPoseIsNamedBeforeAnyWork) {
  const InverseKinematics solver(arms::planarArm(3), Task::parse({"x", "y", "rz"}));
  std::vector<Pose> poses(50);
  poses[33].R = rotationAbout(Vector3::UnitX(), 0.1);
  poses[44].p.x() = std::nan("");
  try {
    solveBatch(solver, requestFor(poses));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.code(), AnswerCode::kInvalidGoal);
    EXPECT_NE(std::string(error.what()).find("row 33: "), std::string::npos) << error.what();
  }
}

TEST(IkBatch, IsBoundInTimeAndNumbersAndCancelled) {
  const InverseKinematics solver(arms::offsetArmWithWrist(), Task());
  const std::vector<Pose> poses = posesOf(solver.chain(), 2000);
  for (const int threads : {1, 3}) {
    IkBatchRequest request = requestFor(poses);
    request.threads = threads;
    request.time = 0.0;
    IkBatchResult result = solveBatch(solver, request);
    EXPECT_TRUE(result.timed_out);
    EXPECT_EQ(result.not_begun, poses.size());
    EXPECT_EQ(result.without_solution, poses.size());

    request.time = 3600.0;
    int asked = 0;
    request.cancelled = [&asked] { return ++asked > 3; };
    result = solveBatch(solver, request);
    EXPECT_FALSE(result.timed_out);
    EXPECT_GT(result.not_begun, 0U);
    EXPECT_GE(poses.size() - result.not_begun, 48U);
    const std::size_t sum = std::accumulate(result.counts.begin(), result.counts.end(), std::size_t{0});
    EXPECT_EQ(result.positions.size(), 6 * sum);

    request.cancelled = {};
    request.most_numbers = 100;
    EXPECT_THROW(solveBatch(solver, request), InputError);
  }
}

TEST(IkBatch, WhatIsSearchedNumericallyIsTheSameToo) {
  const InverseKinematics solver(arms::planarArm(3), Task::parse({"x", "y"}));
  const std::vector<Pose> poses = posesOf(solver.chain(), 6);
  IkBatchRequest request = requestFor(poses);
  request.each.timeout = 10.0;
  request.each.max_solutions = 2;
  request.threads = 2;
  expectOneByOne(solver, request, solveBatch(solver, request));
}

}  // namespace
}  // namespace screwline
