// Commands in quick succession while a motion runs, waits or ends: what is streamed keeps the limits, does not step up
// to acceleration, and arrives.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "screwline/trajectory/plan.h"
#include "unit/ros_trajectory_support.h"
#include "unit/trajectory_support.h"

namespace screwline {
namespace ros_bridge {
namespace {

using trajectory_test::limitsOf;
using trajectory_test::request;
using trajectory_test::vector;

Limits boundedLimits(int joints, double velocity, double acceleration, double jerk) {
  Limits limits = limitsOf(joints, velocity, acceleration, jerk);
  limits.lower = VectorX::Constant(joints, -2.0);
  limits.upper = VectorX::Constant(joints, 2.0);
  return limits;
}

/// What two samples in a row have to have in common, whatever was asked for between them; empty: they do.
std::string brokenBetween(const Sent& a, const Sent& b, const Limits& limits) {
  const double dt = seconds(b.stamp - a.stamp);
  if (!(dt > 0.0)) return "the stamp does not increase";
  for (int j = 0; j < limits.joints(); ++j) {
    const double jerk = limits.jerk[j] * (1.0 + 1e-6);
    const double v = b.state.velocity[j], acceleration = b.state.acceleration[j];
    const double mean = 0.5 * (a.state.acceleration[j] + acceleration);
    const double drift =
        b.state.position[j] - a.state.position[j] - a.state.velocity[j] * dt - 0.5 * a.state.acceleration[j] * dt * dt;
    const std::string joint = "joint " + std::to_string(j) + ": ";
    if (!(std::abs(v) <= limits.velocity[j] * (1.0 + 1e-7) + 1e-9)) return joint + "velocity";
    if (!(std::abs(acceleration) <= limits.acceleration[j] * (1.0 + 1e-6) + 1e-8)) return joint + "acceleration";
    if (!(std::abs(b.state.position[j]) <= 2.0 + 1.1e-6)) return joint + "position";
    if (!(std::abs(acceleration - a.state.acceleration[j]) <= jerk * dt + 1e-7)) return joint + "acceleration steps";
    if (!(std::abs(v - a.state.velocity[j] - mean * dt) <= 0.25 * jerk * dt * dt + 1e-7))
      return joint + "velocity steps";
    if (!(std::abs(drift) <= jerk * dt * dt * dt / 6.0 + 2e-6)) return joint + "position steps";
  }
  return {};
}

/// One robot and its random commands.
class Flight {
 public:
  explicit Flight(unsigned seed)
      : random_(seed),
        joints_(1 + static_cast<int>(seed % 3)),
        limits_(boundedLimits(joints_, uniform(0.3, 3.0), uniform(0.5, 10.0), uniform(2.0, 100.0))),
        rate_(std::pow(10.0, uniform(1.0, 2.5))),
        executor_(values(1.5), rate_, limits_, clock_.clock(), recorderInto(sent)) {}

  void fly() {
    run(3);
    const int commands = 2 + static_cast<int>(uniform(0.0, 8.0));
    for (int i = 0; i < commands; ++i) {
      command();
      run(uniform(0.0, 1.0) < 0.3 ? static_cast<int>(uniform(0.0, 3.0)) : static_cast<int>(uniform(0.0, 1.5) * rate_));
    }
    executor_.resume();
    executor_.setSpeed(1.0);
    for (int i = 0; i < 60 * rate_ && !(i > 5 && sent.back().held); ++i) executor_.step();
  }

  const Limits& limits() const { return limits_; }

  std::vector<Sent> sent;
  VectorX goal;  ///< Empty: stopped on the way.

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  VectorX values(double most) {
    return VectorX::NullaryExpr(joints_, [&] { return uniform(-most, most); });
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) executor_.step();
  }

  void command() {
    const double what = uniform(0.0, 1.0);
    if (what < 0.4) {
      execute();
    } else if (what < 0.5) {
      executor_.replace([&](const MotionState& present) { return Motion(stopFrom(present, limits_)); },
                        MotionExecutor::Pace::kRealTime);
      goal.resize(0);
    } else if (what < 0.65) {
      executor_.pause();
    } else if (what < 0.8) {
      executor_.resume();
    } else {
      const double speeds[] = {0.0, 1e-3, 1.0, uniform(0.0, 1.0), uniform(0.0, 1.0)};
      executor_.setSpeed(speeds[static_cast<std::size_t>(uniform(0.0, 4.999))]);
    }
  }

  void execute() {
    const char* const profiles[] = {"time_optimal", "double_s", "polynomial_4567"};
    const std::string profile = profiles[static_cast<std::size_t>(uniform(0.0, 2.999))];
    const bool here = uniform(0.0, 1.0) < 0.5;
    const VectorX first = here ? executor_.state().position.cwiseMax(-2.0).cwiseMin(2.0).eval() : values(1.8);
    PlanRequest question = request(profile, {first, values(1.8)}, limits_);
    const bool moving = profile == "time_optimal" && uniform(0.0, 1.0) < 0.3;
    if (moving) question.waypoints.front().velocity = 0.1 * limits_.velocity;
    JointTrajectory motion;
    try {
      motion = plan(question).trajectory;
    } catch (const InputError&) {  // A moving start beside a position limit.
      return;
    }
    executor_.replace([&](const MotionState& present) { return startFrom(present, motion, limits_); });
    goal = question.waypoints.back().position;
  }

  std::mt19937 random_;
  int joints_;
  Limits limits_;
  double rate_;
  FakeClock clock_;
  MotionExecutor executor_;
};

TEST(Flight, CommandsInQuickSuccession) {
  for (unsigned seed = 1; seed <= 150; ++seed) {
    Flight flight(seed);
    ASSERT_NO_THROW(flight.fly()) << "seed " << seed;
    for (std::size_t k = 1; k < flight.sent.size(); ++k) {
      const std::string broken = brokenBetween(flight.sent[k - 1], flight.sent[k], flight.limits());
      ASSERT_EQ(broken, "") << "seed " << seed << ", sample " << k;
    }
    EXPECT_TRUE(flight.sent.back().held) << "seed " << seed;
    if (flight.goal.size() == 0) continue;
    EXPECT_LT((flight.sent.back().state.position - flight.goal).norm(), 1e-9) << "seed " << seed;
  }
}

/// A motion that starts in a moving state is entered in motion, from rest at its first position too.
TEST(Flight, AMovingStartIsReachedBeforeIt) {
  const Limits limits = boundedLimits(1, 1.0, 4.0, 40.0);
  PlanRequest question = request("time_optimal", {vector({0.0}), vector({1.0})}, limits);
  question.waypoints[0].velocity = vector({0.5});
  const MotionState rest{vector({0.0}), vector({0.0}), vector({0.0})};
  const Motion motion = startFrom(rest, plan(question).trajectory, limits);
  EXPECT_GT(motion.lead().duration(), 0.0);
  TrajectoryPoint point(1);
  motion.lead().sample(motion.lead().duration(), point);
  EXPECT_NEAR(point.position[0], 0.0, 1e-9);
  EXPECT_NEAR(point.velocity[0], 0.5, 1e-9);
  // A rectangle's step at its start is the profile's own.
  const Motion step =
      startFrom(rest, plan(request("rectangular", {vector({0.0}), vector({1.0})}, limits)).trajectory, limits);
  EXPECT_EQ(step.lead().duration(), 0.0);
}

TEST(Flight, TheCheckSeesAStep) {
  Sent a, b;
  a.state = b.state = TrajectoryPoint(1);
  for (VectorX* values : {&a.state.position, &a.state.velocity, &a.state.acceleration, &b.state.position,
                          &b.state.velocity, &b.state.acceleration}) {
    values->setZero();
  }
  b.stamp = 1000000;
  const Limits limits = boundedLimits(1, 1.0, 4.0, 40.0);
  EXPECT_EQ(brokenBetween(a, b, limits), "");
  b.state.acceleration[0] = 0.041;
  EXPECT_EQ(brokenBetween(a, b, limits), "joint 0: acceleration steps");
  b.state.acceleration[0] = 0.0;
  b.state.velocity[0] = 1e-3;
  EXPECT_EQ(brokenBetween(a, b, limits), "joint 0: velocity steps");
  b.state.velocity[0] = 0.0;
  b.state.position[0] = 1e-5;
  EXPECT_EQ(brokenBetween(a, b, limits), "joint 0: position steps");
}

}  // namespace
}  // namespace ros_bridge
}  // namespace screwline
