// Re-timing with jerk limits, moving ends and a tool's speed: laws, and closed forms where there are some.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "property/cartesian_support.h"
#include "property/path_support.h"
#include "screwline/trajectory/retime.h"
#include "screwline/trajectory/tool_speed.h"
#include "screwline/trajectory/verify.h"

namespace screwline {
namespace {

using trajectory_test::Arm;
using trajectory_test::denseUse;
using trajectory_test::errorOf;
using trajectory_test::limitsOf;
using trajectory_test::messageOf;
using trajectory_test::Random;
using trajectory_test::randomLimits;
using trajectory_test::randomSpline;
using trajectory_test::request;
using trajectory_test::vector;

constexpr int kCells = 200;  // Quick, and so that what passes between grid points shows.

JointPath backwards(const JointPath& path) {
  PiecewisePolynomial curve = reversed(path.curve());
  return JointPath(std::move(curve));
}

RetimeOptions holdingJerk(int cells = kCells) {
  RetimeOptions options;
  options.hold_jerk = true;
  options.grid_points = cells;
  return options;
}

JointTrajectory motionOf(const JointPath& path, const RetimeResult& result) {
  return JointTrajectory::alongPath(path, result.law, result.duration);
}

/// Starts and ends at rest without acceleration, holds all limits everywhere, and uses one of them fully; 0.1 % faster
/// the checker says so.
void expectHeld(const JointPath& path, const Limits& limits, const RetimeResult& result, const std::string& where) {
  ASSERT_EQ(result.status, RetimeStatus::kDone) << where;
  const JointTrajectory motion = motionOf(path, result);
  EXPECT_GE(motion.continuity(), 2) << where;
  EXPECT_EQ(verifyTrajectory(motion, limits, {}).value_or(""), "") << where;
  EXPECT_LT(denseUse(motion, limits, 5000, 3), 1.0 + 1e-9) << where;
  EXPECT_GT(denseUse(motion, limits, 5000, 3), 0.97) << where;
  const auto hasty = JointTrajectory::alongPath(path, result.law, result.duration * 0.999);
  EXPECT_TRUE(verifyTrajectory(hasty, limits, {}).has_value()) << where;
  TrajectoryPoint point(path.joints());
  for (double t : {0.0, motion.duration()}) {
    motion.sample(t, point);
    EXPECT_LT(point.velocity.cwiseAbs().maxCoeff(), 1e-9) << where;
    EXPECT_LT(point.acceleration.cwiseAbs().maxCoeff(), 1e-6) << where;
  }
}

TEST(RetimeJerk, OnAStraightLineItIsTheDoubleS) {
  Random random(31);
  for (int trial = 0; trial < 15; ++trial) {
    const int joints = random.integer(1, 7);
    const std::vector<VectorX> way{random.vector(joints, -2.0, 2.0), random.vector(joints, -2.0, 2.0)};
    const Limits limits = randomLimits(random, joints);
    const double exact = plan(request("double_s", way, limits)).trajectory.duration();
    MatrixX line(joints, 2);
    line << way[0], way[1];
    const double retimed = retime(naturalSplinePath({0.0, 1.0}, line), limits, holdingJerk(500)).duration;
    EXPECT_GT(retimed, exact * (1.0 - 1e-9)) << "seed 31, trial " << trial;
    EXPECT_LT(retimed, exact * 1.002) << "seed 31, trial " << trial;
  }
}

TEST(RetimeJerk, LimitsHoldEverywhereOnRandomPaths) {
  Random random(32);
  for (int trial = 0; trial < 24; ++trial) {
    const int joints = random.integer(1, 7);
    const JointPath path = randomSpline(random, joints, random.integer(2, 12));
    const Limits limits = randomLimits(random, joints);
    expectHeld(path, limits, retime(path, limits, holdingJerk()), "seed 32, trial " + std::to_string(trial));
  }
}

TEST(RetimeJerk, HardAndSoftLimitsAndSomeJointsWithoutAny) {
  Random random(33);
  for (int trial = 0; trial < 18; ++trial) {
    const JointPath path = randomSpline(random, 4, random.integer(2, 8));
    Limits limits = randomLimits(random, 4);
    limits.jerk *= std::pow(10.0, random.uniform(-3.0, 3.0));
    if (trial % 3 == 1) limits.acceleration.setConstant(HUGE_VAL);
    if (trial % 3 == 2) limits.velocity.setConstant(HUGE_VAL);
    if (trial % 2 == 1) limits.jerk[0] = limits.jerk[1] = HUGE_VAL;
    expectHeld(path, limits, retime(path, limits, holdingJerk()), "seed 33, trial " + std::to_string(trial));
  }
}

TEST(RetimeJerk, LiesBetweenTheMotionWithoutJerkLimitsAndAFinerGrid) {
  Random random(34);
  for (int trial = 0; trial < 8; ++trial) {
    const JointPath path = randomSpline(random, 6, random.integer(2, 8));
    const Limits limits = randomLimits(random, 6);
    RetimeOptions fine;
    fine.grid_points = 4000;
    const double without = retime(path, limits, fine).duration;
    const double usual = retime(path, limits, holdingJerk(0)).duration;
    const double finer = retime(path, limits, holdingJerk(1500)).duration;
    EXPECT_GT(usual, without * (1.0 - 1e-4)) << "seed 34, trial " << trial;
    EXPECT_LT(usual, finer * 1.01) << "seed 34, trial " << trial;
    EXPECT_LT(finer, usual * 1.002) << "seed 34, trial " << trial;
  }
}

TEST(RetimeJerk, MuchJerkIsAsGoodAsNoLimit) {
  Random random(35);
  for (int trial = 0; trial < 6; ++trial) {
    const JointPath path = randomSpline(random, 5, random.integer(2, 6));
    Limits limits = randomLimits(random, 5);
    limits.jerk = 1e5 * limits.acceleration;
    const double without = retime(path, limits).duration;
    EXPECT_NEAR(retime(path, limits, holdingJerk(1000)).duration, without, 0.01 * without)
        << "seed 35, trial " << trial;
  }
}

TEST(RetimeJerk, TheWayBackTakesAsLongAndLimitsScaleTime) {
  Random random(36);
  for (int trial = 0; trial < 8; ++trial) {
    const JointPath path = randomSpline(random, 6, random.integer(3, 8));
    const Limits limits = randomLimits(random, 6);
    const double there = retime(path, limits, holdingJerk(500)).duration;
    EXPECT_NEAR(retime(backwards(path), limits, holdingJerk(500)).duration, there, 3e-3 * there) << "seed 36";
    Limits slower = limits;
    slower.velocity /= 3.0;
    slower.acceleration /= 9.0;
    slower.jerk /= 27.0;
    EXPECT_NEAR(retime(path, slower, holdingJerk(500)).duration, 3.0 * there, 1e-4 * there) << "seed 36";
  }
}

TEST(RetimeJerk, AtATurnItStopsWithoutAcceleration) {
  const Limits limits = limitsOf(2, 1.0, 4.0, 40.0);
  MatrixX way(2, 3);
  way << 0.0, 1.0, 1.0, 0.0, 0.0, 2.0;
  const JointPath path = linePath({0.0, 1.0, 3.0}, way);
  const RetimeResult result = retime(path, limits, holdingJerk(600));
  const auto rest = [&](double far) {
    return plan(request("double_s", {vector({0.0}), vector({far})}, limitsOf(1, 1.0, 4.0, 40.0))).trajectory.duration();
  };
  EXPECT_NEAR(result.duration, rest(1.0) + rest(2.0), 3e-3 * result.duration);
  expectHeld(path, limits, result, "corner");
}

TEST(RetimeJerk, MovingEndsAreMetOrRefusedWithWhatIsFeasible) {
  Random random(37);
  int refused = 0;
  for (int trial = 0; trial < 16; ++trial) {
    const JointPath path = randomSpline(random, 4, random.integer(2, 5));
    const Limits limits = randomLimits(random, 4);
    RetimeOptions options = holdingJerk();
    options.start_rate = trial % 3 == 0 ? 0.0 : random.uniform(0.0, 0.5);
    options.end_rate = trial % 3 == 1 ? 0.0 : random.uniform(0.0, 0.5);
    RetimeResult result = retime(path, limits, options);
    for (int round = 0; round < 4 && result.status != RetimeStatus::kDone; ++round) {
      ++refused;
      EXPECT_LE(result.start_rate, options.start_rate);
      EXPECT_LE(result.end_rate, options.end_rate);
      options.start_rate = 0.98 * result.start_rate;
      options.end_rate = 0.98 * result.end_rate;
      result = retime(path, limits, options);
    }
    ASSERT_EQ(result.status, RetimeStatus::kDone) << "seed 37, trial " << trial;
    const JointTrajectory motion = motionOf(path, result);
    EXPECT_EQ(verifyTrajectory(motion, limits, {}).value_or(""), "") << "seed 37, trial " << trial;
    EXPECT_NEAR(result.law.at(0.0).ds / result.duration, options.start_rate, 1e-9);
    EXPECT_NEAR(result.law.at(1.0).ds / result.duration, options.end_rate, 1e-9);
    EXPECT_NEAR(result.law.at(0.0).dds / std::pow(result.duration, 2), 0.0, 1e-6);
  }
  EXPECT_GT(refused, 0);
}

TEST(Retime, MovingEndsInAGivenDuration) {
  Random random(38);
  for (int trial = 0; trial < 12; ++trial) {
    const JointPath path = randomSpline(random, 4, random.integer(2, 6));
    const Limits limits = randomLimits(random, 4);
    RetimeOptions options;
    options.start_rate = 0.05;
    options.end_rate = 0.03;
    const RetimeResult shortest = retime(path, limits, options);
    if (shortest.status != RetimeStatus::kDone) continue;
    for (double factor : {1.1, 2.0, 5.0}) {
      options.duration = factor * shortest.duration;
      const RetimeResult result = retime(path, limits, options);
      EXPECT_NEAR(result.duration, options.duration, 1e-9 * options.duration) << "seed 38, trial " << trial;
      EXPECT_NEAR(result.law.at(0.0).ds / result.duration, 0.05, 1e-9);
      EXPECT_NEAR(result.law.at(1.0).ds / result.duration, 0.03, 1e-9);
      EXPECT_LT(tightestUse(motionOf(path, result), limits).stretch, 1.0 + 1e-9) << "seed 38, trial " << trial;
    }
  }
}

TEST(ToolSpeed, BoundsDenseValuesTightly) {
  Random random(39);
  for (const char* robot : {"puma560", "panda", "rrp_spherical"}) {
    const Arm arm(robot);
    const JointPath path = randomSpline(random, arm.chain.size(), 5);
    const ToolSpeed speed(arm.chain, path);
    for (int trial = 0; trial < 30; ++trial) {
      const double from = random.uniform(0.0, 0.99);
      const double to = from + random.uniform(0.0, 0.01);
      double most = 0.0;
      constexpr double h = 1e-6;
      VectorX q(path.joints()), next(path.joints()), unused(path.joints());
      for (int i = 0; i <= 100; ++i) {
        const double u = from + (to - from) * i / 100.0;
        path.at(u - h, q.data(), unused.data(), unused.data(), unused.data());
        path.at(u + h, next.data(), unused.data(), unused.data(), unused.data());
        most = std::max(most,
                        (forwardKinematics(arm.chain, next).p - forwardKinematics(arm.chain, q).p).norm() / (2.0 * h));
      }
      EXPECT_GE(speed.greatest(from, to), most * (1.0 - 1e-6)) << robot << ", seed 39";
      EXPECT_LE(speed.greatest(from, to), most * 1.01 + 1e-3) << robot << ", seed 39";
    }
  }
}

double fastestTool(const SerialChain& chain, const JointTrajectory& motion) {
  TrajectoryPoint point(motion.joints());
  Matrix6X jacobian(6, motion.joints());
  double most = 0.0;
  for (int i = 0; i <= 20000; ++i) {
    motion.sample(motion.duration() * i / 20000, point);
    geometricJacobian(chain, point.position, jacobian);
    most = std::max(most, (jacobian.topRows<3>() * point.velocity).norm());
  }
  return most;
}

TEST(PathTimeOptimal, ToolSpeedHoldsWithAndWithoutJerk) {
  const Arm arm("puma560");
  PlanRequest r = request("path_time_optimal",
                          {vector({0.0, -1.0, 0.5, 0.2, 0.4, 0.0}), vector({0.8, -0.5, 0.7, -0.4, 0.8, 1.0}),
                           vector({1.4, -1.2, 0.3, 0.6, -0.5, -0.7})},
                          arm.limits());
  const double free = plan(r).trajectory.duration();
  r.parameters = {{"tool_speed", 0.25}};
  EXPECT_NE(messageOf(r).find("needs the kinematics"), std::string::npos) << messageOf(r);
  r.kinematics = &arm.kinematics;
  for (double jerk : {0.0, 1.0}) {
    r.parameters = {{"tool_speed", 0.25}, {"hold_jerk", jerk}};
    const PlanResult result = plan(r);
    EXPECT_GT(result.trajectory.duration(), free);
    EXPECT_LE(fastestTool(arm.chain, result.trajectory), 0.25 * (1.0 + 1e-9));
    EXPECT_GT(fastestTool(arm.chain, result.trajectory), 0.25 * 0.995);
    r.duration = 0.9 * result.trajectory.duration();
    EXPECT_EQ(errorOf(r), AnswerCode::kLimitsInfeasible);
    r.duration = 0.0;
  }
  r.parameters = {{"tool_speed", 0.0}};
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
  r.parameters = {{"hold_jerk", 0.5}};
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
}

TEST(PathTimeOptimal, JerkIsHeldThroughWaypointsWhereItIsAskedFor) {
  Random random(40);
  for (int trial = 0; trial < 6; ++trial) {
    std::vector<VectorX> way;
    for (int k = 0; k < 6; ++k) way.push_back(k == 3 ? way.back() : random.vector(5, -2.0, 2.0));
    PlanRequest r = request("path_time_optimal", way, randomLimits(random, 5));
    const double without = plan(r).trajectory.duration();
    r.parameters = {{"hold_jerk", 1.0}};
    const PlanResult result = plan(r);
    EXPECT_GT(result.trajectory.duration(), without);
    EXPECT_LT(result.via_joint_errors.cwiseAbs().maxCoeff(), 1e-9) << "seed 40, trial " << trial;
    EXPECT_EQ(result.trajectory.continuity(), 2);
    for (int j = 0; j < 5; ++j) EXPECT_LE(result.trajectory.extrema(j).peak(3), r.limits.jerk[j] * (1.0 + 1e-9));
    r.duration = 2.0 * result.trajectory.duration();
    EXPECT_EQ(plan(r).trajectory.duration(), r.duration);
    r.duration = 0.9 * result.trajectory.duration();
    EXPECT_EQ(errorOf(r), AnswerCode::kLimitsInfeasible);
  }
}

TEST(PathTimeOptimal, VelocitiesAtItsEndsLieAlongThePath) {
  const std::vector<VectorX> way{vector({0.0, 1.0}), vector({0.7, 1.5}), vector({0.9, -0.5})};
  PlanRequest r = request("path_time_optimal", way, limitsOf(2, 1.0, 4.0, 40.0));
  r.waypoints[0].velocity = vector({0.3, 0.2});
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
  const std::string text = messageOf(r);
  EXPECT_NE(text.find("waypoints[0].velocity"), std::string::npos) << text;
  EXPECT_NE(text.find("tangent"), std::string::npos) << text;
  const PlanResult still = plan(request("path_time_optimal", way, limitsOf(2, 1.0, 4.0, 40.0)));
  const JointPath& path = *still.trajectory.path();
  VectorX q(2), tangent(2), unused(2);
  for (double jerk : {0.0, 1.0}) {
    path.at(0.0, q.data(), tangent.data(), unused.data(), unused.data());
    r.parameters = {{"hold_jerk", jerk}};
    r.waypoints[0].velocity = 0.1 * tangent;
    path.at(1.0, q.data(), tangent.data(), unused.data(), unused.data());
    r.waypoints[2].velocity = 0.05 * tangent;
    const PlanResult result = plan(r);
    TrajectoryPoint point(2);
    result.trajectory.sample(0.0, point);
    EXPECT_LT((point.velocity - r.waypoints[0].velocity).norm(), 1e-8);
    result.trajectory.sample(result.trajectory.duration(), point);
    EXPECT_LT((point.velocity - r.waypoints[2].velocity).norm(), 1e-8);
    r.duration = 1.5 * result.trajectory.duration();
    if (jerk == 0.0) {
      EXPECT_NEAR(plan(r).trajectory.duration(), r.duration, 1e-9);
    } else {
      EXPECT_EQ(errorOf(r), AnswerCode::kLimitsInfeasible);
    }
    r.duration = 0.0;
    r.waypoints[2].velocity = -0.05 * tangent;
    EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
    r.waypoints[2].velocity = tangent * (0.999 / tangent.cwiseAbs().maxCoeff());
    if (errorOf(r) == AnswerCode::kLimitsInfeasible) {
      EXPECT_NE(messageOf(r).find("feasible is 0 to"), std::string::npos) << messageOf(r);
    }
    r.waypoints[2].velocity = VectorX();
  }
}

TEST(CartesianLine, HoldsJerkAndToolSpeed) {
  const Arm arm("puma560");
  Random random(41);
  int planned = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const VectorX q = arm.random(random);
    const Pose start = forwardKinematics(arm.chain, q);
    Pose goal = start;
    goal.p += 0.15 * random.vector(3, -1.0, 1.0);
    PlanRequest r = arm.request("cartesian_line", {start, goal}, q);
    r.parameters = {{"hold_jerk", 1.0}, {"tool_speed", 0.2}};
    PlanResult result;
    try {
      result = plan(r);
    } catch (const InputError&) {
      continue;
    }
    ++planned;
    EXPECT_EQ(result.trajectory.continuity(), 2) << "seed 41, trial " << trial;
    for (int j = 0; j < 6; ++j) EXPECT_LE(result.trajectory.extrema(j).peak(3), r.limits.jerk[j] * (1.0 + 1e-9));
    EXPECT_LE(fastestTool(arm.chain, result.trajectory), 0.2 * (1.0 + 1e-9)) << "seed 41, trial " << trial;
  }
  EXPECT_GT(planned, 3);
}

}  // namespace
}  // namespace screwline
