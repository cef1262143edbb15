#include <gtest/gtest.h>

#include <cstdio>
#include <ctime>

#include "property/model_random.h"
#include "screwline/ik/numerical/numerical_solver.h"

namespace screwline {
namespace {

constexpr double kHalfPi = 0.5 * kPi;

/// A configuration within the limits (a turn, or 1 m to both sides, where there are none).
VectorX within(const SerialChain& chain, RandomModel& random) {
  VectorX q(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    const double span = chain.joint(i).isRevolute() ? kPi : 1.0;
    q[i] = random.uniform(std::max(chain.joint(i).limits.lower, -span), std::min(chain.joint(i).limits.upper, span));
  }
  return q;
}

/// Some rows, no more than the chain has joints.
Task someTask(const SerialChain& chain, RandomModel& random) {
  std::vector<int> rows = {0, 1, 2, 3, 4, 5};
  const int count = random.integer(1, std::min(6, chain.size()));
  while (static_cast<int>(rows.size()) > count) {
    rows.erase(rows.begin() + random.integer(0, static_cast<int>(rows.size()) - 1));
  }
  return Task::fromRows(rows);
}

bool isWithin(const SerialChain& chain, const VectorX& q) {
  return q.allFinite() && (q.array() >= chain.lower().array()).all() && (q.array() <= chain.upper().array()).all();
}

/// Error of q by the product of exponentials, which the solver does not use.
double errorOf(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& q) {
  return taskError(task, target, forwardByExponentials(chain, q)).norm();
}

TEST(IkNumericalLaw, SolutionsReachTheTargetWithinLimitsOnRandomChains) {
  int poses = 0;
  int solved = 0;
  double worst = 0.0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    RandomModel random(seed);
    const SerialChain chain = random.chain(random.integer(4, 8), random.chance(0.5));
    const Task task = someTask(chain, random);
    const Pose target = forwardKinematics(chain, within(chain, random));
    SearchOptions options;
    options.max_solutions = 3;
    options.timeout = 10.0;
    const SearchResult result = search(chain, task, target, {VectorX::Zero(chain.size())}, options);
    for (const VectorX& q : result.solutions) {
      EXPECT_TRUE(isWithin(chain, q)) << "seed " << seed;
      const double error = errorOf(chain, task, target, q);
      EXPECT_LT(error, 1e-9) << "seed " << seed;
      worst = std::max(worst, error);
    }
    ++poses;
    if (!result.solutions.empty())
      ++solved;
    else
      std::printf("  not solved: seed %u, %d joints, %d rows, best %.3g\n", seed, chain.size(), task.size(),
                  result.best.error.norm());
  }
  std::printf("random chains, seeds 1..400: %d of %d poses solved, worst error %.2g\n", solved, poses, worst);
  EXPECT_GE(solved, poses - 2);
}

TEST(IkNumericalLaw, CheckerSeesAWrongAnswer) {
  RandomModel random(9);
  const SerialChain chain = random.chain(6);
  const VectorX q = within(chain, random);
  const Pose target = forwardKinematics(chain, q);
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(errorOf(chain, Task(), target, q), 1e-12);
    EXPECT_GT(errorOf(chain, Task(), target, q + 1e-8 * VectorX::Unit(6, i)), 1e-9);
  }
  VectorX outside = q;
  outside[2] = chain.upper()[2] + 1e-15;
  EXPECT_FALSE(isWithin(chain, outside) && std::isfinite(chain.upper()[2]));
}

TEST(IkNumericalLaw, SolutionsAreDifferent) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    RandomModel random(seed);
    const SerialChain chain = random.chain(6);
    const Task task;
    const Pose target = forwardKinematics(chain, within(chain, random));
    SearchOptions options;
    options.restarts = 64;
    options.timeout = 10.0;
    const SearchResult result = search(chain, task, target, {}, options);
    for (std::size_t a = 0; a < result.solutions.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        double largest = 0.0;
        for (int i = 0; i < chain.size(); ++i) {
          const double difference = result.solutions[a][i] - result.solutions[b][i];
          const bool turns = chain.joint(i).isRevolute();
          largest = std::max(largest, std::abs(turns ? std::remainder(difference, kTwoPi) : difference));
        }
        EXPECT_GT(largest, 1e-7) << "seed " << seed;
      }
    }
  }
}

TEST(IkNumericalLaw, TheSameBytesTwice) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    RandomModel random(seed);
    const SerialChain chain = random.chain(random.integer(4, 8), true);
    const Task task = someTask(chain, random);
    // Half of the targets are out of reach.
    const Pose target = seed % 2 == 0 ? forwardKinematics(chain, within(chain, random)) : random.pose();
    SearchOptions options;
    options.restarts = 16;
    options.timeout = 1e9;
    const std::vector<VectorX> starts = {VectorX::Zero(chain.size())};
    const SearchResult a = search(chain, task, target, starts, options);
    const SearchResult b = search(chain, task, target, starts, options);
    ASSERT_EQ(a.solutions.size(), b.solutions.size()) << "seed " << seed;
    for (std::size_t i = 0; i < a.solutions.size(); ++i) EXPECT_EQ(a.solutions[i], b.solutions[i]) << "seed " << seed;
    EXPECT_EQ(closestReachable(chain, task, target, starts, options).q,
              closestReachable(chain, task, target, starts, options).q)
        << "seed " << seed;
  }
}

TEST(IkNumericalLaw, WhateverIsAskedNothingIsNan) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    RandomModel random(seed);
    const SerialChain chain = random.chain(random.integer(1, 8), true);
    const Task task = someTask(chain, random);
    Pose target = random.pose();
    target.p *= std::pow(10.0, random.uniform(-3.0, 6.0));
    SearchOptions options;
    options.restarts = 8;
    options.descent.honour_limits = random.chance(0.7);
    const DescentResult closest = closestReachable(chain, task, target, {VectorX::Zero(chain.size())}, options);
    EXPECT_TRUE(closest.q.allFinite() && std::isfinite(closest.error.norm())) << "seed " << seed;
    EXPECT_TRUE(!options.descent.honour_limits || isWithin(chain, closest.q)) << "seed " << seed;
    for (const VectorX& q : search(chain, task, target, {}, options).solutions) {
      EXPECT_LT(errorOf(chain, task, target, q), 1e-9 + 1e-14 * target.p.norm()) << "seed " << seed;
    }
  }
}

/// Modified-DH rows a, alpha, d with limits, the tool on the last axis.
SerialChain arm(const std::vector<std::array<double, 5>>& rows, double tool) {
  ModifiedDh dh;
  ChainDescription description;
  description.name = "arm";
  for (const std::array<double, 5>& row : rows) {
    dh.rows.push_back({row[0], row[1], row[2], 0.0});
    Joint joint;
    joint.name = "joint" + std::to_string(dh.rows.size());
    joint.limits.lower = row[3];
    joint.limits.upper = row[4];
    description.joints.push_back(joint);
  }
  dh.tool_transform.p.z() = tool;
  description.axes = axesOf(dh, std::vector<bool>(rows.size(), false));
  for (std::size_t i = 0; i < rows.size(); ++i) description.axes[i].source = static_cast<int>(i);
  description.home = homeOf(dh);
  description.base_link = "base";
  description.tip_link = "tip";
  description.links = {{"base", 0, {}}, {"tip", static_cast<int>(rows.size()), description.home}};
  return SerialChain(description);
}

/// PUMA 560 (Craig, fig. 3.21, Unimation's limits), UR5, Panda and iiwa 14 (data sheets), and a 6R without structure.
std::vector<std::pair<std::string, SerialChain>> arms() {
  return {{"PUMA 560", arm({{0, 0, 0, -2.79, 2.79},
                            {0, -kHalfPi, 0, -3.9, 0.78},
                            {0.4318, 0, 0.15, -0.78, 3.9},
                            {0.0203, -kHalfPi, 0.4318, -1.92, 2.96},
                            {0, kHalfPi, 0, -1.74, 1.74},
                            {0, -kHalfPi, 0, -4.6, 4.6}},
                           0.06)},
          {"UR5", arm({{0, 0, 0.0892, -kTwoPi, kTwoPi},
                       {0, kHalfPi, 0, -kTwoPi, kTwoPi},
                       {-0.425, 0, 0, -kTwoPi, kTwoPi},
                       {-0.392, 0, 0.109, -kTwoPi, kTwoPi},
                       {0, kHalfPi, 0.0947, -kTwoPi, kTwoPi},
                       {0, -kHalfPi, 0.0823, -kTwoPi, kTwoPi}},
                      0.0)},
          {"Panda", arm({{0, 0, 0.333, -2.8973, 2.8973},
                         {0, -kHalfPi, 0, -1.7628, 1.7628},
                         {0, kHalfPi, 0.316, -2.8973, 2.8973},
                         {0.0825, kHalfPi, 0, -3.0718, -0.0698},
                         {-0.0825, -kHalfPi, 0.384, -2.8973, 2.8973},
                         {0, kHalfPi, 0, -0.0175, 3.7525},
                         {0.088, kHalfPi, 0, -2.8973, 2.8973}},
                        0.107)},
          {"iiwa 14", arm({{0, 0, 0.36, -2.96, 2.96},
                           {0, -kHalfPi, 0, -2.09, 2.09},
                           {0, kHalfPi, 0.42, -2.96, 2.96},
                           {0, kHalfPi, 0, -2.09, 2.09},
                           {0, -kHalfPi, 0.4, -2.96, 2.96},
                           {0, -kHalfPi, 0, -2.09, 2.09},
                           {0, kHalfPi, 0, -3.05, 3.05}},
                          0.126)},
          {"general 6R", arm({{0, 0.3, 0.4, -2.9, 2.9},
                              {0.2, -1.1, 0.1, -2.9, 2.9},
                              {0.4, 0.7, 0.15, -2.9, 2.9},
                              {0.1, -1.3, 0.35, -2.9, 2.9},
                              {0.05, 1.2, 0.1, -2.9, 2.9},
                              {0.07, -0.9, 0.05, -2.9, 2.9}},
                             0.1)}};
}

TEST(IkNumericalLaw, OneSolutionOfReachablePosesIsFound) {
  const Task task;
  for (const auto& [name, chain] : arms()) {
    constexpr int kPoses = 3000;
    RandomModel random(5);
    int failed = 0;
    std::vector<double> times;
    for (int k = 0; k < kPoses; ++k) {
      const Pose target = forwardKinematics(chain, within(chain, random));
      SearchOptions options;
      options.max_solutions = 1;
      options.timeout = 10.0;  // The restarts are the bound: how many poses are solved does not depend on the machine.
      const std::clock_t begin = std::clock();
      const SearchResult result = search(chain, task, target, {0.5 * (chain.lower() + chain.upper())}, options);
      times.push_back(1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
      if (result.solutions.empty()) {
        ++failed;
        continue;
      }
      EXPECT_LT(errorOf(chain, task, target, result.solutions[0]), 1e-9) << name << ", pose " << k;
      EXPECT_TRUE(isWithin(chain, result.solutions[0])) << name << ", pose " << k;
    }
    std::sort(times.begin(), times.end());
    double sum = 0.0;
    for (double time : times) sum += time;
    std::printf("%-10s seed 5: %d of %d poses not solved; mean %.1f us, median %.1f us, p99 %.1f us\n", name.c_str(),
                failed, kPoses, sum / kPoses, times[kPoses / 2], times[kPoses * 99 / 100]);
    EXPECT_LE(failed, kPoses / 1000) << name;
  }
}

}  // namespace
}  // namespace screwline
