// The checker that every plan passes: that it passes sound motions, and none that is not.
#include "screwline/trajectory/verify.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "property/trajectory_random.h"
#include "screwline/trajectory/hermite.h"

namespace screwline {
namespace {

using trajectory_test::limitsOf;
using trajectory_test::planned;
using trajectory_test::Random;
using trajectory_test::randomRequest;
using trajectory_test::request;
using trajectory_test::vector;

std::string verdict(const JointTrajectory& motion, const Limits& limits, const std::vector<Checkpoint>& points = {}) {
  return verifyTrajectory(motion, limits, points).value_or("");
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

VectorX& boundOf(Limits& limits, int order) {
  return order == 1 ? limits.velocity : order == 2 ? limits.acceleration : limits.jerk;
}

/// Limits a hair above the exact peaks pass, a hair below fail, in every profile and each finite order.
TEST(Verify, FindsEveryPeakOfEveryProfile) {
  Random random(81);
  int checked = 0;
  for (const ProfileSummary& profile : listProfiles()) {
    for (int trial = 0; trial < 12; ++trial) {
      JointTrajectory motion;
      try {
        motion = plan(randomRequest(random, profile.name)).trajectory;
      } catch (const InputError&) {
        continue;
      }
      for (int joint = 0; joint < motion.joints(); ++joint) {
        const JointExtrema extrema = motion.extrema(joint);
        for (int order = 1; order <= 3; ++order) {
          const double peak = extrema.peak(order);
          if (!std::isfinite(peak) || peak < 1e-9) continue;
          Limits limits = Limits::unlimited(motion.joints());
          boundOf(limits, order)[joint] = peak * (1.0 + 1e-9);
          EXPECT_EQ(verdict(motion, limits), "") << profile.name << ", seed 81, trial " << trial;
          boundOf(limits, order)[joint] = peak * (1.0 - 1e-6);
          EXPECT_TRUE(says(verdict(motion, limits), "joint " + std::to_string(joint) + ": "))
              << profile.name << ", seed 81, trial " << trial << ", order " << order;
          ++checked;
        }
      }
    }
  }
  EXPECT_GT(checked, 500);
}

TEST(Verify, FindsPositionsPastTheirBoundsInEveryForm) {
  Random random(82);
  for (const ProfileSummary& profile : listProfiles()) {
    JointTrajectory motion;
    try {
      motion = plan(randomRequest(random, profile.name)).trajectory;
    } catch (const InputError&) {
      continue;
    }
    const Range range = motion.extrema(0).position;
    if (range.upper - range.lower < 1e-3) continue;
    Limits limits = Limits::unlimited(motion.joints());
    limits.lower = VectorX::Constant(motion.joints(), -1e3);
    limits.upper = VectorX::Constant(motion.joints(), 1e3);
    limits.upper[0] = range.upper;
    limits.lower[0] = range.lower;
    EXPECT_EQ(verdict(motion, limits), "") << profile.name;
    limits.upper[0] = range.upper - 1e-6;
    EXPECT_TRUE(says(verdict(motion, limits), "its upper limit is")) << profile.name << verdict(motion, limits);
    limits.upper[0] = range.upper;
    limits.lower[0] = range.lower + 1e-6;
    EXPECT_TRUE(says(verdict(motion, limits), "its lower limit is")) << profile.name << verdict(motion, limits);
  }
}

/// A spike of 2 ms between samples 10 ms apart: no sampled check sees it.
TEST(Verify, ASpikeBetweenSamples) {
  const std::vector<double> times{0.0, 0.501, 0.502, 0.503, 1.0};
  MatrixX positions(1, 5), velocities = MatrixX::Zero(1, 5), accelerations = MatrixX::Zero(1, 5);
  positions << 0.0, 0.0, 0.002, 0.0, 0.0;
  const JointTrajectory motion =
      JointTrajectory::piecewise(quinticsThrough(times, positions, velocities, accelerations));
  TrajectoryPoint point(1);
  for (int i = 0; i <= 100; ++i) {
    motion.sample(0.01 * i, point);
    ASSERT_LT(std::abs(point.velocity[0]), 1e-12);
  }
  const std::string text = verdict(motion, limitsOf(1, 1.0, HUGE_VAL, HUGE_VAL));
  EXPECT_TRUE(says(text, "joint 0: velocity reaches")) << text;
  EXPECT_TRUE(says(text, " at 0.50")) << text;
}

TEST(Verify, SaysWhenAndByHowMuch) {
  Sinusoid wave{vector({0.0}), vector({0.5}), vector({2.0}), vector({0.0})};
  const JointTrajectory swing = JointTrajectory::sinusoidal(wave, 3.0);
  EXPECT_EQ(verdict(swing, limitsOf(1, 1.0, 2.0, 4.0)), "");
  EXPECT_TRUE(says(verdict(swing, limitsOf(1, 0.9, 2.0, 4.0)), "velocity reaches"));
  EXPECT_TRUE(says(verdict(swing, limitsOf(1, 1.0, 1.9, 4.0)), "acceleration reaches"));
  wave.amplitude[0] = std::nan("");
  EXPECT_NE(verdict(JointTrajectory::sinusoidal(wave, 3.0), Limits::unlimited(1)), "");
  wave.amplitude[0] = HUGE_VAL;
  EXPECT_NE(verdict(JointTrajectory::sinusoidal(wave, 3.0), Limits::unlimited(1)), "");
  PiecewisePolynomial jump = *planned("multipoint_cubic", {vector({0.0}), vector({1.0}), vector({0.5})}).pieces();
  jump.at(1, 0, 0) += 1e-3;
  const std::string text = verdict(JointTrajectory::piecewise(jump), Limits::unlimited(1));
  EXPECT_TRUE(says(text, "derivative 0 steps by 0.001")) << text;
  EXPECT_TRUE(says(text, " at ")) << text;
}

/// A step of a millionth in any derivative that a motion promises to be continuous, at any breakpoint.
TEST(Verify, AStepOfAMillionth) {
  Random random(83);
  int checked = 0;
  for (const char* profile : {"multipoint_cubic", "multipoint_quintic", "bspline", "bspline_interpolating",
                              "time_optimal", "double_s", "trapezoidal", "multipoint_trapezoidal"}) {
    for (int trial = 0; trial < 6; ++trial) {
      const std::vector<VectorX> way{vector({0.0, 0.1}), vector({random.uniform(0.5, 1.0), random.uniform(-1.0, 1.0)}),
                                     vector({random.uniform(-1.0, 0.0), 0.3})};
      const bool two = std::string(profile) == "double_s" || std::string(profile) == "trapezoidal";
      const JointTrajectory motion = planned(profile, two ? std::vector<VectorX>{way[0], way[1]} : way);
      const bool scaled = motion.scaling() != nullptr;
      const PiecewisePolynomial pieces = scaled ? motion.scaling()->pieces() : *motion.pieces();
      EXPECT_EQ(verdict(motion, Limits::unlimited(2)), "") << profile;
      for (int order = 0; order <= pieces.continuity; ++order) {
        for (std::size_t k = 1; k < pieces.segments(); ++k) {
          // Beside pieces of nanoseconds a step is not told from rounding.
          const double h = pieces.length(k);
          if (std::min(h, pieces.length(k - 1)) < 1e-3 * pieces.duration()) continue;
          const int joint = scaled ? 0 : 1;
          const JointExtrema e = pieces.extrema(joint);
          const double size[] = {std::max(1.0, e.position.peak()), e.velocity, e.acceleration};
          PiecewisePolynomial broken = pieces;
          // c_order = value * h^order / order!
          broken.at(k, order, joint) += 1e-6 * size[order] * std::pow(h, order) / (order == 2 ? 2.0 : 1.0);
          const JointTrajectory stepping =
              scaled ? JointTrajectory::scaled(motion.start(), motion.delta(), TimeLaw(broken), motion.duration())
                     : JointTrajectory::piecewise(broken);
          EXPECT_TRUE(says(verdict(stepping, Limits::unlimited(2)), "steps by"))
              << profile << ", seed 83, trial " << trial << ", order " << order << ", piece " << k;
          ++checked;
        }
      }
    }
  }
  EXPECT_GT(checked, 300);
}

TEST(Verify, WaypointsAreMetInTheirOrder) {
  const JointTrajectory motion = planned("polynomial_345", {vector({0.0}), vector({1.0})}, 4.0);
  const Limits limits = limitsOf(1, 1.0, 4.0, 40.0);
  EXPECT_EQ(verdict(motion, limits, {{0.0, vector({0.0})}, {2.0, vector({0.5})}, {4.0, vector({1.0})}}), "");
  EXPECT_TRUE(says(verdict(motion, limits, {{2.0, vector({0.51})}}), "misses its waypoint at 2 s by 0.01 in position"));
  EXPECT_TRUE(says(verdict(motion, limits, {{2.0, vector({0.5}), vector({0.4})}}), "in velocity"));
  EXPECT_TRUE(says(verdict(motion, limits, {{2.0, vector({0.5}), {}, vector({0.1})}}), "in acceleration"));
  EXPECT_TRUE(says(verdict(motion, limits, {{2.0, vector({0.5})}, {1.0, vector({0.1})}}), "instant is 1 s"));
  EXPECT_TRUE(says(verdict(motion, limits, {{5.0, vector({1.0})}}), "instant is 5 s"));
}

TEST(Stretch, LengthensOnlyWhereItIsAskedTo) {
  Random random(83);
  for (const ProfileSummary& profile : listProfiles()) {
    if (profile.name == "sinusoidal") continue;
    for (int trial = 0; trial < 5; ++trial) {
      PlanRequest r = randomRequest(random, profile.name);
      double shortest = 0.0;
      try {
        shortest = plan(r).trajectory.duration();
      } catch (const InputError&) {
        continue;
      }
      if (shortest == 0.0) continue;
      r.duration = 0.5 * shortest;
      EXPECT_EQ(trajectory_test::errorOf(r), AnswerCode::kLimitsInfeasible) << profile.name;
      EXPECT_TRUE(says(trajectory_test::messageOf(r), "shortest")) << trajectory_test::messageOf(r);
      r.parameters.push_back({"stretch", 1.0});
      const PlanResult result = plan(r);
      EXPECT_NEAR(result.trajectory.duration(), shortest, 1e-6 * shortest) << profile.name;
      EXPECT_TRUE(says(result.notes.front(), "stretched to")) << result.notes.front();
      r.duration = 2.0 * shortest;
      EXPECT_EQ(plan(r).trajectory.duration(), r.duration) << profile.name << ": long enough, so not touched";
    }
  }
}

TEST(Stretch, KeepsTheProportionsOfGivenTimes) {
  PlanRequest r = request("multipoint_cubic", {vector({0.0}), vector({1.0}), vector({0.5})}, limitsOf(1, 1, 4, 40));
  r.waypoints[1].time = 0.2;
  r.waypoints[2].time = 0.3;
  EXPECT_EQ(trajectory_test::errorOf(r), AnswerCode::kLimitsInfeasible);
  r.parameters = {{"stretch", 1.0}};
  const PlanResult result = plan(r);
  EXPECT_NEAR(result.waypoint_times[1] / result.waypoint_times[2], 2.0 / 3.0, 1e-9);
  EXPECT_NEAR(tightestUse(result.trajectory, r.limits).stretch, 1.0, 1e-6);
  r.parameters = {{"stretch", 0.5}};
  EXPECT_EQ(trajectory_test::errorOf(r), AnswerCode::kInvalidGoal);
}

}  // namespace
}  // namespace screwline
