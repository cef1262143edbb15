#ifndef SCREWLINE_TEST_UNIT_ROS_TRAJECTORY_STREAM_H
#define SCREWLINE_TEST_UNIT_ROS_TRAJECTORY_STREAM_H

#include <gtest/gtest.h>

#include <cmath>

#include "screwline/exception.h"
#include "unit/ros_trajectory_support.h"

namespace screwline {
namespace ros_bridge {

constexpr double kRate = 100.0;
constexpr Nanoseconds kPeriod = 10000000;

inline Limits limits() {
  Limits bounds = Limits::unlimited(2);
  bounds.velocity.setConstant(2.0);
  bounds.acceleration.setConstant(8.0);
  bounds.jerk.setConstant(80.0);
  bounds.lower = VectorX::Constant(2, -3.0);
  bounds.upper = VectorX::Constant(2, 3.0);
  return bounds;
}

inline JointTrajectory move(const VectorX& from, const VectorX& to, double duration) {
  return JointTrajectory::scaled(from, to - from, TimeLaw::polynomial345(), duration);
}

inline VectorX pair(double a, double b) {
  return Eigen::Vector2d(a, b);
}

struct Stream {
  FakeClock clock;
  std::vector<Sent> sent;
  MotionExecutor executor;

  explicit Stream(double rate = kRate) : executor(pair(0.0, 0.0), rate, limits(), clock.clock(), recorderInto(sent)) {}

  void run(int steps) {
    for (int i = 0; i < steps; ++i) ASSERT_TRUE(executor.step());
  }
  MotionExecutor::Started go(const JointTrajectory& main) {
    return executor.replace([&](const MotionState& present) { return startFrom(present, main, limits()); });
  }
  /// What was sent from `start` to its end, both included.
  std::vector<Sent> window(const MotionExecutor::Started& started) const {
    const Nanoseconds end = started.stamp + std::llround(1e9 * started.motion->duration());
    std::vector<Sent> inside;
    for (const Sent& one : sent)
      if (one.stamp >= started.stamp && one.stamp <= end) inside.push_back(one);
    return inside;
  }
  void expectIncreasing() const {
    for (std::size_t i = 1; i < sent.size(); ++i) ASSERT_GT(sent[i].stamp, sent[i - 1].stamp) << i;
  }
  /// No sample differs from the one before by more than the limits allow in the time between.
  void expectSmooth() const {
    for (std::size_t i = 1; i < sent.size(); ++i) {
      const double dt = seconds(sent[i].stamp - sent[i - 1].stamp);
      const auto step = [&](VectorX TrajectoryPoint::*field) {
        return (sent[i].state.*field - sent[i - 1].state.*field).cwiseAbs().maxCoeff();
      };
      ASSERT_LE(step(&TrajectoryPoint::position), 2.0 * dt * 1.001) << i;
      ASSERT_LE(step(&TrajectoryPoint::velocity), 8.0 * dt * 1.001) << i;
      ASSERT_LE(step(&TrajectoryPoint::acceleration), 80.0 * dt * 1.001 + 1e-9) << i;
    }
  }
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_TEST_UNIT_ROS_TRAJECTORY_STREAM_H
