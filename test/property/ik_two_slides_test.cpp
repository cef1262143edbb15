// Laws of chains with four turns and two slides in any order: general geometry, and pairs of axes in special positions.

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cstdio>

#include "algebraic_arms.h"
#include "algebraic_laws.h"
#include "ik_gate.h"
#include "screwline/ik/numerical/numerical_solver.h"

namespace screwline {
namespace {

using test::expectLawful;
using test::nearest;
using test::randomConfiguration;
using test::singularConfiguration;

constexpr unsigned kSeed = 20261128;

enum class Geometry { kGeneral, kSpecialPairs, kLattice };
constexpr Geometry kGeometries[] = {Geometry::kGeneral, Geometry::kSpecialPairs, Geometry::kLattice};

/// Sets of two places of six.
std::vector<std::array<int, 2>> placesOfSlides() {
  std::vector<std::array<int, 2>> places;
  for (int i = 0; i < 6; ++i) {
    for (int k = i + 1; k < 6; ++k) places.push_back({i, k});
  }
  return places;
}

/// An axis behind another: parallel to it, at a right angle, meeting it, or several of these.
Axis specialAxis(test::ArmMaker& maker, const Axis& before) {
  const Vector3 across = before.direction.cross(maker.direction());
  const Vector3 beside = before.point + maker.vector(0.5);
  const Vector3 on = before.point + maker.uniform(-0.5, 0.5) * before.direction;
  switch (maker.index(5)) {
    case 0:
      return test::ArmMaker::turn(maker.sign() * before.direction, beside);
    case 1:
      return test::ArmMaker::turn(across, beside);
    case 2:
      return test::ArmMaker::turn(across, on);
    case 3:
      return test::ArmMaker::turn(maker.direction(), on);
    default:
      return test::ArmMaker::turn(maker.direction(), beside);
  }
}

SerialChain makeChain(test::ArmMaker& maker, Geometry geometry, const std::array<int, 2>& slides) {
  std::vector<Axis> axes;
  Axis axis;
  for (int i = 0; i < 6; ++i) {
    axis = geometry == Geometry::kGeneral        ? test::ArmMaker::turn(maker.direction(), maker.vector(0.6))
           : geometry == Geometry::kSpecialPairs ? specialAxis(maker, axis)
                                                 : test::latticeAxis(maker, axis);
    axes.push_back(axis);
    axes.back().prismatic = i == slides[0] || i == slides[1];
  }
  return test::ArmMaker::chain(axes, maker.pose(), maker.pose());
}

/// Whether some configuration moves the tip in all six dimensions.
bool isRegularSomewhere(const SerialChain& chain, test::ArmMaker& maker) {
  for (int i = 0; i < 10; ++i) {
    Matrix6X J;
    geometricJacobian(chain, randomConfiguration(maker, chain), J);
    const Eigen::JacobiSVD<Matrix6> svd(J);
    if (svd.singularValues()[5] > 1e-9 * svd.singularValues()[0]) return true;
  }
  return false;
}

/// Every chain that is not singular everywhere, of each order and geometry. All make() the same for the same seed.
template <class Visitor>
void forEveryChain(unsigned seed, int count, Visitor&& visit) {
  test::ArmMaker maker(seed);
  for (const Geometry geometry : kGeometries) {
    for (const std::array<int, 2>& slides : placesOfSlides()) {
      for (int i = 0; i < count; ++i) {
        const SerialChain chain = makeChain(maker, geometry, slides);
        SCOPED_TRACE("geometry " + std::to_string(static_cast<int>(geometry)) + ", slides " +
                     std::to_string(slides[0] + 1) + " and " + std::to_string(slides[1] + 1) + ", chain " +
                     std::to_string(i) + ", seed " + std::to_string(seed));
        const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
        ASSERT_EQ(solver.has_value(), isRegularSomewhere(chain, maker));
        if (solver) visit(chain, *solver, maker);
      }
    }
  }
}

TEST(IkTwoSlides, EveryOrderAndGeometryGivesBackTheGeneratingConfiguration) {
  int poses = 0;
  int incomplete = 0;
  forEveryChain(kSeed, 12, [&](const SerialChain& chain, const AlgebraicSolver& solver, test::ArmMaker& maker) {
    AlgebraicSolutions solutions;
    for (int i = 0; i < 20; ++i) {
      const VectorX q = randomConfiguration(maker, chain);
      const Pose target = forwardKinematics(chain, q);
      solver.solve(target, solutions);
      expectLawful(chain, target, solutions);
      EXPECT_LE(nearest(chain, solutions, q), 1e-6) << "q = " << q.transpose();
      EXPECT_LE(solutions.count, 8);
      ++poses;
      incomplete += solutions.complete ? 0 : 1;
    }
  });
  std::printf("%d poses, %d lists not called complete\n", poses, incomplete);
  EXPECT_GT(poses, 5000);
  EXPECT_LE(incomplete, poses / 500);
}

TEST(IkTwoSlides, FindsAllThatASearchFinds) {
  SearchOptions options;
  options.restarts = 150;
  options.timeout = 60.0;
  std::size_t searched_solutions = 0;
  int solved = 0;
  forEveryChain(kSeed + 1, 1, [&](const SerialChain& chain, const AlgebraicSolver& solver, test::ArmMaker& maker) {
    AlgebraicSolutions solutions;
    const Pose target = forwardKinematics(chain, randomConfiguration(maker, chain));
    solver.solve(target, solutions);
    const SearchResult searched = search(chain, Task(), target, {}, options);
    for (const VectorX& q : searched.solutions) EXPECT_LE(nearest(chain, solutions, q), 1e-5) << q.transpose();
    searched_solutions += searched.solutions.size();
    solved += solutions.count;
  });
  std::printf("%d solutions, a search finds %zu\n", solved, searched_solutions);
  // Few starts miss some; as many as most are found.
  EXPECT_GE(static_cast<int>(searched_solutions), solved * 8 / 10);
}

TEST(IkTwoSlides, HoldsAtAndNearSingularities) {
  forEveryChain(kSeed + 2, 1, [](const SerialChain& chain, const AlgebraicSolver& solver, test::ArmMaker& maker) {
    AlgebraicSolutions solutions;
    for (double offset : {0.0, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3}) {
      VectorX q = singularConfiguration(chain, maker);
      for (int i = 0; i < 6; ++i) q[i] += offset * maker.uniform(-1, 1);
      const Pose target = forwardKinematics(chain, q);
      solver.solve(target, solutions);
      expectLawful(chain, target, solutions);
      const double tolerance = 1e-6 + test::placeTolerance(chain, Task(), q);
      if (solutions.complete) {
        EXPECT_LE(nearest(chain, solutions, q), tolerance) << offset << ": " << q.transpose();
      }
    }
  });
}

/// Turns at and beside multiples of right angles bring the axes of such arms into line, in continua and beside them.
TEST(IkTwoSlides, CallsNothingCompleteThatIsNotWhereAxesAreInLine) {
  test::ArmMaker maker(kSeed + 3);
  int asked = 0;
  int complete = 0;
  for (const std::array<int, 2>& slides : placesOfSlides()) {
    for (double offset : {0.0, 1e-12, 1e-6, 1e-4, 1e-3}) {
      const SerialChain chain = makeChain(maker, Geometry::kLattice, slides);
      const InverseKinematics ik(chain, Task());
      if (!ik.complete()) continue;
      VectorX q = randomConfiguration(maker, chain);
      for (int i = 0; i < 6; ++i) {
        if (chain.joint(i).isRevolute() && maker.index(3) == 0)
          q[i] = 0.5 * kPi * maker.index(4) + offset * maker.uniform(-1, 1);
      }
      test::GateVerdict verdict = test::IkGate(ik, q, true).judge(VectorX::LinSpaced(6, 8e-4, -5e-4));
      verdict.worst_error *= std::sqrt(0.5);  // What is searched meets position and orientation to 1e-9 each.
      EXPECT_TRUE(verdict.isLawful()) << ik.method() << ", " << offset << "\n  " << verdict.message << "\n  lost "
                                      << verdict.lost << ", complete " << verdict.complete << ", worst error "
                                      << verdict.worst_error << "\n  q = " << q.transpose();
      ++asked;
      complete += verdict.complete ? 1 : 0;
    }
  }
  std::printf("%d poses, %d complete\n", asked, complete);
  EXPECT_GT(complete, asked / 2);
}

/// Where every turn is a multiple of a right angle several solutions share most of their angles, and axes are in line:
/// as many solutions as roots are all. Most other such poses are members of continua.
TEST(IkTwoSlides, SolutionsThatShareTheirAnglesAreCounted) {
  test::ArmMaker maker(kSeed + 6);
  AlgebraicSolutions solutions;
  int regular = 0;
  int complete = 0;
  for (const std::array<int, 2>& slides : placesOfSlides()) {
    for (int k = 0; k < 6; ++k) {
      const SerialChain chain = makeChain(maker, Geometry::kLattice, slides);
      const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
      for (int i = 0; solver && i < 20; ++i) {
        const VectorX q = test::latticeConfiguration(maker, chain);
        solver->solve(forwardKinematics(chain, q), solutions);
        EXPECT_FALSE(solutions.complete && nearest(chain, solutions, q) > 1e-6) << q.transpose();
        if (solutions.degenerate) continue;
        ++regular;
        complete += solutions.complete ? 1 : 0;
      }
    }
  }
  std::printf("%d poses not on continua, %d complete\n", regular, complete);
  EXPECT_GT(complete, regular * 7 / 10);
}

TEST(IkTwoSlides, ParallelSlidesAreRefused) {
  test::ArmMaker maker(kSeed + 4);
  std::vector<Axis> axes;
  for (int i = 0; i < 6; ++i) axes.push_back(test::ArmMaker::turn(maker.direction(), maker.vector(0.6)));
  axes[2].prismatic = axes[3].prismatic = true;
  axes[3].direction = -axes[2].direction;
  EXPECT_FALSE(AlgebraicSolver::compile(test::ArmMaker::chain(axes, maker.pose(), maker.pose())).has_value());
}

TEST(IkTwoSlides, LawsCanFail) {
  int seen = 0;
  int chains = 0;
  forEveryChain(kSeed + 5, 1, [&](const SerialChain& chain, const AlgebraicSolver& solver, test::ArmMaker& maker) {
    const VectorX q = randomConfiguration(maker, chain);
    Pose moved = forwardKinematics(chain, q);
    moved.p.x() += 1e-3;
    AlgebraicSolutions solutions;
    solver.solve(moved, solutions);
    ++chains;
    seen += nearest(chain, solutions, q) > 1e-6 ? 1 : 0;
  });
  EXPECT_EQ(seen, chains);
}

}  // namespace
}  // namespace screwline
