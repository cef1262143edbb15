#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "../../src/ik/parallel_candidates.h"
#include "algebraic_arms.h"
#include "ik_gate.h"
#include "parallel_arms.h"
#include "screwline/ik/algebraic/algebraic_solver.h"
#include "screwline/ik/closed_form/parallel_plan.h"
#include "screwline/ik/inverse_kinematics.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/spatial/screw.h"
#include "screwline/spatial/svd.h"
#include "shipped_robots.h"
#include "singular_poses.h"
#include "singular_search.h"

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261125;
constexpr double kRounding = 1e-14;  // [m, rad] of forward kinematics.
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

/// Newton steps that leave directions of almost no gain alone. False where they do not lead to a solution to 1e-11.
bool correct(const SerialChain& chain, const Pose& target, VectorX& q) {
  Matrix6X J(6, 6);
  for (int i = 0; i < 12; ++i) {
    const Vector6 error = poseDifference(target, geometricJacobian(chain, q, J));
    if (error.norm() <= 1e-11) return true;
    Svd svd(J, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(1e-7);
    q += svd.solve(error);
  }
  return false;
}

/// The direction that moves the tip least, on the side of `before`; zero where even that moves it.
VectorX stillDirection(const SerialChain& chain, const VectorX& q, const VectorX& before) {
  Matrix6X J(6, 6);
  geometricJacobian(chain, q, J);
  const Svd svd(J, Eigen::ComputeFullV);
  if (svd.singularValues()[5] > 1e-6) return VectorX::Zero(6);
  const VectorX direction = svd.matrixV().col(5);
  return direction.dot(before) < 0.0 ? VectorX(-direction) : direction;
}

/// Whether configurations that solve the pose to 1e-11 lead from one solution to the other: then they are of one
/// continuum, or so near to one that the pose's rounding does not tell them apart.
bool areJoined(const SerialChain& chain, const Pose& target, const VectorX& from, const VectorX& to) {
  constexpr double kStep = 0.02;
  for (const double side : {1.0, -1.0}) {
    VectorX q = from;
    VectorX direction = stillDirection(chain, q, VectorX::Zero(6)) * side;
    for (int i = 0; i < 1500 && direction.norm() > 0.5; ++i) {
      VectorX way(6);
      for (int k = 0; k < 6; ++k) way[k] = std::remainder(to[k] - q[k], kTwoPi);
      // In line with the way there, and correctable all along it.
      if (way.norm() <= 2.0 * kStep) {
        VectorX middle = q + 0.5 * way;
        const VectorX guess = middle;
        if (correct(chain, target, middle) && (middle - guess).norm() <= 0.3 * way.norm() + 1e-6) return true;
      }
      q += kStep * direction;
      if (!correct(chain, target, q)) break;
      direction = stillDirection(chain, q, direction);
    }
  }
  return false;
}

/// Whether a solution that another method found is in the list: itself, on a continuum, or not to be told from one.
bool isListed(const SerialChain& chain, const Pose& target, const IkResult& result, const VectorX& q) {
  return std::any_of(result.solutions.begin(), result.solutions.end(), [&](const IkAnswer& answer) {
    return difference(answer.position, q) <= 2e-6 || areJoined(chain, target, answer.position, q);
  });
}

void expectLawful(const InverseKinematics& ik, const IkResult& result, const Pose& target) {
  // At two conditions at once the pose may be met to rounding all along a curve.
  EXPECT_TRUE(result.complete || result.message.find("rounding hides") != std::string::npos) << result.message;
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
  int compared = 0;
  for (int arm = 0; arm < 2; ++arm) {
    const SerialChain chain = arms_.make(GetParam());
    const InverseKinematics ik(chain, Task());
    const std::optional<AlgebraicSolver> algebraic = AlgebraicSolver::compile(chain);
    ASSERT_TRUE(algebraic.has_value());
    for (double offset : kOffsets) {
      for (int trial = 0; trial < 5; ++trial) {
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
          // Elimination stops at 1e-11: beside a continuum that far off it takes any point near it for a solution.
          if (taskError(Task(), request.target, forwardKinematics(chain, other)).norm() > kRounding) continue;
          ++compared;
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
  EXPECT_GT(compared, 50);
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
      const VectorX velocity = 0.02 / kPi * randomTurns(maker_);
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

/// At and beside singular poses the closed form alone decides what there is: elimination has nothing to add.
TEST_P(IkParallel, LeavesNoDoubtToEliminationAtAndBesideSingularPoses) {
  const SerialChain chain = arms_.make(GetParam());
  const InverseKinematics ik(chain, Task());
  std::optional<ParallelMethod> method = parallelMethodFor(chain, Task());
  ASSERT_TRUE(method.has_value());
  method->algebraic.reset();
  test::SingularPoses poses(chain, kSeed);
  int asked = 0;
  for (const test::SingularKind& kind : test::singularKindsOf(chain, Task())) {
    for (double offset : kOffsets) {
      const std::optional<VectorX> q = poses.make(kind, offset);
      if (!q) continue;
      SCOPED_TRACE(kind.name + ", offset " + std::to_string(std::log10(offset)) + ", seed " + std::to_string(kSeed));
      const test::GateVerdict verdict = test::IkGate(ik, *q, true).judge(VectorX::LinSpaced(6, 8e-4, -5e-4));
      EXPECT_TRUE(verdict.isLawful()) << verdict.message << " q = " << q->transpose();
      const Pose target = forwardKinematics(chain, *q);
      EXPECT_TRUE(candidatesOf(*method, chain, target, VectorX::Zero(6), false).complete) << "q = " << q->transpose();
      ++asked;
    }
  }
  EXPECT_GT(asked, 30);
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

/// Where a height is almost not reached and the arm almost straight, errors between solutions are small: 1e-9 is met in
/// places that are none.
TEST(IkParallelArm, NoRowStandsBetweenSolutions) {
  for (const char* name : {"ur5", "ur10e"}) {
    const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, name);
    const InverseKinematics ik(robot.chain, robot.task);
    test::SingularPoses poses(robot.chain, kSeed);
    for (const test::SingularKind& kind : test::singularKindsOf(robot.chain, robot.task)) {
      if (kind.ways.size() < 2) continue;
      for (double offset : kOffsets) {
        const std::optional<VectorX> q = poses.make(kind, offset);
        if (!q) continue;
        for (const IkAnswer& answer : ik.solve(test::IkGate(ik, *q, true).request()).solutions) {
          EXPECT_LE(std::max(answer.position_error, answer.orientation_error), 1e-12)
              << name << ", " << kind.name << " + " << offset << ", q = " << q->transpose();
        }
      }
    }
  }
}

/// Where the first axis's turn is a double root, known to 3e-8, and the wrist aligned to less than that, no turn of the
/// wrist's is known at all: the pose does not tell solutions from a continuum.
TEST(IkParallelArm, ListsOfTurnsThatAreHardlyKnownAreNotCalledComplete) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "ur5");
  const InverseKinematics ik(robot.chain, robot.task);
  test::SingularPoses poses(robot.chain, kSeed);
  int asked = 0;
  for (const test::SingularKind& kind : test::singularKindsOf(robot.chain, robot.task)) {
    if (kind.name != "shoulder + wrist") continue;
    for (double offset : {1e-12, 1e-11, 1e-10, 1e-9}) {
      for (int trial = 0; trial < 5; ++trial) {
        const std::optional<VectorX> q = poses.make(kind, offset);
        if (!q) continue;
        ++asked;
        const IkResult result = ik.solve(test::IkGate(ik, *q, true).request());
        EXPECT_FALSE(result.complete) << offset << ", q = " << q->transpose();
        EXPECT_NE(result.message.find("rounding hides"), std::string::npos) << result.message;
      }
    }
  }
  EXPECT_EQ(asked, 20);
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
