// Corners blended in joint space and at the tip: never farther from a waypoint than the radius, never off the lines
// outside of it, never slower than with stops.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "property/cartesian_support.h"
#include "screwline/trajectory/blend.h"
#include "screwline/trajectory/branch_following.h"
#include "screwline/trajectory/verify.h"

namespace screwline {
namespace trajectory_test {
namespace {

std::vector<VectorX> randomWay(Random& random, int joints, int count) {
  std::vector<VectorX> way;
  for (int k = 0; k < count; ++k) {
    way.push_back(k > 0 && random.integer(0, 7) == 0 ? way.back() : random.vector(joints, -2.0, 2.0));
  }
  if ((way.back() - way.front()).norm() == 0.0) way.back()[0] += 1.0;
  return way;
}

PlanRequest blended(const std::vector<VectorX>& way, const Limits& limits, double radius) {
  PlanRequest r = request("multipoint_trapezoidal", way, limits);
  r.parameters = {{"blend_radius", radius}};
  return r;
}

/// Distance of a point to the nearest of the lines between the waypoints.
double offLines(const std::vector<VectorX>& way, const VectorX& q) {
  double least = HUGE_VAL;
  for (std::size_t k = 1; k < way.size(); ++k) {
    const VectorX d = way[k] - way[k - 1];
    const double s = d.norm() > 0.0 ? std::clamp(d.dot(q - way[k - 1]) / d.squaredNorm(), 0.0, 1.0) : 0.0;
    least = std::min(least, (q - way[k - 1] - s * d).norm());
  }
  return least;
}

double nearest(const std::vector<VectorX>& way, const VectorX& q) {
  double least = HUGE_VAL;
  for (const VectorX& waypoint : way) least = std::min(least, (q - waypoint).norm());
  return least;
}

struct Worst {
  double off_outside = 0.0;  ///< Of the lines, farther than the radius from every waypoint.
  double miss = 0.0;         ///< Of a waypoint, by the nearest of all samples.
};

Worst worstOf(const JointTrajectory& motion, const std::vector<VectorX>& way, double radius) {
  constexpr int kSamples = 4000;
  Worst worst;
  std::vector<double> miss(way.size(), HUGE_VAL);
  TrajectoryPoint point(motion.joints());
  for (int i = 0; i <= kSamples; ++i) {
    motion.sample(motion.duration() * i / kSamples, point);
    for (std::size_t k = 0; k < way.size(); ++k) miss[k] = std::min(miss[k], (point.position - way[k]).norm());
    if (nearest(way, point.position) > radius * (1.0 + 1e-9))
      worst.off_outside = std::max(worst.off_outside, offLines(way, point.position));
  }
  worst.miss = *std::max_element(miss.begin(), miss.end());
  return worst;
}

TEST(JointBlend, KeepsToTheRadiusTheLinesAndTheLimitsAndIsNeverSlowerThanStops) {
  constexpr unsigned kSeed = 81;
  Random random(kSeed);
  double gain = 0.0;
  for (int trial = 0; trial < 60; ++trial) {
    const int joints = random.integer(1, 7);
    const Limits limits = randomLimits(random, joints);
    const std::vector<VectorX> way = randomWay(random, joints, random.integer(3, 9));
    const double radius = std::exp(random.uniform(-6.0, 1.5));
    const PlanResult result = plan(blended(way, limits, radius));
    const std::string what = "seed 81, trial " + std::to_string(trial);
    const Worst worst = worstOf(result.trajectory, way, radius);
    EXPECT_LE(worst.off_outside, 1e-9) << what;
    for (Eigen::Index i = 0; i < result.via_joint_errors.rows(); ++i)
      EXPECT_LE(result.via_joint_errors.row(i).norm(), 0.5 * radius * (1.0 + 1e-12)) << what;
    EXPECT_FALSE(verifyTrajectory(result.trajectory, limits, {})) << what;
    EXPECT_EQ(result.trajectory.continuity(), 1) << what;
    const double stops = plan(request("multipoint_trapezoidal", way, limits)).trajectory.duration();
    EXPECT_LE(result.trajectory.duration(), stops * (1.0 + 1e-9)) << what;
    gain += 1.0 - result.trajectory.duration() / stops;
  }
  EXPECT_GT(gain / 60.0, 0.03);
}

TEST(JointBlend, TheDeviationSaidIsThatOfTheMotion) {
  Random random(82);
  for (int trial = 0; trial < 20; ++trial) {
    const Limits limits = randomLimits(random, 4);
    const std::vector<VectorX> way = randomWay(random, 4, 6);
    MatrixX columns(4, 6);
    for (int k = 0; k < 6; ++k) columns.col(k) = way[static_cast<std::size_t>(k)];
    const BlendedLines lines = blendLines(columns, limits, 0.3);
    const JointTrajectory motion = JointTrajectory::piecewise(lines.motion);
    TrajectoryPoint point(4);
    for (std::size_t k = 1; k + 1 < way.size(); ++k) {
      motion.sample(lines.times[k], point);
      EXPECT_NEAR((point.position - way[k]).norm(), lines.corners[k].deviation, 1e-12) << "seed 82, trial " << trial;
      EXPECT_LE(lines.corners[k].deviation, 0.5 * lines.corners[k].reach + 1e-15);
      EXPECT_LE(lines.corners[k].reach, 0.3 * (1.0 + 1e-12));
      for (int i = -200; i <= 200; ++i) {  // Nowhere near it is nearer.
        motion.sample(lines.times[k] + 1e-3 * i, point);
        const bool other = nearest({way[k - 1], way[k + 1]}, point.position) < 0.3;
        const double away = (point.position - way[k]).norm();
        EXPECT_TRUE(other || away >= lines.corners[k].deviation - 1e-12);
      }
    }
  }
}

TEST(JointBlend, ByHandAtARightAngle) {
  // Unit limits of acceleration: the bend (-1, 1) takes 1 s per speed; the speed 0.5 is reached within 0.125.
  const Limits limits = limitsOf(2, 0.5, 1.0, 1e3);
  const std::vector<VectorX> way{vector({0.0, 0.0}), vector({1.0, 0.0}), vector({1.0, 1.0})};
  const PlanResult wide = plan(blended(way, limits, 10.0));
  // Each line: 0.5 s up over 0.125 m, then 0.75 m at 0.5 to the blend of 0.5 s.
  EXPECT_NEAR(wide.trajectory.duration(), 2.0 * (0.5 + 1.5) + 0.5, 1e-12);
  EXPECT_NEAR(wide.via_joint_errors.row(0).norm(), 0.125 * std::sqrt(2.0) / 4.0, 1e-12);
  const PlanResult narrow = plan(blended(way, limits, 0.02));  // Speed sqrt(0.04) = 0.2.
  EXPECT_NEAR(narrow.via_joint_errors.row(0).norm(), 0.02 * std::sqrt(2.0) / 4.0, 1e-12);
  TrajectoryPoint point(2);
  narrow.trajectory.sample(narrow.waypoint_times[1] - 0.1, point);
  EXPECT_NEAR(point.velocity[0], 0.2, 1e-9);
  EXPECT_NEAR(point.position[0], 0.98, 1e-9);
}

TEST(JointBlend, StraightOnNeedsNoBlendAndTurningBackStops) {
  const Limits limits = limitsOf(1, 1.0, 4.0, 40.0);
  const auto duration = [&](const std::vector<VectorX>& way) {
    return plan(blended(way, limits, 0.1)).trajectory.duration();
  };
  EXPECT_NEAR(duration({vector({0.0}), vector({0.4}), vector({0.4}), vector({1.0})}),
              plan(request("trapezoidal", {vector({0.0}), vector({1.0})}, limits)).trajectory.duration(), 1e-12);
  const PlanResult back = plan(blended({vector({0.0}), vector({1.0}), vector({0.0})}, limits, 0.1));
  EXPECT_LT(std::abs(back.via_joint_errors(0, 0)), 1e-12);
  EXPECT_NEAR(back.trajectory.duration(), duration({vector({0.0}), vector({1.0})}) * 2.0, 1e-9);
  EXPECT_NE(joined(back.notes).find("at waypoints[1] the way turns straight back"), std::string::npos);
}

TEST(JointBlend, WhatIsTooLargeIsReducedAndSaidAndWhatIsWrongIsRefused) {
  const Limits limits = limitsOf(2, 5.0, 1.0, 40.0);
  const std::vector<VectorX> way{vector({0.0, 0.0}), vector({1.0, 0.0}), vector({1.0, 0.1}), vector({2.0, 0.1})};
  const PlanResult result = plan(blended(way, limits, 1.0));
  EXPECT_NE(joined(result.notes).find("shared with the next corners: 0.05 at waypoints[1]"), std::string::npos)
      << joined(result.notes);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(result.via_joint_errors.row(k).norm(), 0.05 * std::sqrt(2.0) / 4.0, 1e-9);
  EXPECT_EQ(errorOf(blended(way, limits, -0.1)), AnswerCode::kInvalidGoal);
  PlanRequest timed = blended(way, limits, 0.1);
  timed.waypoints[1].time = 2.0;
  EXPECT_EQ(errorOf(timed), AnswerCode::kInvalidGoal);
  EXPECT_EQ(errorOf(blended(way, Limits::unlimited(2), 0.1)), AnswerCode::kInvalidGoal);
  PlanRequest slow = blended(way, limits, 0.1);
  slow.duration = 2.0 * plan(slow).trajectory.duration();
  EXPECT_EQ(plan(slow).trajectory.duration(), slow.duration);
  EXPECT_FALSE(verifyTrajectory(plan(slow).trajectory, limits, {}));
  slow.duration *= 0.4;
  EXPECT_EQ(errorOf(slow), AnswerCode::kLimitsInfeasible);
  slow.parameters.push_back({"stretch", 1.0});
  EXPECT_NEAR(plan(slow).trajectory.duration(), plan(blended(way, limits, 0.1)).trajectory.duration(), 1e-9);
  const PlanResult stops = plan(blended(way, limits, 0.0));
  EXPECT_EQ(stops.trajectory.duration(), plan(request("multipoint_trapezoidal", way, limits)).trajectory.duration());
}

TEST(JointBlend, AnyRadiusAndAnyWayIsPlannedOrRefusedInWords) {
  constexpr unsigned kSeed = 83;
  Random random(kSeed);
  int planned = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const int joints = random.integer(1, 4);
    std::vector<VectorX> way = randomWay(random, joints, random.integer(3, 7));
    for (std::size_t k = 1; k < way.size(); ++k) {  // Some all but repeated, some all but straight on.
      const double near = std::pow(10.0, random.integer(-13, -3));
      if (random.integer(0, 4) == 0) way[k] = way[k - 1] + near * random.vector(joints, -1.0, 1.0);
      if (k > 1 && random.integer(0, 4) == 0)
        way[k] = 2.0 * way[k - 1] - way[k - 2] + near * random.vector(joints, -1.0, 1.0);
    }
    Limits limits = randomLimits(random, joints);
    if (random.integer(0, 3) == 0) limits.velocity[0] = HUGE_VAL;
    if (random.integer(0, 9) == 0) limits.velocity[0] = 1e-4;
    const double radius = std::pow(10.0, random.uniform(-14.0, 5.0));
    const std::string what = "seed 83, trial " + std::to_string(trial);
    try {
      const JointTrajectory motion = plan(blended(way, limits, radius)).trajectory;
      double stops = 0.0;
      for (std::size_t k = 1; k < way.size(); ++k)
        stops += plan(request("trapezoidal", {way[k - 1], way[k]}, limits)).trajectory.duration();
      EXPECT_LE(motion.duration(), stops * (1.0 + 2e-5)) << what << ", radius " << radius;
      ++planned;
    } catch (const InputError& error) {
      ASSERT_GT(std::string(error.what()).size(), 10U) << what;
    } catch (const std::exception& error) {
      FAIL() << what << ": " << error.what();
    }
  }
  EXPECT_GT(planned, 2500);
}

TEST(JointBlend, TheCheckSeesAWayThatLeavesTheLines) {
  const std::vector<VectorX> way{vector({0.0, 0.0}), vector({1.0, 0.0}), vector({1.0, 1.0})};
  const Limits limits = limitsOf(2, 1.0, 4.0, 40.0);
  EXPECT_GT(worstOf(plan(request("multipoint_cubic", way, limits)).trajectory, way, 0.1).off_outside, 1e-3);
  EXPECT_GT(worstOf(plan(blended(way, limits, 0.4)).trajectory, way, 0.01).off_outside, 1e-3);
}

VectorX alignedWrist() {
  return vector({0.3, -0.7, 0.6, 0.4, 0.0, -0.9});
}

/// A path of the tip that leaves the aligned wrist as its fifth joint turns: from q4 = 0.4 on alone.
std::vector<Pose> awayFromAligned(const Arm& arm) {
  Matrix6X J(6, 6);
  const Pose M = geometricJacobian(arm.chain, alignedWrist(), J);
  const Vector6 V = J * vector({0.3, 0.2, -0.4, 0.0, 0.8, 0.1});
  return {M, {rotationAbout(V.tail<3>().normalized(), 0.5 * V.tail<3>().norm()) * M.R, M.p + 0.5 * V.head<3>()}};
}

/// The aligned wrist with its fourth joint turned, and the sixth so that the pose stays.
VectorX turnedAligned(const Arm& arm, double angle) {
  const Pose M = forwardKinematics(arm.chain, alignedWrist());
  for (const double sign : {1.0, -1.0}) {
    VectorX q = alignedWrist();
    q[3] += angle;
    q[5] += sign * angle;
    if (isApprox(forwardKinematics(arm.chain, q), M, 1e-9)) return q;
  }
  return {};
}

TEST(TurnInPlace, AnAlignedWristTurnsBeforeTheTipLeavesAndAfterItArrives) {
  const Arm arm("puma560");
  const std::vector<Pose> way = awayFromAligned(arm);
  for (const double angle : {0.5, -1.1}) {
    const VectorX given = turnedAligned(arm, angle);
    ASSERT_EQ(given.size(), 6);
    for (const bool back : {false, true}) {
      PlanRequest question =
          arm.request("cartesian_line", back ? std::vector<Pose>{way[1], way[0]} : way, alignedWrist());
      (back ? question.waypoints.back() : question.waypoints.front()).position = given;
      const PlanResult result = plan(question);
      const std::string notes = joined(result.notes);
      EXPECT_NE(notes.find(back ? "turn in place there last" : "turn in place there first"), std::string::npos)
          << notes;
      EXPECT_LT(((back ? result.waypoints.back() : result.waypoints.front()) - given).norm(), 1e-6);
      EXPECT_LE(largestUse(result.trajectory, arm.limits(), 4000), 1.0 + 1e-6);
      EXPECT_FALSE(verifyTrajectory(result.trajectory, arm.limits(), {}));
      TrajectoryPoint point(6);
      result.trajectory.sample(back ? result.trajectory.duration() : 0.0, point);
      EXPECT_LT((point.position - given).norm(), 1e-6);
      double worst = 0.0;
      for (int k = 0; k <= 500; ++k) {
        result.trajectory.sample(result.trajectory.duration() * k / 500, point);
        worst = std::max(worst, offLine(arm.task, way[0], way[1], forwardKinematics(arm.chain, point.position)));
      }
      EXPECT_LT(worst, 1e-6) << notes;
      PlanRequest law = question;
      law.time_law = "polynomial_345";
      EXPECT_EQ(errorOf(law), AnswerCode::kPathNotContinuous);
      EXPECT_NE(messageOf(law).find("turn in place"), std::string::npos) << messageOf(law);
    }
  }
}

TEST(TurnInPlace, AtAStopInASingularityTheJointsTurnToWhereThePathGoesOn) {
  const Arm arm("puma560");
  const std::vector<Pose> first = awayFromAligned(arm);
  const VectorX turned = turnedAligned(arm, 0.7);
  Matrix6X J(6, 6);
  const Pose M = geometricJacobian(arm.chain, turned, J);
  const Vector6 V = J * vector({-0.2, 0.1, 0.3, 0.0, 0.8, -0.1});
  const Pose last{rotationAbout(V.tail<3>().normalized(), 0.5 * V.tail<3>().norm()) * M.R, M.p + 0.5 * V.head<3>()};
  const std::vector<Pose> way{first[1], M, last};
  const PlanResult result = plan(arm.request("cartesian_line", way, alignedWrist()));
  EXPECT_NE(joined(result.notes).find("the joints turn in place there, for "), std::string::npos)
      << joined(result.notes);
  EXPECT_LE(largestUse(result.trajectory, arm.limits(), 4000), 1.0 + 1e-6);
  EXPECT_FALSE(verifyTrajectory(result.trajectory, arm.limits(), {}));
  TrajectoryPoint point(6);
  double worst = 0.0;
  for (int k = 0; k <= 1000; ++k) {
    result.trajectory.sample(result.trajectory.duration() * k / 1000, point);
    const Pose X = forwardKinematics(arm.chain, point.position);
    worst = std::max(worst, std::min(offLine(arm.task, way[0], way[1], X), offLine(arm.task, way[1], way[2], X)));
  }
  EXPECT_LT(worst, 1e-6);
}

TEST(TurnInPlace, WithoutASingularityJointValuesElsewhereAreRefused) {
  const Arm arm("puma560");
  const VectorX q = vector({0.3, -0.7, 0.6, 0.4, 0.6, -0.9});
  const Pose A = forwardKinematics(arm.chain, q);
  const Pose B{A.R, A.p + Vector3(0.05, 0.05, 0.0)};
  PlanRequest question = arm.request("cartesian_line", {A, B}, q);
  IkRequest goal;
  goal.target = B;
  goal.seed = q;
  const IkResult solutions = arm.kinematics.solve(goal);
  ASSERT_GT(solutions.solutions.size(), 1U);
  question.waypoints.front().position = q;
  question.waypoints.back().position = solutions.solutions.back().position;  // Another branch.
  EXPECT_EQ(errorOf(question), AnswerCode::kPathNotContinuous);
}

TEST(CartesianGoal, AContinuousJointMayArriveInAnotherTurn) {
  const Arm arm("rrr_planar");
  const VectorX start = vector({0.3, 0.9, 0.4});
  VectorX goal = vector({0.5, 0.8, 0.7});
  PlanRequest question = arm.request("cartesian_line", {{}, {}}, start);
  question.waypoints.front().position = start;
  question.waypoints.back().position = goal;
  const double duration = plan(question).trajectory.duration();
  question.waypoints.back().position[2] += kTwoPi;
  EXPECT_EQ(errorOf(question), AnswerCode::kPathNotContinuous);
  question.continuous = {2};
  const PlanResult result = plan(question);
  EXPECT_LT((result.waypoints.back() - goal).norm(), 1e-6);
  EXPECT_NEAR(result.trajectory.duration(), duration, 1e-9);
  EXPECT_NE(joined(result.notes).find("in another turn"), std::string::npos) << joined(result.notes);
  question.parameters = {{"keep_turns", 1.0}};
  EXPECT_EQ(errorOf(question), AnswerCode::kPathNotContinuous);
}

TEST(CartesianBlend, TheMessageSaysWhatTheCornersAre) {
  const Arm arm("puma560");
  const VectorX q = vector({0.3, -0.7, 0.6, 0.4, 0.6, -0.9});
  const Pose A = forwardKinematics(arm.chain, q);
  const auto at = [&](double x, double y) { return Pose{A.R, A.p + Vector3(x, y, 0.0)}; };
  PlanRequest question = arm.request("cartesian_line", {A, at(0.1, 0.0), at(0.1, 0.06)}, q);
  question.parameters = {{"blend_radius", 0.02}};
  EXPECT_NE(joined(plan(question).notes).find("at a distance of up to 0.0053"), std::string::npos);
  EXPECT_NE(joined(plan(question).notes).find("the lines between them at up to 0.00375 m"), std::string::npos);
  EXPECT_EQ(joined(plan(question).notes).find("shared"), std::string::npos);
  question.parameters = {{"blend_radius", 0.08}};
  const PlanResult wide = plan(question);
  EXPECT_NE(joined(wide.notes).find("shared with the next corners: 0.06 m at waypoints[1]"), std::string::npos)
      << joined(wide.notes);
  TrajectoryPoint point(6);
  double miss = HUGE_VAL;
  for (int k = 0; k <= 4000; ++k) {
    wide.trajectory.sample(wide.trajectory.duration() * k / 4000, point);
    miss = std::min(miss, (forwardKinematics(arm.chain, point.position).p - at(0.1, 0.0).p).norm());
  }
  EXPECT_NEAR(miss, 0.1875 * std::sqrt(2.0) * 0.06, 1e-5);
}

}  // namespace
}  // namespace trajectory_test
}  // namespace screwline
