// Stop and bridge from random states.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "property/trajectory_random.h"
#include "screwline/trajectory/state_to_state.h"
#include "screwline/trajectory/stop.h"
#include "screwline/trajectory/verify.h"
#include "unit/trajectory_support.h"

namespace screwline {
namespace {

using trajectory_test::limitsOf;
using trajectory_test::Random;
using trajectory_test::randomLimits;
using trajectory_test::randomRequest;

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
  const JointTrajectory bridge = timeOptimalBridge(from, to, limits);
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

/// Beyond a limit, or bound to leave it whatever the jerk does.
bool isBeyond(const MotionState& state, const Limits& limits) {
  for (int j = 0; j < limits.joints(); ++j) {
    const EndState start{state.position[j], state.velocity[j], state.acceleration[j]};
    if (checkState(start, axisLimits(limits, j), true).fault != StateFault::kNone) return true;
  }
  return false;
}

TEST(Bridge, FromRandomStatesToRestAndToStates) {
  Random random(63);
  int refused = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Limits limits = randomLimits(random, random.integer(1, 6));
    const MotionState from = randomState(random, limits, 0.7);
    MotionState to = randomState(random, limits, 0.7);
    if (trial % 2 == 0) to.velocity.setZero(), to.acceleration.setZero();
    if (isBeyond(from, limits)) {
      ++refused;
      continue;
    }
    try {
      expectBridge(from, to, limits, "seed 63, trial " + std::to_string(trial));
    } catch (const InputError& error) {
      EXPECT_EQ(error.code(), AnswerCode::kLimitsInfeasible);
      ++refused;
    }
  }
  EXPECT_LT(refused, 60) << "only states that push through a limit may be beyond or refused";
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
  EXPECT_EQ(timeOptimalBridge(here, here, limitsOf(3, 1.0, 2.0, 10.0)).duration(), 0.0);
}

TEST(Bridge, AStateThatMustBreakALimitIsBroughtBackAtFullJerk) {
  const MotionState from{VectorX::Zero(1), VectorX::Constant(1, 1.0), VectorX::Constant(1, 2.0)};
  const MotionState to{VectorX::Ones(1), VectorX::Zero(1), VectorX::Zero(1)};
  const JointTrajectory bridge = timeOptimalBridge(from, to, limitsOf(1, 1.0, 2.0, 10.0));
  EXPECT_NEAR(bridge.extrema(0).velocity, 1.0 + 2.0 * 2.0 / (2.0 * 10.0), 1e-12);
  // The same in reverse is a goal that cannot be come to.
  const MotionState goal{VectorX::Ones(1), VectorX::Constant(1, 1.0), VectorX::Constant(1, -2.0)};
  EXPECT_THROW(timeOptimalBridge(to, goal, limitsOf(1, 1.0, 2.0, 10.0)), InputError);
}

}  // namespace
}  // namespace screwline
