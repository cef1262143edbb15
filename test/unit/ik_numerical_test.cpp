#include "screwline/ik/numerical/numerical_solver.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <ctime>

#include "golden.h"
#include "ik_arms.h"

namespace screwline {
namespace {

using test::ArmMaker;

/// Planar chain of turns about z with links along x, tip at the end of the last.
SerialChain planar(const std::vector<double>& links, double lower = -kPi, double upper = kPi) {
  ChainDescription description;
  description.name = "planar";
  description.base_link = "base";
  description.tip_link = "tip";
  double x = 0.0;
  for (double link : links) {
    Axis axis = ArmMaker::turn(Vector3::UnitZ(), {x, 0.0, 0.0});
    axis.source = static_cast<int>(description.axes.size());
    description.axes.push_back(axis);
    Joint joint;
    joint.name = "joint" + std::to_string(axis.source + 1);
    joint.limits.lower = lower;
    joint.limits.upper = upper;
    description.joints.push_back(joint);
    x += link;
  }
  description.home.p.x() = x;
  description.links = {{"base", 0, {}}, {"tip", static_cast<int>(links.size()), description.home}};
  return SerialChain(description);
}

Pose at(double x, double y, double z = 0.0) {
  Pose X;
  X.p << x, y, z;
  return X;
}

const Task kPlane = Task::fromRows({0, 1});

bool contains(const std::vector<VectorX>& list, const SerialChain& chain, const VectorX& q) {
  for (const VectorX& member : list) {
    double largest = 0.0;
    for (int i = 0; i < chain.size(); ++i) {
      const double difference = member[i] - q[i];
      const bool turns = chain.joint(i).isRevolute();
      largest = std::max(largest, std::abs(turns ? std::remainder(difference, kTwoPi) : difference));
    }
    if (largest < 1e-6) return true;
  }
  return false;
}

TEST(IkNumerical, FindsTheGoldenSolutions) {
  int cases = 0;
  int solutions = 0;
  for (const std::string& name : golden::names()) {
    const golden::File& file = *golden::load(name);
    int sample = 0;
    for (const golden::Case& test : file.cases) {
      if (test.singular || test.ik.infinite || ++sample > 3) continue;
      SearchOptions options;
      options.restarts = 200;
      options.timeout = 10.0;
      const SearchResult result = search(file.chain, test.ik.task, test.pose, {}, options);
      for (const golden::IkAnswer& solution : test.ik.solutions) {
        EXPECT_TRUE(contains(result.solutions, file.chain, solution.q)) << name << " " << test.id;
      }
      EXPECT_EQ(result.solutions.size(), test.ik.solutions.size()) << name << " " << test.id;
      ++cases;
      solutions += static_cast<int>(test.ik.solutions.size());
    }
  }
  std::printf("%d golden cases, %d solutions\n", cases, solutions);
  EXPECT_GT(cases, 20);
}

TEST(IkNumerical, SolutionThatIsDoubleIsListedOnce) {
  for (const std::vector<double>& links : {std::vector<double>{0.7, 0.5}, std::vector<double>{0.5, 0.5}}) {
    const SerialChain chain = planar(links);
    const double reach = links[0] + links[1];
    for (double angle : {0.0, 0.3, 2.0}) {
      SearchOptions options;
      options.restarts = 100;
      const Pose target = at(reach * std::cos(angle), reach * std::sin(angle));
      const SearchResult result = search(chain, kPlane, target, {VectorX::Zero(2)}, options);
      EXPECT_EQ(result.solutions.size(), 1u) << angle;
    }
  }
}

TEST(IkNumerical, RootsThatAreNearEachOtherAreTwo) {
  const SerialChain chain = planar({0.7, 0.5});
  for (double bend : {1e-2, 1e-3, 1e-4, 1e-5}) {
    SearchOptions options;
    const VectorX q = (VectorX(2) << 0.3, bend).finished();
    const SearchResult result = search(chain, kPlane, forwardKinematics(chain, q), {q}, options);
    EXPECT_EQ(result.solutions.size(), 2u) << bend;
    EXPECT_NEAR(result.solutions.front()[1], bend, 1e-16 / (bend * bend) + 1e-10);
  }
}

TEST(IkNumerical, DescentLeavesASaddle) {
  // The arm is straight and the target on its line: the gradient is zero.
  const SerialChain chain = planar({0.7, 0.5});
  const DescentResult inwards = descend(chain, kPlane, at(0.9, 0.0), VectorX::Zero(2), {});
  EXPECT_TRUE(inwards.converged);
  const DescentResult behind = descend(chain, kPlane, at(-2.0, 0.0), VectorX::Zero(2), {});
  EXPECT_NEAR(behind.error.position, 0.8, 1e-12);
}

TEST(IkNumerical, JointsThatPressAgainstABoundAreLetGo) {
  // The way to the solution leads along the bound of the first joint and off it again.
  const SerialChain chain = planar({0.7, 0.5, 0.3}, -1.0, 1.0);
  for (double first : {-1.0, -0.4, 0.0, 0.8, 1.0}) {
    for (double last : {-1.0, -0.2, 0.5, 1.0}) {
      const VectorX q = (VectorX(3) << first, 0.6, last).finished();
      const Task task = Task::fromRows({0, 1, 5});
      SearchOptions options;
      options.max_solutions = 1;
      const SearchResult result =
          search(chain, task, forwardKinematics(chain, q), {VectorX::Constant(3, -1.0)}, options);
      ASSERT_EQ(result.solutions.size(), 1u) << first << ", " << last;
      EXPECT_LE(result.solutions[0].cwiseAbs().maxCoeff(), 1.0);
    }
  }
}

TEST(IkNumerical, JointWithAFullTurnPassesItsBound) {
  // Both ends of the turn are the same place: from 3.0 to -3.0 the short way is over the bound.
  const SerialChain chain = planar({1.0});
  const Pose target = forwardKinematics(chain, VectorX::Constant(1, -3.0));
  const DescentResult result = descend(chain, Task::fromRows({5}), target, VectorX::Constant(1, 3.0), {});
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.q[0], -3.0, 1e-12);
  EXPECT_LE(result.iterations, 8);
}

TEST(IkNumerical, PolishStaysOnItsBranch) {
  const SerialChain chain = planar({0.7, 0.5});
  const VectorX q = (VectorX(2) << 0.3 + kTwoPi, 0.9).finished();
  const Pose target = forwardKinematics(chain, q);
  VectorX moved = q + VectorX::Constant(2, 1e-4);
  EXPECT_LT(polish(chain, kPlane, target, moved).norm(), 1e-14);
  EXPECT_LT((moved - q).norm(), 1e-12);
  // Far from a solution it does nothing.
  VectorX far = q + VectorX::Constant(2, 0.1);
  const VectorX before = far;
  polish(chain, kPlane, target, far);
  EXPECT_EQ(far, before);
}

TEST(IkNumerical, PolishOfASingularSolution) {
  const golden::File& file = *golden::load("seed004_01_rrprrr");
  for (const golden::Case& test : file.cases) {
    VectorX q = test.q + VectorX::Constant(6, 1e-5);
    EXPECT_LT(polish(file.chain, Task(), test.pose, q).norm(), 1e-12) << test.id;
    EXPECT_LT((q - test.q).norm(), 1e-2) << test.id;
  }
}

TEST(IkNumerical, TimeoutIsKept) {
  ArmMaker maker(3);
  std::vector<Axis> axes;
  for (int i = 0; i < 60; ++i) axes.push_back(ArmMaker::turn(maker.direction(), maker.vector(1.0)));
  const SerialChain chain = ArmMaker::chain(axes, maker.pose(), Pose());
  SearchOptions options;
  options.restarts = 1000000000;
  options.timeout = 0.05;
  const auto seconds = [&](const std::function<void()>& run) {
    const auto begin = std::chrono::steady_clock::now();
    run();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const Pose target = at(1e3, 0.0);
  EXPECT_LT(seconds([&] { EXPECT_TRUE(search(chain, Task(), target, {}, options).timed_out); }), 1.0);
  EXPECT_LT(seconds([&] { closestReachable(chain, Task(), target, {}, options); }), 1.0);
  options.timeout = 0.0;
  EXPECT_LT(seconds([&] { EXPECT_TRUE(search(chain, Task(), target, {}, options).timed_out); }), 1.0);
}

TEST(IkNumerical, SearchIsCancelled) {
  const SerialChain chain = planar({0.7, 0.5});
  SearchOptions options;
  options.restarts = 1000000000;
  options.timeout = 1e9;
  int asked = 0;
  options.cancelled = [&] { return ++asked > 100; };
  EXPECT_TRUE(search(chain, kPlane, at(5.0, 0.0), {}, options).timed_out);
  EXPECT_LT(asked, 200);
}

TEST(IkNumerical, DescentIsFast) {
  const golden::File& file = *golden::load("seed004_01_rrprrr");
  const golden::Case& test = file.cases.front();
  DescentOptions options;
  int iterations = 0;
  const std::clock_t begin = std::clock();
  for (int k = 0; k < 2000; ++k) {
    const VectorX start = test.q + VectorX::Constant(6, 1e-4 * k + 0.2);
    iterations += descend(file.chain, Task(), test.pose, start, options).iterations;
  }
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  std::printf("%.2f us per iteration, %.1f iterations\n", 1e6 * seconds / iterations, iterations / 2000.0);
  EXPECT_LT(seconds / iterations, 50e-6);  // Several times what a busy machine in a debug build needs.
}

}  // namespace
}  // namespace screwline
