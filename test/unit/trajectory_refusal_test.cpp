// Sampled points, and requests that plan() refuses: each message names the field, its value and the bound.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "screwline/trajectory/points.h"
#include "unit/trajectory_support.h"

namespace screwline {
namespace {

using trajectory_test::limitsOf;
using trajectory_test::planned;
using trajectory_test::request;
using trajectory_test::vector;

std::vector<SampledPoint> sampled(const JointTrajectory& motion, double period, bool velocity, bool acceleration) {
  std::vector<SampledPoint> points;
  TrajectoryPoint p(motion.joints());
  for (double t : sampleTimes(motion, period, true)) {
    motion.sample(t, p);
    points.push_back({p.position, velocity ? p.velocity : VectorX(), acceleration ? p.acceleration : VectorX(), t});
  }
  return points;
}

double worstDifference(const JointTrajectory& a, const JointTrajectory& b) {
  TrajectoryPoint p(a.joints()), q(b.joints());
  double worst = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    a.sample(a.duration() * i / 1000.0, p);
    b.sample(a.duration() * i / 1000.0, q);
    worst = std::max(worst, (p.position - q.position).cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(Points, QuinticIsExactCubicCloseLinearRough) {
  const JointTrajectory motion = planned("polynomial_345", {vector({0.0}), vector({1.0})}, 2.0 * 1.875);
  EXPECT_LT(worstDifference(motion, trajectoryThrough(sampled(motion, 0.01, true, true))), 1e-14);
  EXPECT_LT(worstDifference(motion, trajectoryThrough(sampled(motion, 0.01, true, false))), 1e-9);
  EXPECT_LT(worstDifference(motion, trajectoryThrough(sampled(motion, 0.01, false, false))), 1e-4);
  EXPECT_EQ(trajectoryThrough(sampled(motion, 0.01, true, true)).continuity(), 2);
  EXPECT_EQ(trajectoryThrough(sampled(motion, 0.01, true, false)).continuity(), 1);
  EXPECT_EQ(trajectoryThrough(sampled(motion, 0.01, false, false)).continuity(), 0);
}

TEST(Points, CornersMakeATrapezoidExact) {
  const JointTrajectory motion = planned("trapezoidal", {vector({0.0}), vector({1.0})}, 3.1);
  EXPECT_LT(worstDifference(motion, trajectoryThrough(sampled(motion, 0.1, true, false))), 1e-14);
}

TEST(Points, FirstPointLaterThanZeroStartsFromTheRobot) {
  const MotionState here{vector({0.5}), vector({0.2}), vector({0.0})};
  const SampledPoint goal{vector({1.0}), vector({0.0}), vector({0.0}), 2.0};
  const JointTrajectory motion = trajectoryThrough({goal}, &here);
  TrajectoryPoint point(1);
  motion.sample(0.0, point);
  EXPECT_EQ(point.position[0], 0.5);
  EXPECT_NEAR(point.velocity[0], 0.2, 1e-15);
  EXPECT_EQ(motion.duration(), 2.0);
  EXPECT_THROW(trajectoryThrough({goal}), InputError);
}

TEST(Points, BadMessagesAreRefused) {
  const SampledPoint a{vector({0.0}), {}, {}, 0.0}, b{vector({1.0}), {}, {}, 1.0};
  const auto refused = [](std::vector<SampledPoint> points) {
    try {
      trajectoryThrough(points);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused({}), "points is empty");
  EXPECT_NE(refused({a, a}).find("points[1].time_from_start is 0 s, it must be after 0 s"), std::string::npos);
  EXPECT_NE(refused({a, {vector({1.0, 2.0}), {}, {}, 1.0}}).find("points[1].positions has 2 values"),
            std::string::npos);
  EXPECT_NE(refused({a, {vector({std::nan("")}), {}, {}, 1.0}}).find("nan"), std::string::npos);
  EXPECT_NE(refused({a, {vector({1.0}), vector({0.0}), {}, 1.0}}).find("points[1].velocities"), std::string::npos);
  EXPECT_NE(refused({{VectorX(), {}, {}, 0.0}, b}), "");
  EXPECT_EQ(refused({a, b}), "");
  EXPECT_EQ(refused({a}), "");
}

TEST(Refusals, EachNamesFieldValueAndBound) {
  const auto limits = limitsOf(2, 1.0, 2.0, 10.0);
  const std::vector<VectorX> way{vector({0.0, 0.0}), vector({1.0, 1.0})};
  const auto message = [&](const std::function<void(PlanRequest&)>& spoil, AnswerCode code = AnswerCode::kInvalidGoal) {
    PlanRequest r = request("multipoint_cubic", way, limits);
    spoil(r);
    EXPECT_EQ(trajectory_test::errorOf(r), code);
    return trajectory_test::messageOf(r);
  };
  using M = PlanRequest&;
  EXPECT_NE(message([](M r) { r.profile = "warp"; }, AnswerCode::kUnknownProfile).find("multipoint_quintic"),
            std::string::npos);
  EXPECT_NE(message([](M r) { r.waypoints.clear(); }).find("waypoints has 0 entries"), std::string::npos);
  EXPECT_NE(message([](M r) { r.waypoints.pop_back(); }).find("waypoints has 1 entries"), std::string::npos);
  EXPECT_EQ(message([](M r) { r.waypoints[1].position = vector({1.0}); }),
            "waypoints[1].position has 1 values, the robot has 2 joints");
  EXPECT_NE(message([](M r) { r.waypoints[1].position[0] = 2e6; }).find("waypoints[1].position[0] is 2000000"),
            std::string::npos);
  EXPECT_NE(message([](M r) { r.waypoints[0].position[1] = std::nan(""); }).find("position[1] is nan"),
            std::string::npos);
  EXPECT_NE(message([](M r) { r.duration = -1.0; }).find("duration is -1"), std::string::npos);
  EXPECT_NE(message([](M r) { r.duration = HUGE_VAL; }).find("duration is inf"), std::string::npos);
  EXPECT_NE(message([](M r) { r.sample_period = -0.1; }).find("sample_period is -0.1"), std::string::npos);
  EXPECT_NE(message([](M r) { r.velocity_scaling = 1.5; }).find("velocity_scaling is 1.5, it must lie in (0, 1]"),
            std::string::npos);
  EXPECT_NE(message([](M r) { r.jerk_scaling = std::nan(""); }).find("jerk_scaling is nan"), std::string::npos);
  EXPECT_NE(message([](M r) { r.limits.jerk[1] = 0.0; }).find("jerk_limits[1] is 0"), std::string::npos);
  EXPECT_NE(message([](M r) { r.limits.acceleration.resize(1); }).find("acceleration_limits"), std::string::npos);
  EXPECT_NE(message([](M r) { r.limits = {}; }).find("no joints"), std::string::npos);
  EXPECT_NE(message([](M r) { r.waypoints[0].time = 1.0; }).find("waypoints[0].time is 1 s"), std::string::npos);
  EXPECT_NE(message([](M r) { r.waypoints[1].time = 2.0, r.duration = 3.0; }).find("duration is 3 s"),
            std::string::npos);
  EXPECT_NE(message([](M r) {
              r.parameters = {{"degree", 3.0}};
            }).find("parameter 'degree' is unknown"),
            std::string::npos);
  EXPECT_NE(message([](M r) {
              r.profile = "bspline", r.parameters = {{"degree", 3.5}};
            }).find("is 3.5"),
            std::string::npos);
  EXPECT_NE(message([](M r) {
              r.profile = "bspline", r.parameters = {{"degree", 3}, {"degree", 3}};
            }).find("twice"),
            std::string::npos);
  EXPECT_NE(message([](M r) {
              r.profile = "cubic", r.waypoints[1].velocity = vector({0.0, 0.3});
            }).find("velocity[1] is 0.3"),
            std::string::npos);
  EXPECT_NE(message([](M r) { r.duration = 1000.0, r.sample_period = 1e-6; }, AnswerCode::kTooLarge)
                .find("more than 1000000"),
            std::string::npos);
  EXPECT_NE(message([](M r) { r.waypoints.resize(100001, r.waypoints[0]); }, AnswerCode::kTooLarge).find("100001"),
            std::string::npos);
}

TEST(Refusals, TimesThatDoNotIncrease) {
  PlanRequest r =
      request("multipoint_cubic", {vector({0.0}), vector({1.0}), vector({2.0})}, limitsOf(1, 10, 100, 1000));
  r.waypoints[1].time = 2.0;
  r.waypoints[2].time = 1.0;
  EXPECT_NE(trajectory_test::messageOf(r).find("waypoints[2].time is 1 s, it must be after 2 s"), std::string::npos);
  r.waypoints[2].time = 0.0;
  r.duration = 2.0;
  EXPECT_NE(trajectory_test::messageOf(r).find("a waypoint before the last is at 2 s"), std::string::npos);
}

TEST(Refusals, PositionsOutsideBoundsAndOvershoot) {
  PlanRequest r = request("multipoint_cubic", {vector({0.0}), vector({1.0}), vector({0.9})}, limitsOf(1, 1, 10, 100));
  r.limits.lower = vector({-0.1});
  r.limits.upper = vector({0.95});
  EXPECT_EQ(trajectory_test::errorOf(r), AnswerCode::kInvalidGoal);
  r.limits.upper = vector({1.0});
  EXPECT_EQ(trajectory_test::errorOf(r), AnswerCode::kLimitsInfeasible);
  EXPECT_NE(trajectory_test::messageOf(r).find("joint 0 would reach position 1.0"), std::string::npos);
  r.limits.upper = vector({1.2});
  EXPECT_EQ(trajectory_test::errorOf(r), AnswerCode::kSuccess);
}

TEST(Refusals, NoLimitAndNoDuration) {
  for (const auto& info : listProfiles()) {
    if (info.name == "sinusoidal" || info.name == "trapezoidal" || info.name == "multipoint_trapezoidal") continue;
    const bool via = info.name.rfind("via", 0) == 0;
    std::vector<VectorX> way{vector({0.0}), vector({1.0})};
    if (via) way.push_back(vector({2.0}));
    EXPECT_EQ(trajectory_test::errorOf(request(info.name, way, Limits::unlimited(1))), AnswerCode::kInvalidGoal)
        << info.name;
  }
}

}  // namespace
}  // namespace screwline
