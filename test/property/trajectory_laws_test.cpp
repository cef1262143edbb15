// Laws over random requests: extrema, derivatives, scaling, time reversal, and a fuzz of plan().
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "property/trajectory_random.h"
#include "unit/trajectory_support.h"

namespace screwline {
namespace {

using trajectory_test::Random;
using trajectory_test::randomRequest;

/// Peaks and range by dense sampling against the exact ones: never above, and close.
void expectExtremaOf(const JointTrajectory& trajectory, const std::string& what) {
  constexpr int kSteps = 3000;
  TrajectoryPoint point(trajectory.joints()), before(trajectory.joints());
  const int n = trajectory.joints();
  MatrixX peaks = MatrixX::Zero(n, 3);
  VectorX lower = VectorX::Constant(n, HUGE_VAL), upper = -lower, travel = VectorX::Zero(n), square = VectorX::Zero(n);
  for (int i = 0; i <= kSteps; ++i) {
    trajectory.sample(trajectory.duration() * i / kSteps, point);
    peaks.col(0) = peaks.col(0).cwiseMax(point.velocity.cwiseAbs());
    peaks.col(1) = peaks.col(1).cwiseMax(point.acceleration.cwiseAbs());
    peaks.col(2) = peaks.col(2).cwiseMax(point.jerk.cwiseAbs());
    lower = lower.cwiseMin(point.position);
    upper = upper.cwiseMax(point.position);
    if (i > 0) travel += (point.position - before.position).cwiseAbs();
    before = point;
  }
  std::vector<double> breaks = trajectory.corners();
  breaks.insert(breaks.begin(), 0.0);
  breaks.push_back(trajectory.duration());
  for (std::size_t k = 1; k < breaks.size(); ++k) {
    const double h = (breaks[k] - breaks[k - 1]) / 400.0;
    for (int i = 0; i < 400; ++i) {
      trajectory.sample(breaks[k - 1] + (i + 0.5) * h, point);
      square += point.acceleration.cwiseAbs2() * h;
    }
  }
  for (int j = 0; j < n; ++j) {
    const JointExtrema e = trajectory.extrema(j);
    const double slack = 1e-9;
    EXPECT_LE(peaks(j, 0), e.velocity * (1.0 + slack) + 1e-12) << what;
    EXPECT_LE(peaks(j, 1), e.acceleration * (1.0 + slack) + 1e-11) << what;
    EXPECT_LE(peaks(j, 2), e.jerk * (1.0 + slack) + 1e-9) << what;
    EXPECT_NEAR(peaks(j, 0), e.velocity, 5e-3 * (e.velocity + 1e-9)) << what;
    EXPECT_GE(lower[j], e.position.lower - 1e-12) << what;
    EXPECT_LE(upper[j], e.position.upper + 1e-12) << what;
    EXPECT_NEAR(travel[j], e.travel, 1e-4 * (1.0 + e.travel)) << what;
    EXPECT_NEAR(square[j], e.squared_acceleration, 1e-3 * (e.squared_acceleration + 1e-9)) << what;
  }
}

TEST(TrajectoryLaws, ExactExtremaBoundDenseSamplesOfEveryProfile) {
  for (const auto& info : trajectory_test::jointProfiles()) {
    Random random(51);
    for (int trial = 0; trial < 12; ++trial) {
      const PlanResult result = plan(randomRequest(random, info.name));
      expectExtremaOf(result.trajectory, info.name + ", seed 51, trial " + std::to_string(trial));
    }
  }
}

TEST(TrajectoryLaws, DerivativesEqualFiniteDifferences) {
  for (const auto& info : trajectory_test::jointProfiles()) {
    Random random(52);
    for (int trial = 0; trial < 8; ++trial) {
      const JointTrajectory motion = plan(randomRequest(random, info.name)).trajectory;
      if (motion.duration() == 0.0) continue;
      TrajectoryPoint before(motion.joints()), at(motion.joints()), after(motion.joints());
      const double h = 1e-5 * motion.duration();
      for (int i = 1; i < 60; ++i) {
        const double t = motion.duration() * (i + 0.123) / 60.0;
        bool corner = false;
        for (double c : motion.corners()) corner |= std::abs(c - t) < 2.0 * h;
        if (corner || t + h > motion.duration()) continue;
        motion.sample(t - h, before);
        motion.sample(t, at);
        motion.sample(t + h, after);
        const double v = motion.duration() * (at.velocity - (after.position - before.position) / (2.0 * h)).norm();
        const double a = motion.duration() * (at.acceleration - (after.velocity - before.velocity) / (2.0 * h)).norm();
        const double j = motion.duration() * (at.jerk - (after.acceleration - before.acceleration) / (2.0 * h)).norm();
        EXPECT_LT(v, 1e-5 * (1.0 + at.position.norm())) << info.name << ", seed 52";
        EXPECT_LT(a, 1e-4 * (1.0 + at.velocity.norm())) << info.name << ", seed 52";
        EXPECT_LT(j, 1e-3 * (1.0 + at.acceleration.norm() + at.jerk.norm())) << info.name << ", seed 52";
      }
    }
  }
}

TEST(TrajectoryLaws, TwiceTheDurationHalvesQuartersAndEighthsTheDerivatives) {
  for (const auto& info : trajectory_test::jointProfiles()) {
    if (info.name == "sinusoidal" || info.name.find("trapezoidal") != std::string::npos) continue;
    if (info.name == "time_optimal") continue;  // Its joints have their own shape in each duration.
    Random random(53);
    PlanRequest r = randomRequest(random, info.name);
    const JointTrajectory once = plan(r).trajectory;
    r.duration = 2.0 * once.duration();
    const JointTrajectory twice = plan(r).trajectory;
    for (int j = 0; j < once.joints(); ++j) {
      EXPECT_NEAR(twice.extrema(j).velocity * 2.0, once.extrema(j).velocity, 1e-9 * once.extrema(j).velocity)
          << info.name;
      EXPECT_NEAR(twice.extrema(j).acceleration * 4.0, once.extrema(j).acceleration,
                  1e-8 * once.extrema(j).acceleration);
      EXPECT_NEAR(twice.extrema(j).jerk * 8.0, once.extrema(j).jerk, 1e-7 * once.extrema(j).jerk) << info.name;
    }
  }
}

TEST(TrajectoryLaws, ScaledLimitsLengthenTheMotion) {
  for (const auto& info : trajectory_test::jointProfiles()) {
    if (info.name == "sinusoidal") continue;
    Random random(54);
    PlanRequest r = randomRequest(random, info.name);
    const double full = plan(r).trajectory.duration();
    r.velocity_scaling = 0.5;
    r.acceleration_scaling = 0.25;
    r.jerk_scaling = 0.125;
    EXPECT_NEAR(plan(r).trajectory.duration(), 2.0 * full, 1e-9 * full) << info.name;
  }
}

TEST(TrajectoryLaws, ReversedWaypointsReverseTheMotion) {
  for (const char* profile : {"cubic", "polynomial_345", "cycloidal", "via_per_joint", "multipoint_cubic",
                              "multipoint_quintic", "multipoint_trapezoidal", "bspline", "bspline_interpolating"}) {
    Random random(55);
    PlanRequest r = randomRequest(random, profile);
    const JointTrajectory there = plan(r).trajectory;
    std::reverse(r.waypoints.begin(), r.waypoints.end());
    const JointTrajectory back = plan(r).trajectory;
    ASSERT_NEAR(there.duration(), back.duration(), 1e-9 * there.duration()) << profile;
    TrajectoryPoint a(there.joints()), b(there.joints());
    for (int i = 0; i <= 50; ++i) {
      there.sample(there.duration() * i / 50.0, a);
      back.sample(there.duration() * (50 - i) / 50.0, b);
      EXPECT_LT((a.position - b.position).norm(), 1e-8) << profile;
    }
  }
}

double spoiled(Random& random) {
  const double values[] = {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300, -1e7, 1e6, 1e-300, -0.0, 0.0, 1.0, -1.0};
  return values[random.integer(0, 10)];
}

/// One random fault, or something that only looks like one.
void spoil(Random& random, PlanRequest& r) {
  const std::size_t some =
      r.waypoints.empty() ? 0 : static_cast<std::size_t>(random.integer(0, static_cast<int>(r.waypoints.size()) - 1));
  switch (random.integer(0, 12)) {
    case 0:
      r.duration = spoiled(random);
      break;
    case 1:
      r.sample_period = spoiled(random);
      break;
    case 2:
      if (!r.waypoints.empty()) r.waypoints[some].position[0] = spoiled(random);
      break;
    case 3:
      if (!r.waypoints.empty()) r.waypoints[some].time = spoiled(random);
      break;
    case 4:
      if (!r.waypoints.empty()) r.waypoints[some].velocity = VectorX::Constant(random.integer(0, 8), spoiled(random));
      break;
    case 5:
      if (!r.waypoints.empty())
        r.waypoints[some].acceleration = VectorX::Constant(random.integer(0, 8), spoiled(random));
      break;
    case 6:
      r.limits.jerk[0] = spoiled(random);
      break;
    case 7:
      r.limits.velocity[0] = spoiled(random);
      break;
    case 8:
      r.velocity_scaling = spoiled(random);
      break;
    case 9:
      r.parameters.push_back({"via_tau", spoiled(random)});
      break;
    case 10:
      r.parameters.push_back({"peak_velocity", spoiled(random)});
      break;
    case 11:
      r.waypoints.clear();
      break;
    default:
      r.duration = random.uniform(0.0, 5.0);
      break;
  }
}

TEST(Fuzz, PlanAnswersOrRefusesAndNeverLetsALimitOrNanThrough) {
  Random random(71);
  const auto profiles = trajectory_test::jointProfiles();
  int planned = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const auto& info = profiles[static_cast<std::size_t>(random.integer(0, static_cast<int>(profiles.size()) - 1))];
    PlanRequest r = randomRequest(random, info.name);
    for (int faults = random.integer(0, 2); faults > 0; --faults) spoil(random, r);
    try {
      const PlanResult result = plan(r);
      ++planned;
      TrajectoryPoint point(r.limits.joints());
      for (double share : {0.0, 0.31, 0.5, 0.77, 1.0}) {
        result.trajectory.sample(share * result.trajectory.duration(), point);
        ASSERT_TRUE(point.position.allFinite() && point.velocity.allFinite())
            << info.name << ", seed 71, trial " << trial;
        ASSERT_TRUE(point.acceleration.allFinite() && point.jerk.allFinite())
            << info.name << ", seed 71, trial " << trial;
        ASSERT_TRUE((point.velocity.array().abs() <= r.limits.velocity.array() * (1.0 + 1e-8)).all())
            << info.name << ", seed 71, trial " << trial;
      }
    } catch (const InputError& error) {
      ASSERT_GT(std::string(error.what()).size(), 10u);
    } catch (const std::exception& error) {
      FAIL() << info.name << ", seed 71, trial " << trial << ": " << error.what();
    }
  }
  EXPECT_GT(planned, 8000);
}

}  // namespace
}  // namespace screwline
