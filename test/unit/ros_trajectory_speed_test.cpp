// Pause, resume and speed of what is streamed, under a clock that is turned by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/ros_trajectory_stream.h"

namespace screwline {
namespace ros_bridge {
namespace {

TEST(MotionExecutor, PausesAndResumesOnItsPath) {
  for (int steps = 5; steps < 150; steps += 9) {
    Stream stream;
    stream.run(2);
    const JointTrajectory main = move(pair(0, 0), pair(1, -1), 2.0);
    stream.go(main);
    stream.run(steps);
    const auto turn = stream.executor.pause();
    ASSERT_TRUE(turn.moving);
    stream.run(300);
    EXPECT_TRUE(stream.executor.paused());
    if (!turn.ends_first) {
      EXPECT_TRUE(stream.sent.back().state.velocity.isZero(0.0)) << steps;
      EXPECT_FALSE(stream.sent.back().held);
      EXPECT_LT(stream.sent.back().tau, 1.0);
      EXPECT_EQ(stream.sent.back().state.position, stream.sent[stream.sent.size() - 50].state.position);
    }
    stream.executor.resume();
    stream.run(500);
    EXPECT_EQ(stream.sent.back().state.position, pair(1, -1));
    EXPECT_TRUE(stream.sent.back().held);
    stream.expectIncreasing();
    stream.expectSmooth();
    TrajectoryPoint point(2);
    for (const Sent& one : stream.sent) {  // Wherever the clock is, the robot is on the path at the tau that is sent.
      if (!one.scaled) continue;
      main.sample(2.0 * one.tau, point);
      ASSERT_LT((one.state.position - point.position).norm(), 1e-12);
    }
  }
}

TEST(MotionExecutor, FollowsAPathAtAnySpeed) {
  Stream stream;
  stream.run(2);
  stream.executor.setSpeed(0.5);
  const auto started = stream.go(move(pair(0, 0), pair(1, -1), 2.0));
  stream.run(390);
  EXPECT_FALSE(stream.sent.back().held);
  stream.run(20);
  EXPECT_TRUE(stream.sent.back().held);
  double fastest = 0.0;
  for (const Sent& one : stream.sent) fastest = std::max(fastest, one.state.velocity[0]);
  EXPECT_NEAR(fastest, 0.5 * 1.875 / 2.0, 1e-4);
  EXPECT_EQ(started.motion->duration(), 2.0);
  stream.go(move(pair(1, -1), pair(0, 0), 2.0));
  for (const double speed : {0.1, 1.0, 0.0, 0.7, 0.3, 1.0}) {
    stream.run(40);
    stream.executor.setSpeed(speed);
  }
  stream.run(400);
  EXPECT_EQ(stream.sent.back().state.position, pair(0, 0));
  stream.expectSmooth();
  for (const double wrong : {-0.1, 1.01, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(stream.executor.setSpeed(wrong), InputError);
  }
  EXPECT_EQ(stream.executor.speed(), 1.0);
}

TEST(MotionExecutor, ReplacesAndStopsWhateverTheSpeed) {
  for (const double speed : {0.0, 0.2, 0.6}) {
    for (int wait = 1; wait < 40; wait += 6) {
      Stream stream;
      stream.run(2);
      stream.go(move(pair(0, 0), pair(1, -1), 2.0));
      stream.run(70);
      stream.executor.setSpeed(speed);
      stream.run(wait);
      stream.go(move(pair(-0.5, 0.3), pair(0.5, 0.7), 3.0));
      stream.run(200);
      stream.executor.setSpeed(1.0);
      stream.run(700);
      EXPECT_EQ(stream.sent.back().state.position, pair(0.5, 0.7)) << speed << ", " << wait;
      stream.expectSmooth();
    }
  }
  Stream stream;
  stream.run(2);
  stream.go(move(pair(0, 0), pair(1, -1), 2.0));
  stream.run(60);
  stream.executor.pause();
  stream.run(5);
  stream.executor.replace([](const MotionState& present) { return Motion(stopFrom(present, limits())); },
                          MotionExecutor::Pace::kRealTime);
  stream.run(100);
  EXPECT_TRUE(stream.sent.back().held);
  EXPECT_FALSE(stream.executor.paused());
  stream.expectSmooth();
}

TEST(MotionExecutor, APauseHoldsForWhatIsExecutedLater) {
  Stream stream;
  stream.run(2);
  EXPECT_FALSE(stream.executor.pause().moving);
  stream.go(move(pair(0, 0), pair(1, -1), 1.0));
  stream.run(300);
  EXPECT_TRUE(stream.sent.back().state.position.isZero(0.0));
  EXPECT_TRUE(stream.executor.resume().moving);
  stream.run(300);
  EXPECT_EQ(stream.sent.back().state.position, pair(1, -1));
  stream.expectSmooth();
}

}  // namespace
}  // namespace ros_bridge
}  // namespace screwline
