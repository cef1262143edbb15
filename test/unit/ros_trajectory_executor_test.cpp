#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "unit/ros_trajectory_stream.h"

namespace screwline {
namespace ros_bridge {
namespace {

TEST(MotionExecutor, HoldsTheInitialPosition) {
  Stream stream;
  stream.run(50);
  for (std::size_t i = 0; i < stream.sent.size(); ++i) {
    EXPECT_EQ(stream.sent[i].stamp, stream.sent[0].stamp + static_cast<Nanoseconds>(i) * kPeriod);
    EXPECT_TRUE(stream.sent[i].held);
    EXPECT_TRUE(stream.sent[i].state.position.isZero(0.0));
    EXPECT_TRUE(stream.sent[i].state.velocity.isZero(0.0));
  }
  EXPECT_GT(stream.clock.rests, 0);
}

TEST(MotionExecutor, TwentySecondsAtHundredHertzAreTwoThousandAndOneSamples) {
  Stream stream;
  stream.run(3);
  const JointTrajectory main = move(pair(0, 0), pair(1, -1), 20.0);
  const auto started = stream.go(main);
  stream.run(2100);
  const std::vector<Sent> inside = stream.window(started);
  ASSERT_EQ(inside.size(), 2001U);
  TrajectoryPoint point(2);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    EXPECT_EQ(inside[i].stamp, started.stamp + static_cast<Nanoseconds>(i) * kPeriod);
    main.sample(seconds(inside[i].stamp - started.stamp), point);
    EXPECT_EQ(inside[i].state.position, point.position) << i;
    EXPECT_TRUE(inside[i].scaled);
    EXPECT_NEAR(inside[i].tau, static_cast<double>(i) / 2000.0, 1e-12);
  }
  EXPECT_EQ(inside.back().tau, 1.0);
  EXPECT_FALSE(inside.back().held);
  EXPECT_TRUE(stream.sent.back().held);
  stream.expectIncreasing();
}

TEST(MotionExecutor, TheEndHasASampleOfItsOwn) {
  for (const double rate : {7.0, 100.0, 333.0, 1000.0}) {
    Stream stream(rate);
    stream.run(2);
    const JointTrajectory main = JointTrajectory::scaled(pair(0, 0), pair(1, 2), TimeLaw::rectangular(), 1.2345);
    const auto started = stream.go(main);
    stream.run(static_cast<int>(2.0 * rate));
    const std::vector<Sent> inside = stream.window(started);
    EXPECT_EQ(inside.size(), static_cast<std::size_t>(std::floor(1.2345 * rate)) + 2) << rate;
    EXPECT_EQ(inside.front().stamp, started.stamp);
    EXPECT_EQ(inside.back().stamp, started.stamp + 1234500000);
    EXPECT_EQ(inside.back().state.position, pair(1, 2));
    EXPECT_NEAR(inside.back().state.velocity[0], 1.0 / 1.2345, 1e-12);
    EXPECT_TRUE(stream.sent.back().held);
    EXPECT_EQ(stream.sent.back().state.position, pair(1, 2));
    EXPECT_TRUE(stream.sent.back().state.velocity.isZero(0.0));
    stream.expectIncreasing();
  }
}

TEST(MotionExecutor, LateSamplesSayTheirInstant) {
  Stream stream;
  stream.run(2);
  int sleeps = 0;
  stream.clock.lateness = [&sleeps] { return ++sleeps % 5 == 0 ? 35000000 : 80000; };
  const JointTrajectory main = move(pair(0, 0), pair(1, -1), 2.0);
  const auto started = stream.go(main);
  stream.run(300);
  const std::vector<Sent> inside = stream.window(started);
  ASSERT_EQ(inside.size(), 201U);
  TrajectoryPoint point(2);
  for (const Sent& one : inside) {
    main.sample(seconds(one.stamp - started.stamp), point);
    EXPECT_EQ(one.state.position, point.position);
  }
  stream.expectIncreasing();
}

TEST(MotionExecutor, AfterALongPauseItIsWhereTheClockIs) {
  Stream stream;
  stream.run(2);
  const auto started = stream.go(move(pair(0, 0), pair(1, -1), 2.0));
  stream.run(50);
  stream.clock.now += 10 * kNanosecondsPerSecond;
  stream.run(20);
  const std::vector<Sent> inside = stream.window(started);
  EXPECT_LT(inside.size(), 60U);
  EXPECT_EQ(inside.back().stamp, started.stamp + 2 * kNanosecondsPerSecond);
  EXPECT_EQ(inside.back().state.position, pair(1, -1));
  EXPECT_LE(stream.clock.now - stream.sent.back().stamp, kPeriod);
  stream.expectIncreasing();
}

TEST(MotionExecutor, AClockSetBackShiftsTheMotion) {
  Stream stream;
  stream.run(2);
  stream.go(move(pair(0, 0), pair(1, -1), 2.0));
  stream.run(50);
  stream.clock.now -= 3600 * kNanosecondsPerSecond;
  stream.run(160);
  EXPECT_LT(stream.sent.back().stamp, stream.clock.now + 1);
  EXPECT_EQ(stream.sent.back().state.position, pair(1, -1));
  for (std::size_t i = 1; i < stream.sent.size(); ++i) {
    EXPECT_LE((stream.sent[i].state.position - stream.sent[i - 1].state.position).cwiseAbs().maxCoeff(), 0.011);
  }
}

TEST(MotionExecutor, ReplacesInFlightContinuousToAcceleration) {
  for (int steps = 3; steps < 150; steps += 13) {
    Stream stream;
    stream.run(2);
    stream.go(move(pair(0, 0), pair(1, -1), 2.0));
    stream.run(steps);
    const auto started = stream.go(move(pair(-0.5, 0.3), pair(0.5, 0.7), 3.0));
    stream.run(700);
    EXPECT_GT(started.motion->lead().duration(), 0.0);
    EXPECT_EQ(stream.sent.back().state.position, pair(0.5, 0.7));
    stream.expectIncreasing();
    stream.expectSmooth();
  }
}

TEST(MotionExecutor, ReplacesWhatHasNotBegun) {
  Stream stream;
  stream.run(2);
  const auto first = stream.go(move(pair(0, 0), pair(1, -1), 2.0));
  const auto second = stream.go(move(pair(0, 0), pair(-1, 1), 2.0));
  EXPECT_EQ(first.stamp, second.stamp);
  stream.run(300);
  EXPECT_EQ(stream.sent.back().state.position, pair(-1, 1));
  stream.expectSmooth();
}

TEST(MotionExecutor, StopsWithinTheLimits) {
  for (int steps = 3; steps < 200; steps += 17) {
    Stream stream;
    stream.run(2);
    stream.go(move(pair(0, 0), pair(1, -1), 2.0));
    stream.run(steps);
    const auto stopped =
        stream.executor.replace([](const MotionState& present) { return Motion(stopFrom(present, limits())); });
    stream.run(200);
    EXPECT_LT(stopped.motion->duration(), 1.0);
    EXPECT_TRUE(stream.sent.back().held);
    stream.expectSmooth();
  }
}

TEST(MotionExecutor, StopsBeforeAPositionLimit) {
  MotionState present{pair(2.99, 0.0), pair(0.3, 0.0), pair(0.0, 0.0)};
  EXPECT_TRUE(keepsPositions(stopFrom(present, limits()), limits()));
  present.velocity[0] = 2.0;
  EXPECT_FALSE(keepsPositions(stopFrom(present, limits()), limits()));  // Nothing can: it is told to the caller.
}

TEST(MotionExecutor, AMakerThatIsTooSlowIsAskedAgain) {
  Stream stream;
  stream.run(2);
  stream.go(move(pair(0, 0), pair(1, -1), 2.0));
  stream.run(30);
  int calls = 0;
  const auto started = stream.executor.replace([&](const MotionState& present) {
    if (++calls < 3) stream.run(4 * calls);
    return Motion(stopFrom(present, limits()));
  });
  EXPECT_EQ(calls, 3);
  EXPECT_GT(started.stamp, stream.sent.back().stamp);
  stream.run(200);
  stream.expectSmooth();
}

TEST(MotionExecutor, AMakerThatThrowsChangesNothing) {
  Stream stream;
  stream.run(2);
  stream.go(move(pair(0, 0), pair(1, -1), 2.0));
  stream.run(30);
  EXPECT_THROW(stream.executor.replace(
                   [](const MotionState&) -> Motion { throw InputError(AnswerCode::kLimitsInfeasible, "no way"); }),
               InputError);
  stream.run(300);
  EXPECT_EQ(stream.sent.back().state.position, pair(1, -1));
}

TEST(MotionExecutor, WithoutTimeNothingStarts) {
  Stream stream;
  stream.clock.now = 0;
  EXPECT_THROW(stream.go(move(pair(0, 0), pair(1, -1), 2.0)), InputError);
}

TEST(MotionExecutor, AMotionOfNoDurationIsOneSample) {
  Stream stream;
  stream.run(2);
  const auto started = stream.go(move(pair(0, 0), pair(0, 0), 0.0));
  stream.run(10);
  EXPECT_EQ(stream.window(started).size(), 1U);
  stream.expectIncreasing();
}

TEST(MotionExecutor, StreamsFromAThreadOfItsOwn) {
  std::vector<Sent> sent;
  sent.reserve(10000);
  {
    MotionExecutor executor(pair(0, 0), 1000.0, limits(), wallMotionClock(), recorderInto(sent));
    executor.start();
    const auto started = executor.replace(
        [](const MotionState& present) { return startFrom(present, move(pair(0, 0), pair(0.1, 0.1), 0.3), limits()); });
    std::this_thread::sleep_for(std::chrono::milliseconds(900));
    executor.shutdown();
    EXPECT_GE(started.stamp, sent.front().stamp);
    EXPECT_EQ(executor.state().position, pair(0.1, 0.1));
  }
  ASSERT_GT(sent.size(), 500U);
  EXPECT_EQ(sent.back().state.position, pair(0.1, 0.1));
  for (std::size_t i = 1; i < sent.size(); ++i) EXPECT_GT(sent[i].stamp, sent[i - 1].stamp);
}

}  // namespace
}  // namespace ros_bridge
}  // namespace screwline
