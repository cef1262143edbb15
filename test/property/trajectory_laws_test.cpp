// Laws over random requests and states: limits by dense sampling, extrema, stop, bridge, and a fuzz of plan().
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "screwline/trajectory/metrics.h"
#include "screwline/trajectory/stop.h"
#include "screwline/trajectory/verify.h"
#include "unit/trajectory_support.h"

namespace screwline {
namespace {

using trajectory_test::limitsOf;
using trajectory_test::request;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double lower, double upper) { return std::uniform_real_distribution<double>(lower, upper)(engine_); }
  int integer(int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(engine_); }
  VectorX vector(int n, double lower, double upper) {
    return VectorX::NullaryExpr(n, [&](Eigen::Index) { return uniform(lower, upper); });
  }

 private:
  std::mt19937 engine_;
};

Limits randomLimits(Random& random, int joints) {
  Limits limits{
      random.vector(joints, 0.3, 3.0), random.vector(joints, 1.0, 20.0), random.vector(joints, 10.0, 400.0), {}, {}};
  return limits;
}

PlanRequest randomRequest(Random& random, const std::string& profile) {
  const int joints = random.integer(1, 7);
  const bool two = profile.find("point") == std::string::npos && profile.find("bspline") == std::string::npos;
  const int count = profile.rfind("via", 0) == 0 ? 3 : two ? 2 : random.integer(2, 9);
  std::vector<VectorX> way;
  for (int k = 0; k < count; ++k) {
    way.push_back(k > 0 && random.integer(0, 9) == 0 ? way.back() : random.vector(joints, -3.0, 3.0));
  }
  if (profile == "via_scalar" && way[0][0] == way[2][0]) way[2][0] += 0.5;
  PlanRequest r = request(profile, way, randomLimits(random, joints));
  if (profile == "sinusoidal") {
    r.waypoints.resize(1);
    r.duration = random.uniform(0.1, 30.0);
    r.limits = Limits::unlimited(joints);
    r.parameters = {{"amplitude_0", random.uniform(-2.0, 2.0)},
                    {"omega_0", random.uniform(-5.0, 5.0)},
                    {"phase_0", random.uniform(-9.0, 9.0)}};
  }
  return r;
}

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
  for (const auto& info : listProfiles()) {
    Random random(51);
    for (int trial = 0; trial < 12; ++trial) {
      const PlanResult result = plan(randomRequest(random, info.name));
      expectExtremaOf(result.trajectory, info.name + ", seed 51, trial " + std::to_string(trial));
    }
  }
}

TEST(TrajectoryLaws, DerivativesEqualFiniteDifferences) {
  for (const auto& info : listProfiles()) {
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
  for (const auto& info : listProfiles()) {
    if (info.name == "sinusoidal" || info.name.find("trapezoidal") != std::string::npos) continue;
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
  for (const auto& info : listProfiles()) {
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

MotionState randomState(Random& random, const Limits& limits, double share) {
  const int n = limits.joints();
  MotionState s{random.vector(n, -2.0, 2.0), random.vector(n, -share, share), random.vector(n, -share, share)};
  s.velocity = s.velocity.cwiseProduct(limits.velocity);
  s.acceleration = s.acceleration.cwiseProduct(limits.acceleration);
  return s;
}

TEST(Stop, FromAnyStateToRestWithinJerkAndAcceleration) {
  Random random(61);
  for (int trial = 0; trial < 3000; ++trial) {
    const Limits limits = randomLimits(random, random.integer(1, 6));
    const MotionState state = randomState(random, limits, trial % 2 == 0 ? 1.0 : 2.5);
    const JointTrajectory stop = stopTrajectory(state, limits);
    TrajectoryPoint first(limits.joints()), last(limits.joints());
    stop.sample(0.0, first);
    stop.sample(stop.duration(), last);
    EXPECT_LT((first.position - state.position).norm(), 1e-12) << "seed 61, trial " << trial;
    EXPECT_LT((first.velocity - state.velocity).norm(), 1e-9) << "seed 61, trial " << trial;
    EXPECT_LT((first.acceleration - state.acceleration).norm(), 1e-7) << "seed 61, trial " << trial;
    EXPECT_LT(last.velocity.norm(), 1e-9) << "seed 61, trial " << trial;
    EXPECT_LT(last.acceleration.norm(), 1e-7) << "seed 61, trial " << trial;
    EXPECT_EQ(stop.continuity(), 2);
    for (int j = 0; j < limits.joints(); ++j) {
      const JointExtrema e = stop.extrema(j);
      const double allowed = std::max(limits.acceleration[j], std::abs(state.acceleration[j]));
      EXPECT_LE(e.jerk, limits.jerk[j] * (1.0 + 1e-6)) << "seed 61, trial " << trial;
      EXPECT_LE(e.acceleration, allowed * (1.0 + 1e-7)) << "seed 61, trial " << trial;
      EXPECT_LT(stepInside(*stop.pieces(), j, 0), 1e-12);
      EXPECT_LT(stepInside(*stop.pieces(), j, 1), 1e-9);
      EXPECT_LT(stepInside(*stop.pieces(), j, 2), 1e-7);
    }
  }
}

TEST(Stop, KnownClosedForms) {
  const Limits limits = limitsOf(1, 10.0, 2.0, 4.0);
  const auto duration = [&](double v, double a) {
    return stopTrajectory({VectorX::Zero(1), VectorX::Constant(1, v), VectorX::Constant(1, a)}, limits).duration();
  };
  EXPECT_NEAR(duration(3.0, 0.0), 3.0 / 2.0 + 2.0 / 4.0, 1e-12);         // Reaches the limit: v/A + A/J.
  EXPECT_NEAR(duration(0.25, 0.0), 2.0 * std::sqrt(0.25 / 4.0), 1e-12);  // Does not: 2 sqrt(v/J).
  EXPECT_NEAR(duration(0.5, -2.0), 0.5, 1e-12);                          // Already on the last ramp.
  EXPECT_NEAR(duration(-3.0, 0.0), duration(3.0, 0.0), 1e-15);
  EXPECT_EQ(duration(0.0, 0.0), 0.0);
}

TEST(Stop, NoneIsShorterAmongBangBangCandidates) {
  // Independent check of time-optimality: with jerk +-J (and 0 at the acceleration limit), the least time to v = a = 0
  // found by integrating every candidate switching instant backwards on a grid is never below the closed form.
  Random random(62);
  for (int trial = 0; trial < 200; ++trial) {
    const double A = random.uniform(1.0, 4.0), J = random.uniform(3.0, 30.0);
    const double v = random.uniform(-3.0, 3.0), a = random.uniform(-A, A);
    const Limits limits = limitsOf(1, 100.0, A, J);
    const double closed =
        stopTrajectory({VectorX::Zero(1), VectorX::Constant(1, v), VectorX::Constant(1, a)}, limits).duration();
    double least = HUGE_VAL;
    for (int sign : {-1, 1}) {
      for (int i = 0; i <= 4000; ++i) {  // Peak acceleration of the candidate, then a ramp home.
        const double peak = sign * A * i / 4000.0;
        const double first = std::abs(peak - a) / J, last = std::abs(peak) / J;
        const double rest = v + 0.5 * (a + peak) * first + 0.5 * peak * last;  // Velocity left without a plateau.
        const double plateau = peak != 0.0 ? -rest / peak : (std::abs(rest) < 1e-3 ? 0.0 : -1.0);
        if (plateau >= 0.0) least = std::min(least, first + plateau + last);
      }
    }
    EXPECT_LE(closed, least + 1e-9) << "seed 62, trial " << trial;
  }
}

TEST(Stop, WithoutJerkLimitAndRefusals) {
  Limits limits = limitsOf(2, 1.0, 2.0, HUGE_VAL);
  const MotionState state{VectorX::Zero(2), Eigen::Vector2d(1.0, -0.5), Eigen::Vector2d(0.3, 0.0)};
  EXPECT_NEAR(stopTrajectory(state, limits).duration(), 0.5, 1e-12);
  EXPECT_EQ(stopTrajectory(state, limits).continuity(), 1);
  EXPECT_THROW(stopTrajectory(state, Limits::unlimited(2)), InputError);
  MotionState bad = state;
  bad.velocity[0] = std::nan("");
  EXPECT_THROW(stopTrajectory(bad, limits), InputError);
  bad.velocity.resize(1);
  EXPECT_THROW(stopTrajectory(bad, limits), InputError);
}

void expectBridge(const MotionState& from, const MotionState& to, const Limits& limits, const std::string& what) {
  const JointTrajectory bridge = bridgeTrajectory(from, to, limits);
  const int n = limits.joints();
  TrajectoryPoint first(n), last(n);
  bridge.sample(0.0, first);
  bridge.sample(bridge.duration(), last);
  EXPECT_LT((first.position - from.position).norm() + (last.position - to.position).norm(), 1e-9) << what;
  EXPECT_LT((first.velocity - from.velocity).norm() + (last.velocity - to.velocity).norm(), 1e-8) << what;
  EXPECT_LT((first.acceleration - from.acceleration).norm() + (last.acceleration - to.acceleration).norm(), 1e-6)
      << what;
  EXPECT_EQ(verifyTrajectory(bridge, limits, {}).value_or(""), "") << what;
  EXPECT_EQ(bridge.continuity(), 2) << what;
}

TEST(Bridge, FromRandomStatesToRestAndToStates) {
  Random random(63);
  int refused = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Limits limits = randomLimits(random, random.integer(1, 6));
    const MotionState from = randomState(random, limits, 0.7);
    MotionState to = randomState(random, limits, 0.7);
    if (trial % 2 == 0) to.velocity.setZero(), to.acceleration.setZero();
    try {
      expectBridge(from, to, limits, "seed 63, trial " + std::to_string(trial));
    } catch (const InputError& error) {
      EXPECT_EQ(error.code(), ErrorCode::kLimitsInfeasible);
      ++refused;
    }
  }
  EXPECT_LT(refused, 60) << "only states that push through a limit may be refused";
}

TEST(Bridge, EveryStateOfARunningMotionCanBeReplaced) {
  Random random(64);
  for (int trial = 0; trial < 60; ++trial) {
    PlanRequest r = randomRequest(random, "polynomial_345");
    const JointTrajectory running = plan(r).trajectory;
    TrajectoryPoint point(running.joints());
    running.sample(running.duration() * random.uniform(0.0, 1.0), point);
    const MotionState from{point.position, point.velocity, point.acceleration};
    const int n = running.joints();
    const MotionState to{random.vector(n, -3.0, 3.0), VectorX::Zero(n), VectorX::Zero(n)};
    expectBridge(from, to, r.limits, "seed 64, trial " + std::to_string(trial));
  }
}

TEST(Bridge, AtRestWhereItShouldBeTakesNoTime) {
  const MotionState here{VectorX::Ones(3), VectorX::Zero(3), VectorX::Zero(3)};
  EXPECT_EQ(bridgeTrajectory(here, here, limitsOf(3, 1.0, 2.0, 10.0)).duration(), 0.0);
}

TEST(Bridge, AStateThatMustBreakALimitIsRefused) {
  const MotionState from{VectorX::Zero(1), VectorX::Constant(1, 1.0), VectorX::Constant(1, 2.0)};
  const MotionState to{VectorX::Ones(1), VectorX::Zero(1), VectorX::Zero(1)};
  EXPECT_THROW(bridgeTrajectory(from, to, limitsOf(1, 1.0, 2.0, 10.0)), InputError);
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
  const auto profiles = listProfiles();
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
