// What every profile makes of waypoints: continuous joints, repeated ones, no move at all; times that are searched.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "property/trajectory_random.h"
#include "screwline/trajectory/bspline.h"
#include "screwline/trajectory/segment_times.h"

namespace screwline {
namespace trajectory_test {
namespace {

bool hasWaypoints(const ProfileSummary& profile) {
  return profile.name != "sinusoidal";
}

std::size_t countOf(const std::string& profile) {
  const bool many = profile.find("point") != std::string::npos || profile.find("spline") != std::string::npos ||
                    profile == "time_optimal" || profile == "path_time_optimal";
  return many ? 4 : profile.rfind("via", 0) == 0 ? 3 : 2;
}

VectorX endOf(const JointTrajectory& motion) {
  TrajectoryPoint point(motion.joints());
  motion.sample(motion.duration(), point);
  return point.position;
}

std::string allNotes(const PlanResult& result) {
  std::string text;
  for (const std::string& note : result.notes) text += note + "; ";
  return text;
}

TEST(ShortWay, EveryProfileTakesContinuousJointsByTheNearestTurn) {
  for (const ProfileSummary& profile : jointProfiles()) {
    if (!hasWaypoints(profile)) continue;
    Random random(91);
    for (int trial = 0; trial < 5; ++trial) {
      std::vector<VectorX> way;
      for (std::size_t k = 0; k < countOf(profile.name); ++k) way.push_back(random.vector(3, -12.0, 12.0));
      PlanRequest r = request(profile.name, way, limitsOf(3, 1.0, 4.0, 40.0));
      r.continuous = {0, 2};
      const PlanResult result = plan(r);
      const std::string what = profile.name + ", seed 91, trial " + std::to_string(trial);
      for (std::size_t k = 0; k < way.size(); ++k) {
        EXPECT_EQ(result.waypoints[k][1], way[k][1]) << what;
        for (const int joint : {0, 2}) {
          const double turns = (result.waypoints[k][joint] - way[k][joint]) / kTwoPi;
          EXPECT_NEAR(turns, std::round(turns), 1e-12) << what;
          const VectorX& before = result.waypoints[k > 0 ? k - 1 : 0];
          EXPECT_LE(std::abs(result.waypoints[k][joint] - before[joint]), kPi + 1e-8);
        }
      }
      EXPECT_LT((endOf(result.trajectory) - result.waypoints.back()).norm(), 1e-8) << what;
      const bool turned = (result.waypoints.back() - way.back()).norm() > 1.0;
      if (turned) {
        EXPECT_NE(allNotes(result).find("takes the short way"), std::string::npos) << what;
      }
      r.parameters = {{"keep_turns", 1.0}};
      EXPECT_LT((endOf(plan(r).trajectory) - way.back()).norm(), 1e-8) << what;
    }
  }
}

TEST(ShortWay, WhatIsNearStaysAndHalfATurnIsAsGiven) {
  PlanRequest r = request("polynomial_345", {vector({0.0}), vector({kPi})}, limitsOf(1, 1.0, 4.0, 40.0));
  r.continuous = {0};
  EXPECT_EQ(plan(r).waypoints.back()[0], kPi);
  EXPECT_TRUE(plan(r).notes.empty());
  r.waypoints.back().position = vector({-kPi});
  EXPECT_EQ(plan(r).waypoints.back()[0], -kPi);
  // Several turns by waypoints that are near to each other.
  r = request("multipoint_quintic", {vector({0.0}), vector({3.0}), vector({6.0}), vector({9.0})},
              limitsOf(1, 1.0, 4.0, 40.0));
  r.continuous = {0};
  EXPECT_EQ(plan(r).waypoints.back()[0], 9.0);
  r.continuous = {1};
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
  r.continuous = {0};
  r.parameters = {{"keep_turns", 0.5}};
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
}

TEST(Waypoints, EveryProfileStandsStillWhereNothingMovesAndPassesRepeatedOnes) {
  const Limits limits = limitsOf(2, 1.0, 4.0, 40.0);
  const VectorX A = vector({0.3, -0.2});
  const VectorX B = vector({1.0, 0.4});
  for (const ProfileSummary& profile : jointProfiles()) {
    if (!hasWaypoints(profile)) continue;
    const std::size_t count = countOf(profile.name);
    for (const double duration : {0.0, 2.0}) {
      PlanRequest still = request(profile.name, std::vector<VectorX>(count, A), limits);
      still.duration = duration;
      if (profile.name == "via_scalar") continue;  // It is fitted to the first joint, which has to move.
      const PlanResult result = plan(still);
      EXPECT_EQ(result.trajectory.duration(), duration) << profile.name;
      for (int j = 0; j < 2; ++j) EXPECT_EQ(result.trajectory.extrema(j).peak(1), 0.0) << profile.name;
      EXPECT_EQ((endOf(result.trajectory) - A).norm(), 0.0) << profile.name;
    }
    if (count < 4) continue;
    const PlanResult result = plan(request(profile.name, {A, A, B, B}, limits));
    EXPECT_LT((endOf(result.trajectory) - B).norm(), 1e-9) << profile.name;
    EXPECT_EQ(result.waypoint_times.size(), 4U);
    for (std::size_t k = 1; k < 4; ++k) EXPECT_GE(result.waypoint_times[k], result.waypoint_times[k - 1]);
  }
}

/// The duration in proportion to the weights that the search starts from.
double weightedDuration(const PlanRequest& r) {
  const std::vector<double> weights = segmentWeights(r.waypoints, r.limits);
  PlanRequest timed = r;
  double t = 0.0;
  for (std::size_t k = 1; k < r.waypoints.size(); ++k) timed.waypoints[k].time = 100.0 * (t += weights[k - 1]);
  const JointTrajectory motion = plan(timed).trajectory;
  return motion.duration() * tightestUse(motion, r.limits).stretch;
}

TEST(SegmentTimes, AreSearchedAndNeverWorseThanInProportion) {
  for (const char* profile : {"multipoint_cubic", "multipoint_quintic", "bspline_interpolating"}) {
    constexpr unsigned kSeed = 92;
    Random random(kSeed);
    double gain = 0.0;
    constexpr int kTrials = 12;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<VectorX> way;
      const int count = random.integer(3, 12);
      for (int k = 0; k < count; ++k) way.push_back(random.vector(4, -2.0, 2.0));
      const PlanRequest r = request(profile, way, randomLimits(random, 4));
      const PlanResult result = plan(r);
      const double weighted = weightedDuration(r);
      EXPECT_LE(result.trajectory.duration(), weighted * (1.0 + 1e-9)) << profile << ", seed 92, trial " << trial;
      EXPECT_LE(tightestUse(result.trajectory, r.limits).stretch, 1.0 + 1e-9);
      EXPECT_EQ(result.trajectory.duration(), plan(r).trajectory.duration()) << "the same in every run";
      gain += 1.0 - result.trajectory.duration() / weighted;
    }
    RecordProperty(profile, std::to_string(gain / kTrials));
    EXPECT_GT(gain / kTrials, 0.03) << profile;
  }
}

TEST(SegmentTimes, AreNearTheBestOfAGridOfRatios) {
  // Two segments: one ratio, so that all of it can be looked at.
  const Limits limits = limitsOf(2, 1.0, 3.0, 30.0);
  const std::vector<VectorX> way{vector({0.0, 0.0}), vector({0.4, 1.1}), vector({-0.5, 1.6})};
  for (const char* profile : {"multipoint_cubic", "multipoint_quintic", "bspline_interpolating"}) {
    const double found = plan(request(profile, way, limits)).trajectory.duration();
    double best = HUGE_VAL;
    for (int i = 1; i < 400; ++i) {
      PlanRequest r = request(profile, way, limits);
      r.waypoints[1].time = 1000.0 * i / 400;
      r.waypoints[2].time = 1000.0;
      const JointTrajectory motion = plan(r).trajectory;
      best = std::min(best, motion.duration() * tightestUse(motion, limits).stretch);
    }
    EXPECT_LE(found, best * 1.003) << profile;
    EXPECT_GE(found, best * 0.99) << profile;
  }
}

TEST(SegmentTimes, WithFixedVelocitiesTheyAreSearchedToo) {
  PlanRequest r = request("multipoint_quintic", {vector({0.0}), vector({0.3}), vector({2.0}), vector({1.0})},
                          limitsOf(1, 1.0, 4.0, 40.0));
  r.waypoints[1].velocity = vector({0.5});
  const PlanResult result = plan(r);
  TrajectoryPoint point(1);
  result.trajectory.sample(result.waypoint_times[1], point);
  EXPECT_NEAR(point.velocity[0], 0.5, 1e-9);
  EXPECT_LE(tightestUse(result.trajectory, r.limits).stretch, 1.0 + 1e-9);
  EXPECT_NE(allNotes(result).find("times of the segments are searched"), std::string::npos) << allNotes(result);
}

/// Ten waypoints of which a few have times, `factor` times those of the motion in which none is given.
PlanRequest partlyTimed(Random& random, const char* profile, double factor, bool end) {
  std::vector<VectorX> way;
  for (int k = 0; k < 9; ++k) way.push_back(random.vector(3, -2.0, 2.0));
  PlanRequest r = request(profile, way, randomLimits(random, 3));
  const PlanResult open = plan(r);
  for (const std::size_t k : {3U, 5U}) r.waypoints[k].time = factor * open.waypoint_times[k];
  if (end) r.duration = factor * open.trajectory.duration();
  return r;
}

/// The same with every time given: what the limits allow of it in proportion to the weights, as a factor of time.
double weightedUse(PlanRequest r) {
  const std::vector<double> weights = segmentWeights(r.waypoints, r.limits);
  r.waypoints.back().time = r.duration;
  for (std::size_t begin = 0, end = 1; end < r.waypoints.size(); ++end) {
    if (r.waypoints[end].time == 0.0) continue;
    double total = 0.0;
    for (std::size_t k = begin; k < end; ++k) total += weights[k];
    double t = r.waypoints[begin].time;
    const double span = r.waypoints[end].time - t;
    for (std::size_t k = begin; k + 1 < end; ++k) r.waypoints[k + 1].time = t += span * weights[k] / total;
    begin = end;
  }
  const Limits limits = r.limits;
  r.limits = Limits::unlimited(limits.joints());
  return tightestUse(plan(r).trajectory, limits).stretch;
}

TEST(GivenTimes, AreKeptExactlyAndTheOthersUseLessOfTheLimitsThanByWeights) {
  for (const char* profile : {"multipoint_cubic", "multipoint_quintic", "bspline_interpolating"}) {
    constexpr unsigned kSeed = 94;
    Random random(kSeed);
    double gain = 0.0;
    constexpr int kTrials = 6;
    for (int trial = 0; trial < kTrials; ++trial) {
      const std::string what = std::string(profile) + ", seed 94, trial " + std::to_string(trial);
      const PlanRequest r = partlyTimed(random, profile, 1.4, true);
      const PlanResult result = plan(r);
      for (const std::size_t k : {3U, 5U}) EXPECT_EQ(result.waypoint_times[k], r.waypoints[k].time) << what;
      EXPECT_EQ(result.trajectory.duration(), r.duration) << what;
      EXPECT_LT(result.via_joint_errors.cwiseAbs().maxCoeff(), 1e-9) << what;
      const double use = tightestUse(result.trajectory, r.limits).stretch;
      const double weighted = weightedUse(r);
      EXPECT_LE(use, weighted * (1.0 + 1e-9)) << what;
      gain += 1.0 - use / weighted;
    }
    RecordProperty(profile, std::to_string(gain / kTrials));
    EXPECT_GT(gain / kTrials, 0.02) << profile;
  }
}

TEST(GivenTimes, AnOpenEndIsAsEarlyAsTheLimitsAllow) {
  for (const char* profile : {"multipoint_cubic", "bspline_interpolating"}) {
    Random random(95);
    for (int trial = 0; trial < 3; ++trial) {
      const PlanRequest r = partlyTimed(random, profile, 1.2, false);
      const PlanResult result = plan(r);
      const std::string what = std::string(profile) + ", seed 95, trial " + std::to_string(trial);
      for (const std::size_t k : {3U, 5U}) EXPECT_EQ(result.waypoint_times[k], r.waypoints[k].time) << what;
      EXPECT_LE(tightestUse(result.trajectory, r.limits).stretch, 1.0 + 1e-9) << what;
      // With the instants that were found, an earlier end passes the limits.
      PlanRequest earlier = r;
      for (std::size_t k = 0; k < r.waypoints.size(); ++k) earlier.waypoints[k].time = result.waypoint_times[k];
      EXPECT_EQ(errorOf(earlier), AnswerCode::kSuccess) << what;
      double& last = earlier.waypoints.back().time;
      last -= 1e-3 * (last - result.waypoint_times[7]);
      EXPECT_EQ(errorOf(earlier), AnswerCode::kLimitsInfeasible) << what;
    }
  }
}

TEST(GivenTimes, TooTightOnesAreRefusedWithARangeThatHolds) {
  for (const char* profile : {"multipoint_trapezoidal", "multipoint_cubic", "multipoint_quintic", "via_per_joint"}) {
    const bool via = std::string(profile).rfind("via", 0) == 0;
    PlanRequest r =
        request(profile, {vector({0.0}), vector({1.0}), vector({2.0}), vector({2.5})}, limitsOf(1, 1.0, 4.0, 1e3));
    if (via) r.waypoints.pop_back();
    r.waypoints[1].time = 0.3;  // The first line takes a second and more.
    r.duration = 8.0;
    const std::string message = messageOf(r);
    const std::string wanted = "waypoints[1].time is 0.3 s, with all else as given ";
    const std::size_t at = message.find(wanted);
    ASSERT_NE(at, std::string::npos) << profile << ": " << message;
    double lower = 0.0, upper = 0.0;
    ASSERT_EQ(std::sscanf(message.c_str() + at + wanted.size(), "%lf s to %lf s are feasible", &lower, &upper), 2)
        << message;
    EXPECT_LT(lower, upper);
    for (const double inside : {lower, 0.5 * (lower + upper), upper}) {
      r.waypoints[1].time = inside;
      EXPECT_EQ(errorOf(r), AnswerCode::kSuccess) << profile << " " << inside << ": " << messageOf(r);
    }
    for (const double outside : {lower - 0.01, upper + 0.01}) {
      r.waypoints[1].time = outside;
      EXPECT_EQ(errorOf(r), AnswerCode::kLimitsInfeasible) << profile << " " << outside;
    }
  }
}

TEST(GivenTimes, TheLastOneHasNoUpperBoundAndStretchHelpsAll) {
  PlanRequest r = request("multipoint_cubic", {vector({0.0}), vector({1.0}), vector({2.0}), vector({2.5})},
                          limitsOf(1, 1.0, 4.0, 40.0));
  r.waypoints[1].time = 2.0;
  r.waypoints[3].time = 2.5;
  const std::string message = messageOf(r);
  const std::string wanted = "waypoints[3].time is 2.5 s, with all else as given ";
  const std::size_t at = message.find(wanted);
  ASSERT_NE(at, std::string::npos) << message;
  EXPECT_NE(message.find("s and more are feasible"), std::string::npos) << message;
  PlanRequest mended = r;
  mended.waypoints[3].time = std::stod(message.substr(at + wanted.size()));
  EXPECT_EQ(errorOf(mended), AnswerCode::kSuccess) << messageOf(mended);
  r.parameters = {{"stretch", 1.0}};
  const PlanResult stretched = plan(r);
  EXPECT_NEAR(stretched.waypoint_times[1] / stretched.trajectory.duration(), 2.0 / 2.5, 1e-9);
}

TEST(BsplineEnds, VelocitiesAndAccelerationsAreMetInEveryDegree) {
  std::vector<VectorX> way;
  for (int k = 0; k < 8; ++k) way.push_back(vector({0.6 * k, std::cos(1.1 * k)}));
  for (const char* profile : {"bspline", "bspline_interpolating"}) {
    for (const double degree : {3.0, 4.0, 5.0, 6.0, 7.0}) {
      PlanRequest r = request(profile, way, limitsOf(2, 1.0, 4.0, 40.0));
      r.parameters = {{"degree", degree}};
      r.waypoints.front().velocity = vector({0.3, -0.2});
      r.waypoints.front().acceleration = vector({0.4, 0.1});
      r.waypoints.back().velocity = vector({0.2, 0.5});
      const PlanResult result = plan(r);
      TrajectoryPoint point(2);
      result.trajectory.sample(0.0, point);
      EXPECT_LT((point.position - way.front()).norm(), 1e-9);
      EXPECT_LT((point.velocity - r.waypoints.front().velocity).norm(), 1e-9) << profile << degree;
      EXPECT_LT((point.acceleration - r.waypoints.front().acceleration).norm(), 1e-8) << profile << degree;
      result.trajectory.sample(result.trajectory.duration(), point);
      EXPECT_LT((point.position - way.back()).norm(), 1e-9);
      EXPECT_LT((point.velocity - r.waypoints.back().velocity).norm(), 1e-9) << profile << degree;
      EXPECT_LT(point.acceleration.norm(), 1e-8) << profile << degree;
      EXPECT_LE(tightestUse(result.trajectory, r.limits).stretch, 1.0 + 1e-9) << profile << degree;
      EXPECT_EQ(result.via_joint_errors.isZero(1e-9), std::string(profile) == "bspline_interpolating");
      r.waypoints[3].velocity = vector({0.1, 0.1});
      EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
    }
  }
  PlanRequest open = request("bspline", way, limitsOf(2, 1.0, 4.0, 40.0));
  open.parameters = {{"rest_ends", 0.0}};
  open.waypoints.front().velocity = vector({0.3, 0.0});
  EXPECT_EQ(errorOf(open), AnswerCode::kInvalidGoal);
}

}  // namespace
}  // namespace trajectory_test
}  // namespace screwline
