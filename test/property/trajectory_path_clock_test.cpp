// A path's clock: the path is kept, and the limits are, whatever is asked of the speed.
#include "screwline/trajectory/path_clock.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>

#include "property/trajectory_random.h"
#include "screwline/trajectory/enclosure.h"

namespace screwline {
namespace {

using trajectory_test::limitsOf;
using trajectory_test::Random;
using trajectory_test::randomLimits;
using trajectory_test::randomRequest;
using trajectory_test::vector;

const std::vector<std::string> kSmooth{"time_optimal", "double_s",           "polynomial_345",       "polynomial_4567",
                                       "cycloidal",    "multipoint_quintic", "bspline_interpolating"};

/// What the clock makes of a path at t.
TrajectoryPoint at(const PathClock& clock, const JointTrajectory& path, double t) {
  TrajectoryPoint point(path.joints());
  const PathInstant instant = clock.at(t);
  path.sample(instant.time, point);
  pace(instant, point);
  return point;
}

/// The largest share of its bound that an order takes up between two instants, at samples.
double use(const PathClock& clock, const JointTrajectory& path, const VectorX& bounds, VectorX TrajectoryPoint::*order,
           double from, double to) {
  double most = 0.0;
  for (int i = 0; i <= 4000; ++i) {
    const TrajectoryPoint point = at(clock, path, from + (to - from) * i / 4000.0);
    most = std::max(most, (point.*order).cwiseAbs().cwiseQuotient(bounds).maxCoeff());
  }
  return most;
}

struct Drive {
  JointTrajectory path;
  Limits limits;
};

Drive randomDrive(Random& random) {
  const std::string& profile =
      kSmooth[static_cast<std::size_t>(random.integer(0, static_cast<int>(kSmooth.size()) - 1))];
  for (;;) {
    const PlanRequest request = randomRequest(random, profile);
    const JointTrajectory path = plan(request).trajectory;
    if (path.duration() > 0.0) return {path, request.limits};
  }
}

TEST(PathClock, KeepsTheLimitsWhateverTheSpeed) {
  Random random(71);
  for (int trial = 0; trial < 150; ++trial) {
    const Drive drive = randomDrive(random);
    const Path path{&drive.path};
    const Limits bounds = boundsOf(path, drive.limits);
    PathClock clock(random.integer(0, 1) == 0 ? 1.0 : random.uniform(0.0, 1.0));
    double t = 0.0;
    for (int turn = 0; turn < 6; ++turn) {
      const double next = t + random.uniform(0.0, 0.4) * drive.path.duration();
      for (auto order : {&TrajectoryPoint::velocity, &TrajectoryPoint::acceleration, &TrajectoryPoint::jerk}) {
        const VectorX& bound = order == &TrajectoryPoint::velocity       ? drive.limits.velocity
                               : order == &TrajectoryPoint::acceleration ? drive.limits.acceleration
                                                                         : drive.limits.jerk;
        ASSERT_LE(use(clock, drive.path, bound, order, t, next), 1.0 + 1e-7) << "seed 71, trial " << trial;
      }
      const PathInstant before = clock.at(next);
      const double rate = random.integer(0, 2) == 0 ? 0.0 : random.integer(0, 1) == 0 ? 1.0 : random.uniform(0.0, 1.0);
      clock = clock.turned(next, rate, path, bounds);
      const PathInstant after = clock.at(next);
      ASSERT_NEAR(before.time, after.time, 1e-12) << "seed 71, trial " << trial;
      ASSERT_NEAR(before.rate, after.rate, 1e-9) << "seed 71, trial " << trial;
      ASSERT_NEAR(before.change, after.change, 1e-7) << "seed 71, trial " << trial;
      if (clock.at(clock.settled()).time < drive.path.duration()) {
        ASSERT_EQ(clock.finalRate(), rate) << "seed 71, trial " << trial << ", turn " << turn;
      }
      t = next;
    }
  }
}

TEST(PathClock, ItsDerivativesAreThoseOfWhatItSays) {
  Random random(72);
  for (int trial = 0; trial < 100; ++trial) {
    const Drive drive = randomDrive(random);
    const Path path{&drive.path};
    const PathClock clock = PathClock().turned(random.uniform(0.0, 0.7) * drive.path.duration(),
                                               random.uniform(0.0, 1.0), path, boundsOf(path, drive.limits));
    for (int i = 0; i < 50; ++i) {
      const double h = 1e-5;
      const double t = random.uniform(h, 1.5 * drive.path.duration());
      const TrajectoryPoint low = at(clock, drive.path, t - h), here = at(clock, drive.path, t),
                            high = at(clock, drive.path, t + h);
      if ((high.jerk - low.jerk).cwiseAbs().maxCoeff() > 1e-2 * drive.limits.jerk.maxCoeff()) continue;  // A corner.
      if (clock.at(t + h).time >= drive.path.duration()) continue;
      const auto off = [&](VectorX TrajectoryPoint::*value, VectorX TrajectoryPoint::*rate) {
        return ((high.*value - low.*value) / (2.0 * h) - here.*rate).cwiseAbs().maxCoeff();
      };
      ASSERT_LT(off(&TrajectoryPoint::position, &TrajectoryPoint::velocity), 1e-6) << "seed 72, trial " << trial;
      ASSERT_LT(off(&TrajectoryPoint::velocity, &TrajectoryPoint::acceleration), 1e-3) << "seed 72, trial " << trial;
      ASSERT_LT(off(&TrajectoryPoint::acceleration, &TrajectoryPoint::jerk), 0.03 * drive.limits.jerk.maxCoeff())
          << "seed 72, trial " << trial;
    }
  }
}

TEST(PathClock, RatesNeverLeaveTheIntervalAndPathTimeNeverFalls) {
  Random random(73);
  for (int trial = 0; trial < 100; ++trial) {
    const Drive drive = randomDrive(random);
    const Path path{&drive.path};
    const Limits bounds = boundsOf(path, drive.limits);
    PathClock clock;
    double t = 0.0, last = 0.0;
    for (int turn = 0; turn < 20; ++turn) {
      clock = clock.turned(t, random.integer(0, 1), path, bounds);  // Up and down, long before it gets there.
      for (int i = 0; i < 50; ++i, t += 4e-4 * drive.path.duration()) {
        const PathInstant now = clock.at(t);
        ASSERT_GE(now.time, last - 1e-14 * drive.path.duration()) << "seed 73, trial " << trial;
        ASSERT_TRUE(now.rate >= 0.0 && now.rate <= 1.0) << "seed 73, trial " << trial;
        last = now.time;
      }
    }
  }
}

TEST(PathClock, StandsWhenPausedAndGetsThereWhenResumed) {
  Random random(74);
  for (int trial = 0; trial < 100; ++trial) {
    const Drive drive = randomDrive(random);
    const double T = drive.path.duration();
    const Path path{&drive.path};
    const Limits bounds = boundsOf(path, drive.limits);
    const PathClock paused = PathClock().turned(random.uniform(0.0, 0.5) * T, 0.0, path, bounds);
    const double rest = paused.settled();
    if (paused.at(rest).time >= T) continue;
    EXPECT_EQ(paused.at(rest + 100.0).time, paused.at(rest + 1.0).time);
    EXPECT_TRUE(at(paused, drive.path, rest + 1.0).velocity.isZero(0.0));
    EXPECT_TRUE(std::isinf(paused.instantOf(T)));
    const PathClock resumed = paused.turned(rest + 10.0, 1.0, path, bounds);
    const double end = resumed.instantOf(T);
    ASSERT_TRUE(std::isfinite(end)) << "seed 74, trial " << trial;
    EXPECT_NEAR(resumed.at(end).time, T, 1e-9 * T) << "seed 74, trial " << trial;
    EXPECT_EQ(resumed.at(rest + 5.0).time, paused.at(rest + 5.0).time) << "what was is not changed";
    EXPECT_LT(end, rest + 10.0 + 4.0 * T + 2.0) << "seed 74, trial " << trial;
  }
}

/// On a straight path at constant velocity the quickest pause is the quickest stop of a joint: v/A + A/J.
TEST(PathClock, IsAsQuickAsAStopWhereThePathIsStraight) {
  PiecewisePolynomial line(1, 1, {0.0, 20.0}, 3);
  line.starts_at_rest = line.ends_at_rest = false;
  line.setPiece(0, 0, {{0.0, 20.0}});  // 1 rad/s
  const JointTrajectory motion = JointTrajectory::piecewise(line);
  const Limits limits = limitsOf(1, 1.0, 4.0, 40.0);
  const Path path{&motion};
  const PathClock clock = PathClock().turned(3.0, 0.0, path, boundsOf(path, limits));
  EXPECT_NEAR(clock.settled() - 3.0, 1.0 / 4.0 + 4.0 / 40.0, 1e-9);
  const PathClock back = clock.turned(9.0, 1.0, path, boundsOf(path, limits));
  EXPECT_NEAR(back.settled() - 9.0, 1.0 / 4.0 + 4.0 / 40.0, 1e-9);
}

/// Full braking to the goal cannot be braked harder: the motion ends before the pause.
TEST(PathClock, WaitsWhereThePathBrakesAtItsLimit) {
  const Limits limits = limitsOf(1, 100.0, 4.0, 4e4);
  PlanRequest request = trajectory_test::request("time_optimal", {vector({0.0}), vector({4.0})}, limits);
  const JointTrajectory motion = plan(request).trajectory;  // One second up, one down.
  const Path path{&motion};
  const Limits bounds = boundsOf(path, limits);
  const PathClock late = PathClock().turned(1.5, 0.0, path, bounds);
  EXPECT_LE(use(late, motion, limits.acceleration, &TrajectoryPoint::acceleration, 0.0, 3.0), 1.0 + 1e-7);
  const PathClock early = PathClock().turned(0.5, 0.0, path, bounds);
  EXPECT_EQ(early.finalRate(), 0.0);
  EXPECT_LT(early.settled() - 0.5, 2.1 * 0.5) << "a stop off the path would take v / A = 0.5 s";
  EXPECT_LE(use(early, motion, limits.acceleration, &TrajectoryPoint::acceleration, 0.0, 3.0), 1.0 + 1e-7);
}

TEST(PathClock, AtFullRateItChangesNothing) {
  Random random(75);
  const Drive drive = randomDrive(random);
  TrajectoryPoint point(drive.path.joints());
  for (int i = 0; i <= 100; ++i) {
    const double t = drive.path.duration() * i / 100.0;
    drive.path.sample(t, point);
    EXPECT_EQ(at(PathClock(), drive.path, t).jerk, point.jerk);
    EXPECT_EQ(at(PathClock(), drive.path, t).position, point.position);
  }
  EXPECT_EQ(PathClock().instantOf(drive.path.duration()), drive.path.duration());
  for (double rate : {-0.1, 1.1, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(PathClock().turned(0.0, rate, {&drive.path}, drive.limits), InputError);
  }
}

TEST(PathClock, AStateInFlightIsSeenAtTheSlowestRateThatHoldsIt) {
  Random random(76);
  for (int trial = 0; trial < 500; ++trial) {
    const Drive drive = randomDrive(random);
    const Path path{&drive.path};
    const double speed = random.uniform(0.05, 1.0);
    const TrajectoryPoint now =
        at(PathClock(speed), drive.path, random.uniform(0.0, 1.0) * drive.path.duration() / speed);
    const MotionState state{now.position, now.velocity, now.acceleration};
    const double rate = slowestRate(state, drive.limits, speed);
    EXPECT_LE(rate, speed + 1e-12) << "seed 76, trial " << trial << ": what runs at a speed is feasible at it";
    EXPECT_EQ(slowestRate({now.position, 0.0 * now.velocity, 0.0 * now.acceleration}, drive.limits, 0.0), 0.0);
  }
}

TEST(Enclosure, HoldsEveryValueAndShrinksToIt) {
  Random random(77);
  for (int trial = 0; trial < 400; ++trial) {
    const auto profiles = listProfiles();
    const std::string profile =
        profiles[static_cast<std::size_t>(random.integer(0, static_cast<int>(profiles.size()) - 1))].name;
    PlanRequest request = randomRequest(random, profile);
    JointTrajectory path;
    try {
      path = plan(request).trajectory;
    } catch (const InputError&) {
      continue;
    }
    TrajectoryPoint point(path.joints());
    const double from = random.uniform(0.0, 1.0) * path.duration();
    const double to = from + random.uniform(0.0, 1.0) * (path.duration() - from);
    for (int joint = 0; joint < path.joints(); ++joint) {
      for (int order = 0; order <= 3; ++order) {
        const Range all = enclosure(path, joint, order, from, to);
        const double slack = 1e-9 * std::max(1.0, all.peak());
        for (int i = 0; i <= 20; ++i) {
          const double t = from + (to - from) * i / 20.0;
          path.sample(t, point);
          const double values[] = {point.position[joint], point.velocity[joint], point.acceleration[joint],
                                   point.jerk[joint]};
          ASSERT_GE(values[order], all.lower - slack)
              << "seed 77, trial " << trial << ", " << profile << ", order " << order;
          ASSERT_LE(values[order], all.upper + slack)
              << "seed 77, trial " << trial << ", " << profile << ", order " << order;
          if (path.path() != nullptr) continue;  // Of the whole motion.
          const Range one = enclosure(path, joint, order, t, t);
          ASSERT_NEAR(one.lower, values[order], slack)
              << "seed 77, trial " << trial << ", " << profile << ", order " << order;
          ASSERT_NEAR(one.upper, values[order], slack)
              << "seed 77, trial " << trial << ", " << profile << ", order " << order;
        }
      }
    }
  }
}

}  // namespace
}  // namespace screwline
