#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "published_arms.h"
#include "screwline/ik/closed_form/plan.h"
#include "screwline/ik/numerical/continued_solver.h"
#include "screwline/ik/numerical/ideal_geometry.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/model/structure.h"

namespace screwline {
namespace {

using test::PublishedArm;

/// Poses per arm: SCREWLINE_POSES for a longer run than the usual one.
int poses(int usual) {
  const char* wish = std::getenv("SCREWLINE_POSES");
  return wish == nullptr ? usual : std::atoi(wish);
}

IdealSolver solverOf(const ClosedFormPlan& plan, int joints) {
  return [plan, joints](const Pose& target, const VectorX& preferred) {
    PlanSolutions found;
    plan.solve(target, preferred.data(), found);
    std::vector<IdealSolution> solutions;
    for (const PlanSolution& solution : found) {
      IdealSolution ideal;
      ideal.q = Eigen::Map<const VectorX>(solution.q.data(), joints);
      ideal.branch = plan.branchName(solution);
      for (int i = 0; i < joints; ++i) {
        if ((solution.free >> i & 1U) != 0U) ideal.free.push_back(i);
      }
      solutions.push_back(ideal);
    }
    return solutions;
  };
}

double largestDifference(const VectorX& a, const VectorX& b) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < a.size(); ++i)
    largest = std::max(largest, std::abs(std::remainder(a[i] - b[i], kTwoPi)));
  return largest;
}

struct Imperfect {
  std::string name;
  SerialChain chain;
};

/// Every joint of a six-joint arm misplaced, or pi written down with few digits.
std::vector<Imperfect> imperfect(const PublishedArm& arm, unsigned seed) {
  std::vector<Imperfect> arms;
  arms.push_back({"0.2 mrad, 0.2 mm", chainOf(arm, test::calibrationErrors(seed, 2e-4, 2e-4))});
  arms.push_back({"0.5 mrad, 0.5 mm", chainOf(arm, test::calibrationErrors(seed + 1, 5e-4, 5e-4))});
  arms.push_back({"pi = 3.1416", chainOf(test::withRoundedPi(arm, 3.1416))});
  arms.push_back({"pi = 3.14", chainOf(test::withRoundedPi(arm, 3.14))});
  return arms;
}

std::vector<PublishedArm> sixJointArms() {
  // Of the arms with seven joints, what a fixed joint leaves.
  return {test::puma560(), test::kr6(), test::ur5()};
}

constexpr double kOnContinuum = 1e-10;  // Least singular value.

struct Tally {
  int lost = 0;
  int lost_on_continuum = 0;
  int incomplete = 0;
  int incomplete_near_singular = 0;
  int wrong = 0;
  int fewer = 0;
  int vanished = 0;
  int appeared = 0;
};

/// Configurations of all kinds: anywhere, and within 1e-12 to 0.1 of singular ones.
VectorX configuration(int size, std::mt19937& random, int k) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  VectorX q(size);
  for (int i = 0; i < size; ++i) q[i] = kPi * unit(random);
  const double small = std::pow(10.0, -6.5 + 5.5 * unit(random)) * unit(random);
  if (k % 4 == 1) q[4] = small;
  if (k % 4 == 2) q[2] = small + (k % 8 == 2 ? 0.0 : -0.5 * kPi);
  if (k % 16 == 3) q[4] = q[2] = small;
  return q;
}

void everyBranch(const std::string& name, const SerialChain& chain, int count, unsigned seed) {
  const std::optional<IdealGeometry> ideal = idealized(chain);
  ASSERT_TRUE(ideal) << name;
  EXPECT_LT(ideal->largest_turn, 1e-2) << name;
  EXPECT_LT(ideal->largest_move, 1e-2) << name;
  EXPECT_TRUE(isApprox(ideal->chain.home(), chain.home(), 0.0));
  const std::optional<ClosedFormPlan> plan = ClosedFormPlan::compile(ideal->chain, Task());
  if (!plan) {
    std::printf("%s: no closed form of the ideal chain, not tried\n", name.c_str());
    return;
  }
  const ContinuedSolver solver(chain, ideal->chain, Task(), solverOf(*plan, chain.size()));
  std::mt19937 random(seed);
  Tally tally;
  for (int k = 0; k < count; ++k) {
    const VectorX q = configuration(chain.size(), random, k);
    const Pose target = forwardKinematics(chain, q);
    // Of a continuum one member is given, next to the preferred one.
    const ContinuedSolutions found = solver.solve(target, q, 10.0);
    double nearest = 10.0;
    for (const ContinuedSolution& solution : found.solutions) {
      nearest = std::min(nearest, largestDifference(solution.q, q));
      const TaskError error = taskError(Task(), target, forwardKinematics(chain, solution.q));
      if (!(error.position < 1e-9 && error.orientation < 1e-9)) ++tally.wrong;
    }
    // Next to a singularity a solution is known to rounding over the least singular value only.
    Matrix6X J;
    geometricJacobian(chain, q, J);
    const double least = singularValues(J).minCoeff();
    if (nearest > std::min(1e-6 + 2e-14 / least, 2e-3)) {
      EXPECT_TRUE(least >= kOnContinuum || !found.complete) << name << ", pose " << k;
      ++(least < kOnContinuum ? tally.lost_on_continuum : tally.lost);
      std::printf("  lost: pose %d (q3 %g, q5 %g), nearest %g, %zu solutions, complete %d\n", k, q[2], q[4], nearest,
                  found.solutions.size(), static_cast<int>(found.complete));
    }
    if (!found.complete) ++(k % 4 == 0 ? tally.incomplete : tally.incomplete_near_singular);
    if (static_cast<int>(found.solutions.size()) < found.ideal - found.vanished) ++tally.fewer;
    tally.vanished += found.vanished;
    tally.appeared += found.appeared;
  }
  std::printf(
      "%-36s seed %u: off by %.2f mm, %.2f mrad; of %d poses lost %d + %d, incomplete %d + %d; vanished %d, appeared "
      "%d\n",
      name.c_str(), seed, 1e3 * solver.positionDeviation(), 1e3 * solver.rotationDeviation(), count, tally.lost,
      tally.lost_on_continuum, tally.incomplete, tally.incomplete_near_singular, tally.vanished, tally.appeared);
  // Within rounding of a continuum of the true chain, or of two at once, a member stands for others.
  EXPECT_LE(tally.lost_on_continuum, 1 + count / 100) << name << ", seed " << seed;
  EXPECT_EQ(tally.lost, 0) << name << ", seed " << seed;
  EXPECT_EQ(tally.wrong, 0) << name;
  EXPECT_EQ(tally.fewer, 0) << name;
}

TEST(IkNearlyIdeal, GeometryIsThatOfTheNominalArm) {
  unsigned seed = 21;
  for (const PublishedArm& arm : {test::puma560(), test::kr6(), test::ur5(), test::panda(), test::iiwa14()}) {
    const SerialChain exact = chainOf(arm);
    EXPECT_FALSE(idealized(exact)) << arm.name;
    const Structure nominal = structureOf(exact);
    for (const Imperfect& one : imperfect(arm, ++seed)) {
      const std::optional<IdealGeometry> ideal = idealized(one.chain);
      ASSERT_TRUE(ideal) << arm.name << ", " << one.name;
      const Structure structure = structureOf(ideal->chain);
      ASSERT_EQ(structure.spherical.size(), nominal.spherical.size()) << arm.name << ", " << one.name;
      for (std::size_t i = 0; i < nominal.spherical.size(); ++i)
        EXPECT_EQ(structure.spherical[i].first, nominal.spherical[i].first);
      ASSERT_EQ(structure.parallel.size(), nominal.parallel.size()) << arm.name << ", " << one.name;
      for (std::size_t i = 0; i < nominal.parallel.size(); ++i)
        EXPECT_EQ(structure.parallel[i].axes, nominal.parallel[i].axes);
      for (std::size_t i = 0; i < nominal.neighbours.size(); ++i) {
        EXPECT_EQ(structure.neighbours[i].orthogonal, nominal.neighbours[i].orthogonal);
        EXPECT_EQ(structure.neighbours[i].intersecting, nominal.neighbours[i].intersecting);
      }
    }
  }
}

TEST(IkNearlyIdeal, NothingIsMeantToBeSpecialInAGeneralArm) {
  const SerialChain chain = chainOf(test::general6());
  EXPECT_FALSE(idealized(chain));
}

TEST(IkNearlyIdeal, EveryBranchOfSixJoints) {
  unsigned seed = 1;
  for (const PublishedArm& arm : sixJointArms()) {
    for (const Imperfect& one : imperfect(arm, 2 * seed))
      everyBranch(arm.name + ", " + one.name, one.chain, poses(60), seed);
    ++seed;
  }
}

TEST(IkNearlyIdeal, EveryBranchOfSevenJointsOneFixed) {
  unsigned seed = 11;
  for (const PublishedArm& arm : {test::panda(), test::iiwa14()}) {
    for (const Imperfect& one : imperfect(arm, 2 * seed)) {
      everyBranch(arm.name + ", q7 fixed, " + one.name, withFixedJoint(one.chain, 6, 0.7), poses(60), seed);
    }
    ++seed;
  }
}

}  // namespace
}  // namespace screwline
