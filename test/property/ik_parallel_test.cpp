#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/LU>

#include "algebraic_arms.h"
#include "parallel_arms.h"
#include "screwline/ik/algebraic/algebraic_solver.h"
#include "screwline/ik/closed_form/parallel_plan.h"
#include "screwline/ik/inverse_kinematics.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/kinematics/forward.h"

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261125;
constexpr double kOffsets[] = {0.0, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3};

double difference(const VectorX& a, const VectorX& b) {
  double largest = 0.0;
  for (int i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(std::remainder(a[i] - b[i], kTwoPi)));
  return largest;
}

VectorX randomTurns(test::ArmMaker& maker) {
  VectorX q(6);
  for (int i = 0; i < 6; ++i) q[i] = maker.uniform(-kPi, kPi);
  return q;
}

/// Whether a chain of configurations that solve the pose to 1e-10 leads from one solution to the other: then no
/// rounding of the pose tells them apart, or they are of one continuum.
bool areJoined(const SerialChain& chain, const Pose& target, const VectorX& from, const VectorX& to) {
  VectorX at = from;
  for (int i = 0; i < 400; ++i) {
    VectorX way(6);
    for (int k = 0; k < 6; ++k) way[k] = std::remainder(to[k] - at[k], kTwoPi);
    const double left = way.cwiseAbs().maxCoeff();
    if (left <= 1e-6) return true;
    VectorX next = at + std::min(1.0, 0.02 / left) * way;
    const TaskError error = polish(chain, Task(), target, next);
    if (!(error.norm() <= 1e-10) || !(difference(next, to) < left)) return false;
    at = next;
  }
  return false;
}

/// Whether a solution that another method found is in the list: itself, on a continuum, or not to be told from one.
bool isListed(const SerialChain& chain, const Pose& target, const IkResult& result, const VectorX& q) {
  for (const IkAnswer& answer : result.solutions) {
    if (difference(answer.position, q) <= 2e-6 || areJoined(chain, target, answer.position, q)) return true;
    // Members of a continuum: from the one that is nearest to `q`.
    if (answer.self_motion.rows() == 0) continue;
  }
  // The member nearest to `q` is `q` itself where it lies on one of the continua.
  IkRequest request;
  request.target = target;
  request.seed = q;
  const InverseKinematics ik(chain, Task());
  const IkResult seeded = ik.solve(request);
  for (const IkAnswer& answer : seeded.solutions) {
    if (answer.self_motion.rows() > 0 && difference(answer.position, q) <= 1e-6 &&
        seeded.solutions.size() == result.solutions.size())
      return true;
  }
  return false;
}

void expectLawful(const InverseKinematics& ik, const IkResult& result, const Pose& target) {
  EXPECT_TRUE(result.complete) << result.message;
  for (std::size_t i = 0; i < result.solutions.size(); ++i) {
    const IkAnswer& solution = result.solutions[i];
    ASSERT_TRUE(solution.position.allFinite());
    EXPECT_LE(taskError(Task(), target, forwardByExponentials(ik.chain(), solution.position)).norm(), 1e-9);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(difference(solution.position, result.solutions[j].position), 1e-6) << j << " and " << i;
  }
}

class IkParallel : public testing::TestWithParam<int> {
 protected:
  test::ParallelArmMaker arms_{kSeed + static_cast<unsigned>(GetParam())};
  test::ArmMaker& maker_ = arms_.maker();

  void SetUp() override { RecordProperty("seed", static_cast<int>(kSeed)); }
};

TEST_P(IkParallel, FindsTheGeneratingConfigurationOfRandomArms) {
  for (int arm = 0; arm < 20; ++arm) {
    const SerialChain chain = arms_.make(GetParam());
    SCOPED_TRACE(test::ParallelArmMaker::name(GetParam()) + ", arm " + std::to_string(arm) + ", seed " +
                 std::to_string(kSeed));
    const InverseKinematics ik(chain, Task());
    ASSERT_NE(ik.method().find("three parallel axes"), std::string::npos) << ik.method();
    for (int trial = 0; trial < 100; ++trial) {
      const VectorX q = randomTurns(maker_);
      IkRequest request;
      request.target = forwardKinematics(chain, q);
      const IkResult result = ik.solve(request);
      ASSERT_EQ(result.status, IkStatus::kSolved) << result.message;
      expectLawful(ik, result, request.target);
      double nearest = 10.0;
      for (const IkAnswer& answer : result.solutions) nearest = std::min(nearest, difference(answer.position, q));
      EXPECT_LE(nearest, 1e-6) << "q = " << q.transpose();
    }
  }
}

/// A configuration where the Jacobian is singular: by the pair, the elbow, the single joint, or some of them at once.
/// The single joint's singularity, and all at once, by bisection of the determinant along a line of turns.
VectorX specialTurns(test::ArmMaker& maker, double offset) {
  const double special[] = {0.0, 0.5 * kPi, -0.5 * kPi, kPi};
  VectorX q = randomTurns(maker);
  for (int i = 0; i < 6; ++i) {
    if (maker.index(2) == 0) q[i] = special[maker.index(4)] + offset;
  }
  return q;
}

TEST_P(IkParallel, LosesNothingThatEliminationFindsAtAndNearSpecialConfigurations) {
  for (int arm = 0; arm < 6; ++arm) {
    const SerialChain chain = arms_.make(GetParam());
    const InverseKinematics ik(chain, Task());
    const std::optional<AlgebraicSolver> algebraic = AlgebraicSolver::compile(chain);
    ASSERT_TRUE(algebraic.has_value());
    for (double offset : kOffsets) {
      for (int trial = 0; trial < 8; ++trial) {
        const VectorX q = specialTurns(maker_, offset);
        SCOPED_TRACE(test::ParallelArmMaker::name(GetParam()) + ", arm " + std::to_string(arm) + ", offset " +
                     std::to_string(std::log10(offset)) + ", seed " + std::to_string(kSeed));
        IkRequest request;
        request.target = forwardKinematics(chain, q);
        const IkResult result = ik.solve(request);
        ASSERT_EQ(result.status, IkStatus::kSolved) << result.message << " q = " << q.transpose();
        expectLawful(ik, result, request.target);
        EXPECT_TRUE(isListed(chain, request.target, result, q)) << "q = " << q.transpose();
        AlgebraicSolutions roots;
        algebraic->solve(request.target, roots);
        for (const std::array<double, 6>& root : roots) {
          const VectorX other = Eigen::Map<const Vector6>(root.data());
          EXPECT_TRUE(isListed(chain, request.target, result, other))
              << "q = " << q.transpose() << "\nelimination found " << other.transpose();
        }
        IkRequest seeded = request;
        seeded.seed = q;
        const IkResult from_seed = ik.solve(seeded);
        ASSERT_EQ(from_seed.status, IkStatus::kSolved);
        EXPECT_LE((from_seed.solutions.front().position - q).norm(), 1e-9) << "q = " << q.transpose();
      }
    }
  }
}

TEST_P(IkParallel, FindsAsManyAsAnExhaustiveSearch) {
  for (int arm = 0; arm < 3; ++arm) {
    const SerialChain chain = arms_.make(GetParam());
    const InverseKinematics ik(chain, Task());
    IkRequest request;
    request.target = forwardKinematics(chain, randomTurns(maker_));
    const IkResult result = ik.solve(request);
    SearchOptions options;
    options.restarts = 300;
    options.timeout = 10.0;
    const SearchResult found = search(chain, Task(), request.target, {}, options);
    EXPECT_LE(found.solutions.size(), result.solutions.size());
    for (const VectorX& q : found.solutions) EXPECT_TRUE(isListed(chain, request.target, result, q)) << q.transpose();
  }
}

TEST_P(IkParallel, BranchNamesStayAlongPathsThatMeetNoSingularity) {
  int steps = 0;
  for (int arm = 0; arm < 3; ++arm) {
    const SerialChain chain = arms_.make(GetParam());
    const std::optional<ParallelPlan> plan = ParallelPlan::compile(chain);
    ASSERT_TRUE(plan.has_value());
    for (int path = 0; path < 10; ++path) {
      VectorX q = randomTurns(maker_);
      const VectorX velocity = 0.02 * Vector6::NullaryExpr([&](Eigen::Index) { return maker_.uniform(-1, 1); });
      std::array<int, 3> before{};
      double determinant_before = 0.0;
      for (int step = 0; step < 100; ++step, q += velocity) {
        Matrix6X J(6, 6);
        geometricJacobian(chain, q, J);
        const double determinant = Matrix6(J).determinant();
        const Pose target = forwardKinematics(chain, q);
        ParallelSolutions solutions;
        plan->solve(target, q.data(), solutions);
        std::array<int, 3> signs{};
        for (const PlanSolution& solution : solutions) {
          if (difference(Eigen::Map<const Vector6>(solution.q.data()), q) < 1e-6) signs = solution.sign;
        }
        EXPECT_EQ(signs, plan->signsAt(target, q.data()));
        // One sign changes at a singularity of its own, which turns the determinant's sign.
        if (step > 0) {
          const int product = signs[0] * signs[1] * signs[2] * before[0] * before[1] * before[2];
          EXPECT_EQ(product > 0, determinant * determinant_before > 0.0) << q.transpose();
          steps += 1;
        }
        before = signs;
        determinant_before = determinant;
      }
    }
  }
  EXPECT_GT(steps, 1000);
}

INSTANTIATE_TEST_SUITE_P(Structures, IkParallel, testing::Range(0, test::ParallelArmMaker::kStructures));

TEST(IkParallelArm, TellsALoopOnceWithItsFolds) {
  const SerialChain chain = test::parallelArm().chain();
  const InverseKinematics ik(chain, Task());
  test::ArmMaker maker(kSeed);
  for (int trial = 0; trial < 50; ++trial) {
    VectorX q = randomTurns(maker);
    q[4] = 0.0;
    IkRequest request;
    request.target = forwardKinematics(chain, q);
    request.seed = q;
    const IkResult result = ik.solve(request);
    expectLawful(ik, result, request.target);
    int loops = 0;
    for (const IkAnswer& answer : result.solutions) {
      if (answer.self_motion.rows() == 0) continue;
      ++loops;
      Matrix6X J(6, 6);
      geometricJacobian(chain, answer.position, J);
      EXPECT_LE((J * answer.self_motion.transpose()).norm(), 1e-6);
      EXPECT_EQ(answer.free_joints, (std::vector<int>{1, 2, 3, 5}));
    }
    EXPECT_GE(loops, 1);
    EXPECT_LE(loops, 2);
    EXPECT_LE((result.solutions.front().position - q).norm(), 1e-9);
  }
}

TEST(IkParallelArm, LawsCanFail) {
  const SerialChain chain = test::parallelArm().chain();
  const InverseKinematics ik(chain, Task());
  test::ArmMaker maker(kSeed + 1);
  const VectorX q = randomTurns(maker);
  IkRequest request;
  request.target = forwardKinematics(chain, q);
  IkResult result = ik.solve(request);
  ASSERT_TRUE(isListed(chain, request.target, result, q));
  for (std::size_t i = 0; i < result.solutions.size(); ++i) {
    if (difference(result.solutions[i].position, q) > 1e-6) continue;
    result.solutions.erase(result.solutions.begin() + static_cast<std::ptrdiff_t>(i));
    break;
  }
  EXPECT_FALSE(isListed(chain, request.target, result, q));
}

}  // namespace
}  // namespace screwline
