// The hot paths allocate nothing: malloc itself is counted, so that Eigen's and the library's own allocations are seen
// alike.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <memory>

#include "algebraic_arms.h"
#include "screwline/ik/algebraic/algebraic_solver.h"
#include "screwline/ik/closed_form/plan.h"
#include "screwline/kinematics/batch.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/trajectory/state_to_state.h"

extern "C" void* __libc_malloc(std::size_t size);

namespace {
std::atomic<long> allocations{0};
}

extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

namespace screwline {
namespace {

template <typename Work>
long allocationsOf(Work&& work) {
  const long before = allocations;
  work();
  return allocations - before;
}

class Allocation : public testing::TestWithParam<int> {
 protected:
  test::ArmMaker maker_{5};
  test::ArmMaker::Arm arm_ = maker_.make(GetParam());
  VectorX q_ = VectorX::LinSpaced(arm_.chain.size(), 0.2, 0.9);
};

TEST_P(Allocation, ForwardKinematicsAllocatesNothing) {
  EXPECT_EQ(allocationsOf([&] { forwardKinematics(arm_.chain, q_); }), 0);
  EXPECT_EQ(allocationsOf([&] { forwardByExponentials(arm_.chain, q_); }), 0);
}

TEST_P(Allocation, GeometricJacobianAllocatesNothing) {
  Matrix6X J(6, arm_.chain.size());
  EXPECT_EQ(allocationsOf([&] { geometricJacobian(arm_.chain, q_, J); }), 0);
}

TEST_P(Allocation, ABatchOnOneThreadAllocatesNothing) {
  const std::size_t n = static_cast<std::size_t>(arm_.chain.size());
  std::vector<double> q(2500 * n, 0.3);
  std::vector<double> poses(2500 * 7);
  std::vector<double> jacobians(2500 * 6 * n);
  EXPECT_EQ(allocationsOf([&] {
              forwardBatch(arm_.chain, {q.data(), 2500, poses.data(), nullptr, jacobians.data()});
            }),
            0);
}

TEST_P(Allocation, ClosedFormAllocatesNothing) {
  const std::optional<ClosedFormPlan> plan = ClosedFormPlan::compile(arm_.chain, arm_.task);
  ASSERT_TRUE(plan.has_value());
  const Pose target = forwardKinematics(arm_.chain, q_);
  PlanSolutions solutions;
  EXPECT_EQ(allocationsOf([&] { plan->solve(target, q_.data(), solutions); }), 0);
  EXPECT_GT(solutions.count, 0);
}

INSTANTIATE_TEST_SUITE_P(Structures, Allocation, testing::Range(0, test::ArmMaker::kStructures));

TEST(AlgebraicAllocation, SolvingAllocatesNothing) {
  test::ArmMaker maker(6);
  const VectorX q = VectorX::LinSpaced(6, 0.2, 0.9);
  for (const SerialChain& chain : {test::generalArm(maker, -1), test::generalArm(maker, 2), test::twoSlideArm(maker)}) {
    const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
    ASSERT_TRUE(solver.has_value());
    const Pose target = forwardKinematics(chain, q);
    AlgebraicSolutions solutions;
    EXPECT_EQ(allocationsOf([&] { solver->solve(target, solutions); }), 0);
    EXPECT_GT(solutions.count, 0);
  }
}

TEST(TimeOptimalAllocation, StateToStateAllocatesNothing) {
  const auto question = std::make_unique<StateToState>();
  const auto motion = std::make_unique<StateToStateMotion>();
  question->joints = 7;
  for (std::size_t j = 0; j < 7; ++j) {
    question->from[j] = {0.1 * static_cast<double>(j), 0.3, -0.2};
    question->to[j] = {1.0 - 0.3 * static_cast<double>(j), -0.1, 0.4};
    question->limits[j] = AxisLimits::symmetric(1.0, 3.0, 30.0);
    question->limits[j].position = {-4.0, 4.0};
  }
  EXPECT_EQ(allocationsOf([&] { moveStateToState(*question, *motion); }), 0);
  EXPECT_EQ(motion->status, MotionStatus::kFound);
}

TEST(AllocationChecker, SeesAnAllocation) {
  EXPECT_GT(allocationsOf([] {
              VectorX v(100);
              v.setOnes();
              ASSERT_GT(v.sum(), 0.0);
            }),
            0);
}

}  // namespace
}  // namespace screwline
