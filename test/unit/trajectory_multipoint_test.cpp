// Profiles through several waypoints and the free ones: what they pass, their continuity, times and refusals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "screwline/trajectory/plan.h"
#include "unit/trajectory_support.h"

namespace screwline {
namespace {

using trajectory_test::errorOf;
using trajectory_test::limitsOf;
using trajectory_test::messageOf;
using trajectory_test::request;
using trajectory_test::vector;

const char* const kMultipoint[] = {"multipoint_trapezoidal", "multipoint_cubic", "multipoint_quintic", "bspline",
                                   "bspline_interpolating"};

TEST(Multipoint, EveryProfilePassesItsWaypointsWithinLimits) {
  const std::vector<VectorX> way{vector({0.0, 1.0}), vector({0.7, 1.5}), vector({0.9, -0.5}), vector({-1.0, 0.2}),
                                 vector({0.0, 0.0})};
  for (const char* profile : kMultipoint) {
    const Limits limits = limitsOf(2, 1.0, 4.0, 40.0);
    const PlanResult result = plan(request(profile, way, limits));
    EXPECT_NEAR(tightestUse(result.trajectory, limits).stretch, 1.0, 1e-9) << profile;
    const double miss = result.via_joint_errors.cwiseAbs().maxCoeff();
    EXPECT_EQ(miss < 1e-9, std::string(profile) != "bspline") << profile << " misses by " << miss;
    TrajectoryPoint end(2);
    result.trajectory.sample(result.trajectory.duration(), end);
    EXPECT_LT((end.position - way.back()).norm(), 1e-12) << profile;
    EXPECT_LT(end.velocity.norm(), 1e-9) << profile;
    EXPECT_EQ(result.waypoint_times.size(), way.size());
  }
}

TEST(Multipoint, ContinuityAsPromised) {
  const std::vector<VectorX> way{vector({0.0}), vector({0.7}), vector({0.9}), vector({-1.0})};
  const auto continuity = [&](const char* profile) {
    return plan(request(profile, way, limitsOf(1, 1.0, 4.0, 40.0))).trajectory.continuity();
  };
  EXPECT_EQ(continuity("multipoint_trapezoidal"), 1);
  EXPECT_EQ(continuity("multipoint_cubic"), 1);  // C2 inside; its acceleration steps from rest at the ends.
  EXPECT_EQ(continuity("multipoint_quintic"), 2);
  EXPECT_EQ(continuity("bspline"), 2);
  EXPECT_EQ(continuity("bspline_interpolating"), 2);
  const JointTrajectory cubic = plan(request("multipoint_cubic", way, limitsOf(1, 1.0, 4.0, 40.0))).trajectory;
  EXPECT_EQ(cubic.pieces()->continuity, 2);
  EXPECT_LT(stepInside(*cubic.pieces(), 0, 2), 1e-12);
}

TEST(Multipoint, GivenTimesAreKeptAndTheRestIsChosen) {
  const std::vector<VectorX> way{vector({0.0}), vector({1.0}), vector({2.0}), vector({2.5}), vector({3.0})};
  for (const char* profile :
       {"multipoint_trapezoidal", "multipoint_cubic", "multipoint_quintic", "bspline_interpolating"}) {
    PlanRequest r = request(profile, way, limitsOf(1, 10.0, 100.0, 5000.0));
    r.waypoints[2].time = 3.0;
    r.duration = 5.0;
    const PlanResult result = plan(r);
    EXPECT_EQ(result.waypoint_times[2], 3.0) << profile;
    if (std::string(profile) == "multipoint_trapezoidal") {  // Equal lines: halves use the least of the limits.
      EXPECT_NEAR(result.waypoint_times[1], 1.5, 1e-9);
      EXPECT_NEAR(result.waypoint_times[3], 4.0, 1e-9);
    }
    EXPECT_TRUE(std::is_sorted(result.waypoint_times.begin(), result.waypoint_times.end())) << profile;
    EXPECT_EQ(result.waypoint_times[4], 5.0) << profile;
    r.duration = 0.0;
    const PlanResult free = plan(r);
    EXPECT_EQ(free.waypoint_times[2], 3.0) << profile;
    EXPECT_LT(free.trajectory.duration(), 5.0) << profile;
  }
}

TEST(Multipoint, RepeatedWaypointsNeverDivideByZero) {
  const std::vector<VectorX> way{vector({0.0, 0.0}), vector({0.0, 0.0}), vector({1.0, 2.0}), vector({1.0, 2.0}),
                                 vector({1.0, 2.0})};
  for (const char* profile : kMultipoint) {
    for (double duration : {0.0, 30.0}) {
      PlanRequest r = request(profile, way, limitsOf(2, 1.0, 4.0, 40.0));
      r.duration = duration;
      EXPECT_TRUE(std::isfinite(plan(r).trajectory.duration())) << profile;
    }
    const PlanResult still = plan(request(profile, {way[0], way[0], way[0]}, limitsOf(2, 1.0, 4.0, 40.0)));
    EXPECT_EQ(still.trajectory.duration(), 0.0) << profile;
    EXPECT_FALSE(still.notes.empty());
  }
}

TEST(Multipoint, TooShortIsRefusedAndTheNamedDurationWorks) {
  const std::vector<VectorX> way{vector({0.0, 1.0}), vector({0.7, 1.5}), vector({0.9, -0.5})};
  for (const char* profile : kMultipoint) {
    PlanRequest r = request(profile, way, limitsOf(2, 1.0, 4.0, 40.0));
    r.duration = 0.3;
    const std::string message = messageOf(r);
    const auto at = message.find("duration is ");
    ASSERT_NE(at, std::string::npos) << profile << ": " << message;
    const double named = std::stod(message.substr(at + 12));
    r.duration = named * (1.0 + 1e-8);
    EXPECT_NO_THROW(plan(r)) << profile;
    r.duration = named * (1.0 - 1e-6);
    EXPECT_EQ(errorOf(r), AnswerCode::kLimitsInfeasible) << profile;
  }
}

TEST(Multipoint, TrapezoidalRestsAtEachWaypoint) {
  const std::vector<VectorX> way{vector({0.0, 1.0}), vector({0.7, 1.5}), vector({0.9, -0.5}), vector({0.0, 0.0})};
  const PlanResult result = plan(request("multipoint_trapezoidal", way, limitsOf(2, 1.0, 4.0, 40.0)));
  TrajectoryPoint point(2);
  double sum = 0.0;
  for (std::size_t k = 0; k < way.size(); ++k) {
    result.trajectory.sample(result.waypoint_times[k], point);
    EXPECT_LT(point.velocity.norm(), 1e-9);
    EXPECT_LT((point.position - way[k]).norm(), 1e-12);
    if (k > 0)
      sum += plan(request("trapezoidal", {way[k - 1], way[k]}, limitsOf(2, 1.0, 4.0, 40.0))).trajectory.duration();
  }
  EXPECT_NEAR(result.trajectory.duration(), sum, 1e-12);
}

TEST(MultipointCubic, EndVelocitiesAreMet) {
  PlanRequest r =
      request("multipoint_cubic", {vector({0.0}), vector({1.0}), vector({1.5})}, limitsOf(1, 1.0, 4.0, 40.0));
  r.waypoints.front().velocity = vector({0.6});
  r.waypoints.back().velocity = vector({-0.3});
  const PlanResult result = plan(r);
  TrajectoryPoint point(1);
  result.trajectory.sample(0.0, point);
  EXPECT_NEAR(point.velocity[0], 0.6, 1e-12);
  result.trajectory.sample(result.trajectory.duration(), point);
  EXPECT_NEAR(point.velocity[0], -0.3, 1e-12);
  EXPECT_LE(tightestUse(result.trajectory, r.limits).stretch, 1.0 + 1e-9);
  r.waypoints[1].velocity = vector({0.2});
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
  r.waypoints[1].velocity.resize(0);
  r.waypoints[0].velocity = vector({1.2});
  EXPECT_EQ(errorOf(r), AnswerCode::kLimitsInfeasible);
}

TEST(MultipointCubic, EqualsTheNaturalFormulaOfThreePoints) {
  // One interior knot, equal segments h, clamped ends at zero: v1 = 3 (q2 - q0) / (4 h).
  PlanRequest r = request("multipoint_cubic", {vector({0.0}), vector({1.0}), vector({4.0})}, Limits::unlimited(1));
  r.waypoints[1].time = 2.0;
  r.duration = 4.0;
  TrajectoryPoint point(1);
  plan(r).trajectory.sample(2.0, point);
  EXPECT_NEAR(point.velocity[0], 3.0 * 4.0 / (4.0 * 2.0), 1e-12);
}

TEST(MultipointQuintic, GivenVelocitiesAndAccelerationsAreMet) {
  PlanRequest r =
      request("multipoint_quintic", {vector({0.0}), vector({1.0}), vector({1.5})}, limitsOf(1, 1.5, 6.0, 80.0));
  r.waypoints[1].velocity = vector({0.5});
  r.waypoints[1].acceleration = vector({-1.0});
  r.waypoints[2].velocity = vector({0.2});
  const PlanResult result = plan(r);
  TrajectoryPoint point(1);
  result.trajectory.sample(result.waypoint_times[1], point);
  EXPECT_NEAR(point.velocity[0], 0.5, 1e-12);
  EXPECT_NEAR(point.acceleration[0], -1.0, 1e-10);
  result.trajectory.sample(result.trajectory.duration(), point);
  EXPECT_NEAR(point.velocity[0], 0.2, 1e-12);
}

TEST(Bspline, StaysInTheHullAndPassesOnlyTheEnds) {
  const std::vector<VectorX> way{vector({0.0}), vector({1.0}), vector({-0.5}), vector({0.3})};
  for (double degree : {3.0, 4.0, 5.0, 6.0, 7.0}) {
    PlanRequest r = request("bspline", way, limitsOf(1, 1.0, 4.0, 40.0));
    r.parameters = {{"degree", degree}};
    const PlanResult result = plan(r);
    const Range range = result.trajectory.extrema(0).position;
    EXPECT_GE(range.lower, -0.5);
    EXPECT_LE(range.upper, 1.0);
    EXPECT_GT(result.via_joint_errors.cwiseAbs().minCoeff(), 1e-3);
  }
}

TEST(Bspline, WithoutRestEndsItIsDeBoorsCurve) {
  PlanRequest r =
      request("bspline", {vector({0.0}), vector({1.0}), vector({-0.5}), vector({0.3})}, Limits::unlimited(1));
  r.parameters = {{"rest_ends", 0.0}};
  r.duration = 2.0;
  const JointTrajectory trajectory = plan(r).trajectory;
  TrajectoryPoint point(1);
  for (int i = 0; i <= 20; ++i) {  // Four control points of degree 3: one Bezier curve.
    const double u = i / 20.0, w = 1.0 - u;
    trajectory.sample(2.0 * u, point);
    EXPECT_NEAR(point.position[0], 3.0 * w * w * u - 0.5 * 3.0 * w * u * u + 0.3 * u * u * u, 1e-13);
  }
  r.waypoints.pop_back();
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
}

TEST(BsplineInterpolating, EveryDegreeMeetsEveryWaypointAtRestEnds) {
  std::vector<VectorX> way;
  for (int k = 0; k < 12; ++k) way.push_back(vector({std::sin(1.3 * k), std::cos(2.1 * k)}));
  for (double degree : {3.0, 4.0, 5.0, 6.0, 7.0}) {
    for (std::size_t count : {2u, 3u, 12u}) {
      PlanRequest r = request("bspline_interpolating", {way.begin(), way.begin() + static_cast<long>(count)},
                              limitsOf(2, 1, 4, 40));
      r.parameters = {{"degree", degree}};
      const PlanResult result = plan(r);
      EXPECT_TRUE(result.via_joint_errors.isZero(1e-9)) << degree;
      EXPECT_EQ(result.trajectory.continuity(), degree < 6.0 ? 2 : 3);
    }
  }
}

TEST(Sinusoidal, EqualsItsFormulaAndKeepsLimits) {
  PlanRequest r = request("sinusoidal", {}, Limits::unlimited(3));
  r.duration = 20.0;
  r.parameters = {{"amplitude_0", 1.0},   {"omega_0", 1.0},     {"amplitude_1", 1.0}, {"omega_1", 2.0},
                  {"phase_1", kPi / 2.0}, {"amplitude_2", 1.0}, {"omega_2", 3.0},     {"offset_2", 0.5}};
  const JointTrajectory trajectory = plan(r).trajectory;
  TrajectoryPoint point(3);
  for (double t : {0.0, 0.3, 7.7, 20.0}) {
    trajectory.sample(t, point);
    EXPECT_NEAR(point.position[0], std::sin(t), 1e-13);
    EXPECT_NEAR(point.position[1], std::cos(2.0 * t), 1e-13);
    EXPECT_NEAR(point.position[2], 0.5 + std::sin(3.0 * t), 1e-13);
    EXPECT_NEAR(point.velocity[2], 3.0 * std::cos(3.0 * t), 1e-13);
    EXPECT_NEAR(point.acceleration[2], -9.0 * std::sin(3.0 * t), 1e-12);
    EXPECT_NEAR(point.jerk[2], -27.0 * std::cos(3.0 * t), 1e-12);
  }
  r.limits = limitsOf(3, 2.5, 100.0, 1000.0);
  EXPECT_EQ(errorOf(r), AnswerCode::kLimitsInfeasible);
  EXPECT_NE(messageOf(r).find("joint 2"), std::string::npos);
  r.limits = Limits::unlimited(3);
  r.parameters.push_back({"amplitude_3", 1.0});
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
  r.parameters.pop_back();
  r.duration = 0.0;
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
}

}  // namespace
}  // namespace screwline
