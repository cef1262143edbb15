// Laws of time-optimal state-to-state motions over random questions.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "property/trajectory_optimal_random.h"
#include "screwline/trajectory/verify.h"

namespace screwline {
namespace {

using trajectory_test::brokenLaw;
using trajectory_test::lawCount;
using trajectory_test::Questions;

class TimeOptimal : public testing::Test {
 protected:
  std::unique_ptr<StateToState> question_ = std::make_unique<StateToState>();
  std::unique_ptr<StateToStateMotion> motion_ = std::make_unique<StateToStateMotion>();
};

TEST_F(TimeOptimal, EveryQuestionIsAnsweredWithinLimitsAndMeetsItsEnds) {
  constexpr unsigned kSeed = 81;
  Questions random(kSeed);
  const int count = lawCount(20000);
  for (int trial = 0; trial < count; ++trial) {
    random.fill(*question_, random.integer(1, 7));
    moveStateToState(*question_, *motion_);
    ASSERT_EQ(motion_->status, MotionStatus::kFound) << "seed 81, trial " << trial << ": " << describe(*motion_);
    ASSERT_EQ(brokenLaw(*question_, *motion_), "") << "seed 81, trial " << trial;
  }
}

/// Whether a joint has a motion of duration T, from the two extreme motions alone.
bool canTake(const StateToState& q, double T) {
  const ExtremeMotion up(q.from[0], q.to[0], q.limits[0]);
  const ExtremeMotion down = ExtremeMotion::downward(q.from[0], q.to[0], q.limits[0]);
  if (T < up.least()) return false;
  for (const auto& window : {up.window(), down.window()}) {
    if (T > window.last && T < window.next) return false;
  }
  const double d = q.to[0].position - q.from[0].position;
  return up.at(T).displacement >= d && down.at(T).displacement >= -d;
}

TEST_F(TimeOptimal, NoShorterDurationIsFeasible) {
  Questions random(82);
  for (int trial = 0; trial < 4000; ++trial) {
    random.fill(*question_, 1);
    question_->least_duration = 0.0;
    moveStateToState(*question_, *motion_);
    EXPECT_TRUE(motion_->duration == 0.0 || canTake(*question_, motion_->duration * (1.0 + 1e-9)) ||
                motion_->axes[0].nextDuration(motion_->duration * (1.0 + 1e-9)) > motion_->duration * (1.0 + 2e-9))
        << "seed 82, trial " << trial;
    if (motion_->duration == 0.0) continue;
    for (int i = 1; i < 200; ++i) {
      const double T = motion_->duration * (1.0 - 1e-7) * i / 200.0;
      ASSERT_FALSE(canTake(*question_, T)) << "seed 82, trial " << trial << ", T " << T << " of " << motion_->duration;
    }
  }
}

TEST_F(TimeOptimal, BlockedIntervalsAreThoseThatTheExtremesLeaveOut) {
  Questions random(83);
  int blocked = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    random.fill(*question_, 1);
    moveStateToState(*question_, *motion_);
    const double least = motion_->shortest[0];
    for (int i = 1; i < 100; ++i) {
      const double T = least * (1.0 + 0.03 * i);
      const double next = motion_->axes[0].nextDuration(T);
      ASSERT_GE(next, T);
      if (next == T) continue;
      ++blocked;
      ASSERT_FALSE(canTake(*question_, 0.5 * (T + next))) << "seed 83, trial " << trial;
    }
  }
  EXPECT_GT(blocked, 100) << "no blocked interval was met: the test is blind";
}

TEST_F(TimeOptimal, BackwardsInTimeIsAsLong) {
  Questions random(84);
  for (int trial = 0; trial < 3000; ++trial) {
    random.fill(*question_, 1);
    moveStateToState(*question_, *motion_);
    const double there = motion_->duration;
    const EndState from = question_->from[0];
    question_->from[0] = {question_->to[0].position, -question_->to[0].velocity, question_->to[0].acceleration};
    question_->to[0] = {from.position, -from.velocity, from.acceleration};
    AxisLimits& l = question_->limits[0];
    l.velocity = {-l.velocity.upper, -l.velocity.lower};
    l.jerk = {-l.jerk.upper, -l.jerk.lower};
    moveStateToState(*question_, *motion_);
    ASSERT_EQ(motion_->status, MotionStatus::kFound) << "seed 84, trial " << trial;
    ASSERT_NEAR(motion_->duration, there, 1e-7 * there) << "seed 84, trial " << trial;
  }
}

TEST_F(TimeOptimal, ScalesOfLengthAndTimeCarryOver) {
  Questions random(85);
  for (int trial = 0; trial < 3000; ++trial) {
    random.fill(*question_, 1);
    question_->least_duration = 0.0;
    moveStateToState(*question_, *motion_);
    const double once = motion_->duration;
    const double length = random.power(-9.0, 6.0);
    const double time = random.power(-3.0, 3.0);
    const double v = length / time, a = v / time, j = a / time;
    for (EndState* s : {&question_->from[0], &question_->to[0]})
      *s = {s->position * length, s->velocity * v, s->acceleration * a};
    AxisLimits& l = question_->limits[0];
    l.velocity = {l.velocity.lower * v, l.velocity.upper * v};
    l.acceleration = {l.acceleration.lower * a, l.acceleration.upper * a};
    l.jerk = {l.jerk.lower * j, l.jerk.upper * j};
    moveStateToState(*question_, *motion_);
    ASSERT_EQ(motion_->status, MotionStatus::kFound) << "seed 85, trial " << trial;
    ASSERT_NEAR(motion_->duration, once * time, 1e-7 * once * time + 1e-12 * time) << "seed 85, trial " << trial;
  }
}

TEST_F(TimeOptimal, WhatIsLeftOfAMotionTakesWhatIsLeftOfItsTime) {
  Questions random(86);
  for (int trial = 0; trial < 3000; ++trial) {
    random.fill(*question_, 1);
    question_->least_duration = 0.0;
    moveStateToState(*question_, *motion_);
    const double whole = motion_->duration;
    const double passed = whole * random.uniform(0.0, 0.999);
    question_->from[0] = motion_->phases[0].at(passed);
    // On the way to a goal from which the limits will be left, a state may be bound to leave them: it would brake.
    if (checkState(question_->from[0], question_->limits[0], true).fault != StateFault::kNone) continue;
    moveStateToState(*question_, *motion_);
    ASSERT_EQ(motion_->status, MotionStatus::kFound) << "seed 86, trial " << trial;
    ASSERT_NEAR(motion_->duration, whole - passed, 1e-4 * whole) << "seed 86, trial " << trial;
    ASSERT_EQ(brokenLaw(*question_, *motion_), "") << "seed 86, trial " << trial;
  }
}

TEST_F(TimeOptimal, WiderLimitsAreNeverSlower) {
  Questions random(87);
  for (int trial = 0; trial < 3000; ++trial) {
    random.fill(*question_, 1);
    question_->least_duration = 0.0;
    moveStateToState(*question_, *motion_);
    const double narrow = motion_->duration;
    AxisLimits& l = question_->limits[0];
    Range* ranges[] = {&l.velocity, &l.acceleration, &l.jerk};
    Range& wider = *ranges[random.integer(0, 2)];
    wider = {wider.lower * 1.3, wider.upper * 1.7};
    moveStateToState(*question_, *motion_);
    ASSERT_LE(motion_->duration, narrow * (1.0 + 1e-9) + 1e-12) << "seed 87, trial " << trial;
  }
}

TEST_F(TimeOptimal, PiecesOfAllJointsPassTheIndependentCheck) {
  Questions random(88);
  for (int trial = 0; trial < 2000; ++trial) {
    const int n = random.integer(1, 7);
    random.fill(*question_, n);
    Limits limits = Limits::unlimited(n);
    std::vector<Checkpoint> ends(2, Checkpoint{0.0, VectorX::Zero(n)});
    for (int j = 0; j < n; ++j) {
      const std::size_t i = static_cast<std::size_t>(j);
      const AxisLimits& l = question_->limits[i];
      limits.velocity[j] = l.velocity.peak();
      limits.acceleration[j] = l.acceleration.peak();
      limits.jerk[j] = l.jerk.peak();
      ends[0].position[j] = question_->from[i].position;
      ends[1].position[j] = question_->to[i].position;
    }
    moveStateToState(*question_, *motion_);
    const JointTrajectory trajectory = trajectoryOf(*motion_);
    ends[1].time = trajectory.duration();
    // Instants of a long motion are rounded to what is much of its short phases.
    if ((limits.jerk.array() * trajectory.duration() > 1e5 * limits.acceleration.array()).any()) continue;
    const auto broken = verifyTrajectory(trajectory, limits, ends);
    ASSERT_FALSE(broken.has_value()) << "seed 88, trial " << trial << ": " << *broken;
  }
}

TEST_F(TimeOptimal, PositionLimitsAreKeptOrThePositionThatBreaksThemIsNamed) {
  Questions random(89);
  int kept = 0, longer = 0, refused = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    random.fill(*question_, random.integer(1, 4));
    for (auto& limits : question_->limits) limits.position = {-HUGE_VAL, HUGE_VAL};
    moveStateToState(*question_, *motion_);
    const double free = motion_->duration;
    for (std::size_t j = 0; j < static_cast<std::size_t>(question_->joints); ++j) {
      const double a = question_->from[j].position, b = question_->to[j].position;
      const double margin = random.power(-3.0, 1.0);
      question_->limits[j].position = {std::min(a, b) - margin, std::max(a, b) + margin};
    }
    moveStateToState(*question_, *motion_);
    if (motion_->status == MotionStatus::kPosition) {
      const double value = motion_->check.value;
      ASSERT_FALSE(value >= motion_->check.feasible.lower && value <= motion_->check.feasible.upper)
          << "seed 89, trial " << trial;
      ++refused;
      continue;
    }
    ASSERT_EQ(motion_->status, MotionStatus::kFound) << "seed 89, trial " << trial;
    ASSERT_EQ(brokenLaw(*question_, *motion_), "") << "seed 89, trial " << trial;
    for (std::size_t j = 0; j < static_cast<std::size_t>(question_->joints); ++j) {
      const Range way = motion_->phases[j].extent().position;
      ASSERT_GE(way.lower, question_->limits[j].position.lower - 1e-9) << "seed 89, trial " << trial;
      ASSERT_LE(way.upper, question_->limits[j].position.upper + 1e-9) << "seed 89, trial " << trial;
    }
    ASSERT_GE(motion_->duration, free);
    ++kept;
    longer += motion_->duration > free * (1.0 + 1e-9);
  }
  EXPECT_GT(kept, 1000);
  EXPECT_GT(longer, 0);
  EXPECT_GT(refused, 100);
  RecordProperty("kept_longer_refused",
                 std::to_string(kept) + " " + std::to_string(longer) + " " + std::to_string(refused));
}

}  // namespace
}  // namespace screwline
