// Lines in joint space with rounded corners (path_time_optimal with a blend_radius): a C2 path within the radius, its
// deviation told exactly, limits held, jerk limits too.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "property/cartesian_support.h"
#include "property/path_support.h"
#include "screwline/trajectory/rounded_path.h"
#include "screwline/trajectory/verify.h"

namespace screwline {
namespace trajectory_test {
namespace {

double toLine(const VectorX& a, const VectorX& b, const VectorX& q) {
  const VectorX d = b - a;
  const double s = d.norm() > 0.0 ? std::clamp(d.dot(q - a) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (q - a - s * d).norm();
}

double toLines(const MatrixX& way, const VectorX& q) {
  double least = HUGE_VAL;
  for (Eigen::Index k = 1; k < way.cols(); ++k) least = std::min(least, toLine(way.col(k - 1), way.col(k), q));
  return least;
}

VectorX placeOn(const JointPath& path, double u, int order = 0) {
  VectorX values[4];
  for (VectorX& v : values) v.resize(path.joints());
  path.at(u, values[0].data(), values[1].data(), values[2].data(), values[3].data());
  return values[order];
}

MatrixX columns(const std::vector<VectorX>& way) {
  MatrixX positions(way.front().size(), static_cast<Eigen::Index>(way.size()));
  for (std::size_t k = 0; k < way.size(); ++k) positions.col(static_cast<Eigen::Index>(k)) = way[k];
  return positions;
}

PlanRequest rounded(const MatrixX& way, const Limits& limits, double radius, bool jerk = false, int grid = 0) {
  std::vector<VectorX> waypoints;
  for (Eigen::Index k = 0; k < way.cols(); ++k) waypoints.push_back(way.col(k));
  PlanRequest r = request("path_time_optimal", waypoints, limits);
  r.parameters = {{"blend_radius", radius}, {"hold_jerk", jerk ? 1.0 : 0.0}, {"grid_points", 1.0 * grid}};
  return r;
}

TEST(FairReaches, NoCornerCanHaveMoreWithoutTakingFromOneThatHasNoMore) {
  Random random(201);
  for (int trial = 0; trial < 500; ++trial) {
    const std::size_t lines = static_cast<std::size_t>(random.integer(1, 12));
    std::vector<double> lengths(lines), most(lines + 1, 0.0);
    for (double& length : lengths) length = std::exp(random.uniform(-3.0, 1.0));
    for (std::size_t k = 1; k < lines; ++k) most[k] = random.integer(0, 4) == 0 ? 0.0 : random.uniform(0.0, 1.5);
    const std::vector<double> reaches = fairReaches(lengths, most);
    for (std::size_t k = 0; k < lines; ++k) EXPECT_LE(reaches[k] + reaches[k + 1], lengths[k] * (1.0 + 1e-15));
    for (std::size_t k = 1; k < lines; ++k) {
      ASSERT_LE(reaches[k], most[k]);
      const auto bound = [&](std::size_t line,
                             std::size_t neighbour) {  // The line is full, its other corner no larger.
        return reaches[k] + reaches[neighbour] >= lengths[line] * (1.0 - 1e-12) &&
               reaches[neighbour] <= reaches[k] * (1.0 + 1e-12);
      };
      EXPECT_TRUE(reaches[k] == most[k] || bound(k - 1, k - 1) || bound(k, k + 1)) << "seed 201, trial " << trial;
    }
  }
}

TEST(FairReaches, ByHand) {
  // The ends take nothing; the corner of the short line is content with less than half of the long one.
  const std::vector<double> reaches = fairReaches({1.0, 0.2, 2.0, 1.0}, {0.0, 9.0, 9.0, 9.0, 0.0});
  const std::vector<double> wanted{0.0, 0.1, 0.1, 1.0, 0.0};
  for (std::size_t k = 0; k < wanted.size(); ++k) EXPECT_DOUBLE_EQ(reaches[k], wanted[k]);
  EXPECT_EQ(fairReaches({1.0, 1.0}, {0.0, 0.3, 0.0})[1], 0.3);
}

TEST(RoundedPath, IsC2KeepsToTheLinesOutsideTheRadiusAndSaysHowFarItIsOff) {
  constexpr unsigned kSeed = 202;
  Random random(kSeed);
  for (int trial = 0; trial < 60; ++trial) {
    const int joints = random.integer(1, 7);
    const MatrixX way = randomWay(random, joints, random.integer(3, 9));
    const double radius = std::exp(random.uniform(-4.0, 1.0));
    const RoundedLines lines = roundedLines(way, radius);
    const std::string what = "seed 202, trial " + std::to_string(trial);
    const auto& breaks = lines.path.breaks();
    for (std::size_t k = 1; k + 1 < breaks.size(); ++k) {
      const bool corner = std::find(lines.waypoints.begin(), lines.waypoints.end(), breaks[k]) != lines.waypoints.end();
      EXPECT_EQ(lines.path.turnsAt(k), corner) << what;  // With one joint the way can only turn back.
      const double before = std::nextafter(breaks[k], 0.0);
      for (int order = 1; order < 3 && !corner; ++order) {
        const VectorX step = placeOn(lines.path, breaks[k], order) - placeOn(lines.path, before, order);
        EXPECT_LT(step.cwiseAbs().maxCoeff(), 1e-9) << what << ", order " << order;
      }
    }
    for (std::size_t k = 1; k + 1 < lines.corners.size(); ++k) {
      const Corner& corner = lines.corners[k];
      const Eigen::Index i = static_cast<Eigen::Index>(k);
      ASSERT_LE(corner.reach, radius);
      const auto at = std::find(breaks.begin(), breaks.end(), lines.waypoints[k]);
      EXPECT_EQ(corner.stops, at != breaks.end()) << what;  // One joint goes on or back.
      EXPECT_EQ(corner.reach == 0.0, joints == 1) << what;
      double nearest = HUGE_VAL, farthest = 0.0;
      for (int s = -500; s <= 500; ++s) {
        const VectorX q = placeOn(lines.path, lines.waypoints[k] + corner.reach * s / 500);
        nearest = std::min(nearest, (q - way.col(i)).norm());
        farthest =
            std::max(farthest, std::min(toLine(way.col(i - 1), way.col(i), q), toLine(way.col(i), way.col(i + 1), q)));
      }
      EXPECT_NEAR(nearest, corner.deviation, 1e-9) << what;
      EXPECT_NEAR(farthest, corner.off_lines, 1e-9) << what;
    }
    for (int s = 0; s <= 1000; ++s) {
      const VectorX q = placeOn(lines.path, lines.path.length() * s / 1000);
      const double away = (way.colwise() - q).colwise().norm().minCoeff();
      if (away > radius) {
        EXPECT_LT(toLines(way, q), 1e-9) << what;
      }
    }
  }
}

TEST(RoundedPath, StraightOnRepeatedAndBackAreWhatTheyLookLike) {
  const MatrixX way = columns({vector({0.0, 0.0}), vector({0.5, 0.0}), vector({0.5, 0.0}), vector({1.0, 0.0}),
                               vector({1.0, 1.0}), vector({1.0, 1.0}), vector({1.0, 0.5})});
  const RoundedLines lines = roundedLines(way, 0.2);
  EXPECT_EQ(lines.waypoints.size(), 7U);
  EXPECT_EQ(lines.waypoints[1], lines.waypoints[2]);
  EXPECT_EQ(lines.corners[1].reach, 0.0);  // Straight on: neither blend nor stop.
  EXPECT_FALSE(lines.corners[1].stops);
  EXPECT_DOUBLE_EQ(lines.corners[3].reach, 0.2);
  EXPECT_NEAR(lines.corners[3].deviation, 0.2 * 3.0 / 16.0 * std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(lines.corners[3].off_lines, 0.2 * 3.0 / 16.0, 1e-15);
  for (const std::size_t k : {4U, 5U}) {
    EXPECT_TRUE(lines.corners[k].stops);
    EXPECT_EQ(lines.corners[k].deviation, 0.0);
    EXPECT_NEAR((placeOn(lines.path, lines.waypoints[k]) - way.col(4)).norm(), 0.0, 1e-15);
  }
  const PlanResult result = plan(rounded(way, limitsOf(2, 1.0, 4.0, 40.0), 0.2, true));
  TrajectoryPoint point(2);
  result.trajectory.sample(result.waypoint_times[4], point);
  EXPECT_LT(point.velocity.norm(), 1e-6);
  EXPECT_NE(joined(result.notes).find("2 waypoints, the first of them waypoints[4], the way turns straight back"),
            std::string::npos)
      << joined(result.notes);
  EXPECT_NE(joined(result.notes).find("at a distance of up to 0.0530"), std::string::npos) << joined(result.notes);
}

TEST(RoundedPath, ShortLinesAreSharedFairlyAndThatIsSaid) {
  const MatrixX way = columns({vector({0.0, 0.0}), vector({1.0, 0.0}), vector({1.0, 0.1}), vector({2.0, 0.1})});
  const PlanResult result = plan(rounded(way, limitsOf(2, 1.0, 4.0, 40.0), 0.3));
  EXPECT_NE(joined(result.notes).find("too short for blend_radius and shared with the next corners: 0.05"),
            std::string::npos)
      << joined(result.notes);
  for (int k = 0; k < 2; ++k)
    EXPECT_NEAR(result.via_joint_errors.row(k).norm(), 0.05 * 3.0 / 16.0 * std::sqrt(2.0), 1e-9);
}

TEST(RoundedMotion, KeepsAllLimitsAndIsFasterThanStopsAndThanTheSameWithLess) {
  constexpr unsigned kSeed = 203;
  Random random(kSeed);
  for (int trial = 0; trial < 12; ++trial) {
    const int joints = random.integer(2, 6);
    const Limits limits = randomLimits(random, joints);
    const MatrixX way = randomWay(random, joints, random.integer(3, 4));
    const bool jerk = trial % 4 == 3;
    const std::string what = "seed 203, trial " + std::to_string(trial);
    double before = plan(rounded(way, limits, 0.0, jerk)).trajectory.duration();
    for (const double radius : {0.1, 0.6}) {
      const PlanResult result = plan(rounded(way, limits, radius, jerk));
      EXPECT_LE(denseUse(result.trajectory, limits, 5000, jerk ? 3 : 2), 1.0 + 1e-6) << what;
      EXPECT_FALSE(verifyTrajectory(result.trajectory, limits, {})) << what;
      EXPECT_EQ(result.trajectory.continuity(), jerk ? 2 : 1) << what;
      EXPECT_LT(result.trajectory.duration(), before * 1.001) << what << ", radius " << radius;
      before = result.trajectory.duration();
      TrajectoryPoint point(joints);
      double off = 0.0;
      for (int i = 0; i <= 2000; ++i) {
        result.trajectory.sample(result.trajectory.duration() * i / 2000, point);
        off = std::max(off, toLines(way, point.position));
      }
      double told = 0.0;
      for (const Corner& corner : roundedLines(way, radius).corners) told = std::max(told, corner.off_lines);
      EXPECT_LE(off, told + 1e-9) << what;
    }
  }
}

TEST(RoundedMotion, RadiusZeroIsTheLinesWithStopsAndTheWayBackTakesAsLong) {
  Random random(204);
  const Limits limits = randomLimits(random, 4);
  const MatrixX way = randomWay(random, 4, 5);
  const PlanResult stops = plan(rounded(way, limits, 0.0));
  double sum = 0.0;
  for (Eigen::Index k = 1; k < way.cols(); ++k)
    sum += plan(request("trapezoidal", {way.col(k - 1), way.col(k)}, limits)).trajectory.duration();
  EXPECT_NEAR(stops.trajectory.duration(), sum, 1e-3 * sum);
  EXPECT_LT(stops.via_joint_errors.cwiseAbs().maxCoeff(), 1e-9);
  for (const bool jerk : {false, true}) {
    const double there = plan(rounded(way, limits, 0.3, jerk, 1000)).trajectory.duration();
    EXPECT_NEAR(plan(rounded(way.rowwise().reverse(), limits, 0.3, jerk, 1000)).trajectory.duration(), there,
                1e-3 * there);
  }
}

TEST(RoundedMotion, TakesVelocitiesAtItsEndsDurationsAndAToolsBound) {
  const MatrixX way = columns({vector({0.0, 0.0}), vector({1.0, 0.0}), vector({1.0, 1.0})});
  PlanRequest r = rounded(way, limitsOf(2, 1.0, 4.0, 40.0), 0.2);
  r.waypoints[0].velocity = vector({0.5, 0.0});
  TrajectoryPoint point(2);
  plan(r).trajectory.sample(0.0, point);
  EXPECT_NEAR(point.velocity[0], 0.5, 1e-12);
  r.waypoints[0].velocity = vector({0.0, 0.5});
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
  r.waypoints[0].velocity = {};
  const double shortest = plan(r).trajectory.duration();
  r.duration = 2.0 * shortest;
  EXPECT_EQ(plan(r).trajectory.duration(), r.duration);
  r.duration = 0.9 * shortest;
  EXPECT_NE(messageOf(r).find("shortest feasible duration is"), std::string::npos);
  r.parameters = {{"blend_radius", -0.2}};
  EXPECT_NE(messageOf(r).find("'blend_radius' is -0.2, it must not be negative"), std::string::npos);
}

TEST(RoundedMotion, AnyRadiusAndAnyWayIsPlannedOrRefusedInWords) {
  constexpr unsigned kSeed = 205;
  Random random(kSeed);
  for (int trial = 0; trial < 200; ++trial) {
    const int joints = random.integer(1, 4);
    MatrixX way = randomWay(random, joints, random.integer(3, 7));
    for (Eigen::Index k = 1; k < way.cols(); ++k) {  // Some all but repeated, straight on, or back.
      const double near = std::pow(10.0, random.integer(-13, -2));
      if (random.integer(0, 4) == 0) way.col(k) = way.col(k - 1) + near * random.vector(joints, -1.0, 1.0);
      if (k > 1 && random.integer(0, 4) == 0)
        way.col(k) = way.col(k - 1) + random.integer(-1, 1) * (way.col(k - 1) - way.col(k - 2)) +
                     near * random.vector(joints, -1.0, 1.0);
    }
    const double radius = std::pow(10.0, random.uniform(-10.0, 3.0));
    const Limits limits = randomLimits(random, joints);
    const std::string what = "seed 205, trial " + std::to_string(trial);
    try {
      const PlanResult result = plan(rounded(way, limits, radius, trial % 40 == 0, 600));
      EXPECT_LE(denseUse(result.trajectory, limits, 500, 2), 1.0 + 1e-6) << what;
    } catch (const std::exception& error) {
      FAIL() << what << ", radius " << radius << ": " << error.what();
    }
  }
}

TEST(RoundedPath, TheCheckSeesASpline) {
  const MatrixX way = columns({vector({0.0, 0.0}), vector({1.0, 0.0}), vector({1.0, 1.0})});
  const JointPath spline = naturalSplinePath(uniformKnots(3), way);
  double off = 0.0;
  for (int s = 0; s <= 100; ++s) off = std::max(off, toLines(way, placeOn(spline, 0.01 * s)));
  EXPECT_GT(off, 0.05);
}

}  // namespace
}  // namespace trajectory_test
}  // namespace screwline
