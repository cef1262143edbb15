#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <string>

#include "algebraic_arms.h"
#include "algebraic_laws.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/model/urdf_reader.h"
#include "screwline/spatial/svd.h"

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261124;

using test::difference;
using test::expectLawful;
using test::nearest;
using test::randomConfiguration;
using test::singularConfiguration;
using test::valuesOf;

/// The generating configuration is among the solutions of random poses, and the list says it is complete.
void expectReproduced(const SerialChain& chain, test::ArmMaker& maker, int poses, const std::string& name) {
  SCOPED_TRACE(name + ", seed " + std::to_string(kSeed));
  const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
  ASSERT_TRUE(solver.has_value());
  AlgebraicSolutions solutions;
  int incomplete = 0;
  for (int i = 0; i < poses; ++i) {
    const VectorX q = randomConfiguration(maker, chain);
    const Pose target = forwardKinematics(chain, q);
    solver->solve(target, solutions);
    expectLawful(chain, target, solutions);
    EXPECT_LE(nearest(chain, solutions, q), 1e-6) << "q = " << q.transpose();
    incomplete += solutions.complete ? 0 : 1;
  }
  EXPECT_LE(incomplete, poses / 100);
}

/// As many as a search with many starts finds, on a few poses.
void expectCounted(const SerialChain& chain, test::ArmMaker& maker, int poses, const std::string& name) {
  SCOPED_TRACE(name + ", seed " + std::to_string(kSeed));
  const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
  ASSERT_TRUE(solver.has_value());
  SearchOptions options;
  options.restarts = 600;
  options.timeout = 60.0;
  AlgebraicSolutions solutions;
  for (int i = 0; i < poses; ++i) {
    const Pose target = forwardKinematics(chain, randomConfiguration(maker, chain));
    solver->solve(target, solutions);
    const SearchResult searched = search(chain, Task(), target, {}, options);
    EXPECT_GE(solutions.count, static_cast<int>(searched.solutions.size()));
    for (const VectorX& q : searched.solutions) EXPECT_LE(nearest(chain, solutions, q), 1e-5);
  }
}

TEST(IkAlgebraic, FindsTheGeneratingConfigurationOfGeneralArms) {
  test::ArmMaker maker(kSeed);
  for (int i = 0; i < 40; ++i) expectReproduced(test::generalArm(maker, -1), maker, 100, "6R " + std::to_string(i));
}

TEST(IkAlgebraic, FindsTheGeneratingConfigurationWithASlideAnywhere) {
  test::ArmMaker maker(kSeed + 1);
  for (int i = 0; i < 24; ++i)
    expectReproduced(test::generalArm(maker, i % 6), maker, 60, "slide " + std::to_string(i));
}

TEST(IkAlgebraic, FindsTheGeneratingConfigurationWithTwoOrThreeSlides) {
  test::ArmMaker maker(kSeed + 11);
  for (int slides = 0; slides < 64; ++slides) {
    std::vector<Axis> axes;
    int count = 0;
    for (int i = 0; i < 6; ++i) {
      axes.push_back(test::ArmMaker::turn(maker.direction(), maker.vector(0.6)));
      axes.back().prismatic = ((slides >> i) & 1) != 0;
      count += axes.back().prismatic ? 1 : 0;
    }
    if (count != 2 && count != 3) continue;
    expectReproduced(test::ArmMaker::chain(axes, maker.pose(), maker.pose()), maker, 100,
                     "slides " + std::to_string(slides));
  }
}

TEST(IkAlgebraic, ServesArmsOfSpecialGeometry) {
  test::ArmMaker maker(kSeed + 2);
  for (const test::AlgebraicArm& arm :
       {test::sixteenArm(), test::offsetWristArm(), test::bentWristArm(), test::parallelArm()}) {
    expectReproduced(arm.chain(), maker, 500, arm.name);
  }
  for (double size : {1e-9, 1e-6, 1e-4, 1e-2}) {
    expectReproduced(test::perturbed(test::parallelArm().chain(), size, kSeed), maker, 300,
                     "three almost parallel axes, " + std::to_string(std::log10(size)));
  }
}

TEST(IkAlgebraic, FindsAsManyAsASearch) {
  test::ArmMaker maker(kSeed + 3);
  expectCounted(test::generalArm(maker, -1), maker, 6, "general");
  expectCounted(test::generalArm(maker, 3), maker, 4, "slide");
  expectCounted(test::offsetWristArm().chain(), maker, 4, "offset wrist");
  expectCounted(test::bentWristArm().chain(), maker, 4, "bent wrist");
}

TEST(IkAlgebraic, FindsSixteen) {
  const SerialChain chain = test::sixteenArm().chain();
  const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
  ASSERT_TRUE(solver.has_value());
  test::ArmMaker maker(kSeed + 4);
  AlgebraicSolutions solutions;
  Pose target;
  for (int i = 0; i < 100 && solutions.count < 16; ++i) {
    target = forwardKinematics(chain, randomConfiguration(maker, chain));
    solver->solve(target, solutions);
  }
  ASSERT_EQ(solutions.count, 16);
  EXPECT_TRUE(solutions.complete);
  expectLawful(chain, target, solutions);
  SearchOptions options;
  options.restarts = 3000;
  options.timeout = 60.0;
  options.max_solutions = 16;
  EXPECT_EQ(search(chain, Task(), target, {}, options).solutions.size(), 16u);
}

TEST(IkAlgebraic, HoldsAtAndNearSingularities) {
  test::ArmMaker maker(kSeed + 5);
  AlgebraicSolutions solutions;
  for (int arm = 0; arm < 20; ++arm) {
    const SerialChain chain = test::generalArm(maker, arm % 2 == 0 ? -1 : arm % 6);
    const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
    ASSERT_TRUE(solver.has_value());
    for (double offset : {0.0, 1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
      SCOPED_TRACE("arm " + std::to_string(arm) + ", offset " + std::to_string(offset));
      VectorX q = singularConfiguration(chain, maker);
      for (int i = 0; i < 6; ++i) q[i] += offset * maker.uniform(-1, 1);
      const Pose target = forwardKinematics(chain, q);
      solver->solve(target, solutions);
      expectLawful(chain, target, solutions);
      // At a double root an error of the pose is worth its square root.
      EXPECT_LE(nearest(chain, solutions, q), 2e-6);
    }
  }
}

/// Two pairs of solutions, 1.3e-4 and 3.9e-4 apart, whose hidden angles differ by less than the noise of the eliminant
/// tells: between the two, Newton's method stops where the residual is flat.
TEST(IkAlgebraic, TellsSolutionsThatAreAboutToMeet) {
  const SerialChain chain = readUrdfFile(std::string(SCREWLINE_SOURCE_DIR) + "/urdf/six_r_16.urdf");
  const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
  ASSERT_TRUE(solver.has_value());
  const std::array<Vector6, 2> places = {(Vector6() << -2.1470275851571299, -1.2726439557133999, -1.8498524996316759,
                                          2.5682555231170276, -0.23511547562325275, 0.25144738710381409)
                                             .finished(),
                                         (Vector6() << 1.2281882279513008, 1.7178994484292636, 1.436450535745629,
                                          2.4915715656864261, 1.0799711376761376, 2.986354803907334)
                                             .finished()};
  for (const Vector6& q : places) {
    const Pose target = forwardKinematics(chain, q);
    AlgebraicSolutions solutions;
    solver->solve(target, solutions);
    expectLawful(chain, target, solutions);
    EXPECT_TRUE(solutions.complete);
    EXPECT_EQ(solutions.count, 8) << q.transpose();
    EXPECT_LE(nearest(chain, solutions, q), 1e-6) << q.transpose();
  }
}

TEST(IkAlgebraic, FindsHalfTurns) {
  test::ArmMaker maker(kSeed + 6);
  const SerialChain chain = test::generalArm(maker, -1);
  const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
  ASSERT_TRUE(solver.has_value());
  AlgebraicSolutions solutions;
  for (int i = 0; i < 64; ++i) {
    VectorX q(6);
    for (int k = 0; k < 6; ++k) q[k] = ((i >> k) & 1) == 0 ? 0.0 : kPi;
    solver->solve(forwardKinematics(chain, q), solutions);
    EXPECT_LE(nearest(chain, solutions, q), 1e-6) << q.transpose();
  }
}

TEST(IkAlgebraic, TellsASelfMotion) {
  const SerialChain chain = test::parallelArm().chain();
  const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
  ASSERT_TRUE(solver.has_value());
  test::ArmMaker maker(kSeed + 7);
  AlgebraicSolutions solutions;
  for (int i = 0; i < 20; ++i) {
    VectorX q = randomConfiguration(maker, chain);
    q[4] = 0.0;  // Axes 2, 3, 4 and 6 are parallel: a four-bar moves.
    const Pose target = forwardKinematics(chain, q);
    solver->solve(target, solutions);
    expectLawful(chain, target, solutions);
    EXPECT_TRUE(solutions.degenerate);
    EXPECT_FALSE(solutions.complete);
  }
}

/// Arms on a lattice at multiples of right angles: several regular solutions share the hidden angle, or nearly all
/// angles, whichever joint is hidden.
TEST(IkAlgebraic, CallsNothingCompleteWhereSolutionsShareTheirAngles) {
  test::ArmMaker maker(kSeed + 12);
  AlgebraicSolutions solutions;
  int asked = 0;
  int complete = 0;
  int lost = 0;
  for (int arm = 0; arm < 150; ++arm) {
    std::vector<Axis> axes;
    Axis axis;
    for (int i = 0; i < 6; ++i) axes.push_back(axis = test::latticeAxis(maker, axis));
    if (arm % 3 == 0) axes[static_cast<std::size_t>(maker.index(6))].prismatic = true;
    const SerialChain chain = test::ArmMaker::chain(axes, maker.pose(), Pose());
    const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
    for (int i = 0; solver && i < 12; ++i) {
      VectorX q = test::latticeConfiguration(maker, chain);
      if (i % 3 == 0) q[maker.index(6)] = maker.uniform(-3.1, 3.1);
      if (singularValues(taskJacobian(chain, q, Task())).minCoeff() < 1e-3) continue;
      const Pose target = forwardKinematics(chain, q);
      solver->solve(target, solutions);
      expectLawful(chain, target, solutions);
      const bool missing = nearest(chain, solutions, q) > 1e-6;
      EXPECT_FALSE(missing && solutions.complete) << "arm " << arm << ", seed " << kSeed << ", q = " << q.transpose();
      ++asked;
      complete += solutions.complete ? 1 : 0;
      lost += missing ? 1 : 0;
    }
  }
  std::printf("%d regular poses, %d complete, %d lost\n", asked, complete, lost);
  EXPECT_GT(complete, asked * 6 / 10);
  EXPECT_LT(lost, asked / 30);
}

TEST(IkAlgebraic, IsDeterministic) {
  test::ArmMaker maker(kSeed + 8);
  const SerialChain chain = test::generalArm(maker, -1);
  const std::optional<AlgebraicSolver> first = AlgebraicSolver::compile(chain);
  const std::optional<AlgebraicSolver> second = AlgebraicSolver::compile(chain);
  ASSERT_TRUE(first.has_value() && second.has_value());
  EXPECT_EQ(first->method(), second->method());
  for (int i = 0; i < 50; ++i) {
    const Pose target = forwardKinematics(chain, randomConfiguration(maker, chain));
    AlgebraicSolutions a;
    AlgebraicSolutions b;
    first->solve(target, a);
    second->solve(target, b);
    ASSERT_EQ(a.count, b.count);
    EXPECT_EQ(std::memcmp(a.q.data(), b.q.data(), sizeof(a.q)), 0);
  }
}

TEST(IkAlgebraic, RefusesWhatItDoesNotServe) {
  test::ArmMaker maker(kSeed + 9);
  std::vector<Axis> axes;
  for (int i = 0; i < 6; ++i) axes.push_back(test::ArmMaker::turn(maker.direction(), maker.vector(0.6)));
  std::vector<Axis> five(axes.begin(), axes.begin() + 5);
  EXPECT_FALSE(AlgebraicSolver::compile(test::ArmMaker::chain(five, Pose(), Pose())).has_value());
  std::vector<Axis> slides = axes;
  slides[0].prismatic = slides[1].prismatic = slides[3].prismatic = slides[4].prismatic = true;
  EXPECT_FALSE(AlgebraicSolver::compile(test::ArmMaker::chain(slides, Pose(), Pose())).has_value());
  for (Axis& axis : axes) axis.direction = Vector3::UnitZ();
  EXPECT_FALSE(AlgebraicSolver::compile(test::ArmMaker::chain(axes, Pose(), Pose())).has_value());
}

TEST(IkAlgebraic, LawsCanFail) {
  test::ArmMaker maker(kSeed + 10);
  const SerialChain chain = test::generalArm(maker, -1);
  const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
  ASSERT_TRUE(solver.has_value());
  const VectorX q = randomConfiguration(maker, chain);
  Pose moved = forwardKinematics(chain, q);
  moved.p.x() += 1e-4;
  AlgebraicSolutions solutions;
  solver->solve(moved, solutions);
  EXPECT_GT(nearest(chain, solutions, q), 1e-6);
}

}  // namespace
}  // namespace screwline
