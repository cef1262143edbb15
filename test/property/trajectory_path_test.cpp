// Motion along a path: the composition's exact figures, and re-timing against the reference and by laws.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "property/path_support.h"
#include "screwline/trajectory/retime.h"
#include "screwline/trajectory/verify.h"
#include "unit/trajectory_support.h"

namespace screwline {
namespace {

using trajectory_test::denseUse;
using trajectory_test::errorOf;
using trajectory_test::limitsOf;
using trajectory_test::messageOf;
using trajectory_test::Random;
using trajectory_test::randomLimits;
using trajectory_test::randomSpline;
using trajectory_test::randomWay;
using trajectory_test::request;
using trajectory_test::uniformKnots;
using trajectory_test::vector;

using Row = std::map<std::string, double>;

std::vector<Row> readCsv(const std::string& name) {
  std::ifstream file(std::string(SCREWLINE_TEST_DATA) + "/" + name);
  std::vector<std::string> columns;
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::stringstream cells(line);
    Row row;
    std::size_t k = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++k) {
      if (rows.empty() && columns.size() == k) {
        columns.push_back(cell);
      } else if (cell.find_first_not_of("+-.0123456789e") == std::string::npos) {
        row[columns[k]] = std::stod(cell);
      }
    }
    rows.push_back(row);
  }
  if (!rows.empty()) rows.erase(rows.begin());
  return rows;
}

JointPath randomQuintic(Random& random, int joints, int count) {
  return quinticPath(uniformKnots(count), randomWay(random, joints, count), randomWay(random, joints, count),
                     randomWay(random, joints, count));
}

TEST(PathTimeOptimal, EveryReferenceRowIsAsShortAndKeepsItsLimitsEverywhere) {
  const std::vector<Row> points = readCsv("path_waypoints.csv");
  const std::vector<Row> references = readCsv("path_durations.csv");
  ASSERT_EQ(references.size(), 25u);
  double sum = 0.0;
  for (Row row : references) {
    PlanRequest r;
    r.profile = "path_time_optimal";
    r.limits = Limits::unlimited(6);
    for (int j = 0; j < 6; ++j) {
      r.limits.velocity[j] = row.at("vmax" + std::to_string(j));
      r.limits.acceleration[j] = row.at("amax" + std::to_string(j));
    }
    for (Row point : points) {
      if (point.at("path") != row.at("path")) continue;
      PathPoint waypoint;
      waypoint.position.resize(6);
      for (int j = 0; j < 6; ++j) waypoint.position[j] = point.at("q" + std::to_string(j));
      r.waypoints.push_back(waypoint);
    }
    ASSERT_EQ(static_cast<double>(r.waypoints.size()), row.at("n_wp"));
    const PlanResult result = plan(r);
    const double ratio = result.trajectory.duration() / row.at("T_interp_N4000");
    EXPECT_LT(ratio, 1.005) << "path " << row.at("path");
    EXPECT_GT(ratio, 0.999) << "path " << row.at("path");  // The reference's limits are broken by less than that.
    EXPECT_LT(denseUse(result.trajectory, r.limits, 50000, 2), 1.0 + 1e-9) << "path " << row.at("path");
    if (r.waypoints.size() > 2) {
      EXPECT_LT(result.via_joint_errors.cwiseAbs().maxCoeff(), 1e-9);
    }
    sum += ratio;
  }
  EXPECT_LT(sum / 25.0, 1.002);
}

TEST(PathTimeOptimal, IsTheTrapezoidOnAStraightLine) {
  Random random(11);
  for (int trial = 0; trial < 20; ++trial) {
    const int joints = random.integer(1, 7);
    const std::vector<VectorX> way{random.vector(joints, -2.0, 2.0), random.vector(joints, -2.0, 2.0)};
    const Limits limits = randomLimits(random, joints);
    const double trapezoid = plan(request("trapezoidal", way, limits)).trajectory.duration();
    const double retimed = plan(request("path_time_optimal", way, limits)).trajectory.duration();
    EXPECT_NEAR(retimed, trapezoid, 2e-3 * trapezoid) << "seed 11, trial " << trial;
    EXPECT_GT(retimed, trapezoid * (1.0 - 1e-9)) << "seed 11, trial " << trial;
  }
}

TEST(PathTimeOptimal, LimitsHoldOnRandomPathsAndTheCheckerSeesATenthOfAPercent) {
  Random random(12);
  for (int trial = 0; trial < 30; ++trial) {
    const int joints = random.integer(1, 7);
    const JointPath path = trial % 2 == 0 ? randomSpline(random, joints, random.integer(2, 20))
                                          : randomQuintic(random, joints, random.integer(2, 12));
    const Limits limits = randomLimits(random, joints);
    const RetimeResult result = retime(path, limits);
    ASSERT_EQ(result.status, RetimeStatus::kDone);
    Limits held = limits;
    held.jerk.setConstant(HUGE_VAL);
    const auto motion = JointTrajectory::alongPath(path, result.law, result.duration);
    EXPECT_LT(denseUse(motion, limits, 20000, 2), 1.0 + 1e-9) << "seed 12, trial " << trial;
    EXPECT_GT(denseUse(motion, limits, 20000, 2), 0.99) << "seed 12, trial " << trial;
    EXPECT_FALSE(verifyTrajectory(motion, held, {}).has_value()) << "seed 12, trial " << trial;
    const auto hasty = JointTrajectory::alongPath(path, result.law, result.duration * 0.999);
    EXPECT_TRUE(verifyTrajectory(hasty, held, {}).has_value()) << "seed 12, trial " << trial;
    EXPECT_GT(denseUse(hasty, limits, 20000, 2), 1.0) << "seed 12, trial " << trial;
  }
}

TEST(PathTimeOptimal, TheWayBackTakesAsLong) {
  Random random(13);
  for (int trial = 0; trial < 10; ++trial) {
    const int count = random.integer(3, 9);
    const MatrixX way = randomWay(random, 6, count);
    const Limits limits = randomLimits(random, 6);
    const double there = retime(naturalSplinePath(uniformKnots(count), way), limits).duration;
    const double back = retime(naturalSplinePath(uniformKnots(count), way.rowwise().reverse()), limits).duration;
    EXPECT_NEAR(there, back, 2e-3 * there) << "seed 13, trial " << trial;
  }
}

TEST(PathTimeOptimal, AFinerGridIsNeverMuchLonger) {
  Random random(14);
  for (int trial = 0; trial < 10; ++trial) {
    const JointPath path = randomSpline(random, 6, random.integer(3, 9));
    const Limits limits = randomLimits(random, 6);
    RetimeOptions coarse, fine;
    coarse.grid_points = 500;
    fine.grid_points = 8000;
    const double longer = retime(path, limits, coarse).duration;
    const double shorter = retime(path, limits, fine).duration;
    EXPECT_LT(shorter, longer * (1.0 + 1e-4)) << "seed 14, trial " << trial;
    EXPECT_LT(longer, shorter * 1.03) << "seed 14, trial " << trial;
  }
}

TEST(Retime, MovingEndsAreMetAndTooFastOnesNameWhatIsFeasible) {
  Random random(15);
  int refused = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const JointPath path = randomSpline(random, 4, random.integer(2, 6));
    const Limits limits = randomLimits(random, 4);
    RetimeOptions options;
    options.start_rate = random.uniform(0.0, 0.8);
    options.end_rate = random.uniform(0.0, 0.8);
    RetimeResult result = retime(path, limits, options);
    for (int round = 0; round < 3 && result.status != RetimeStatus::kDone; ++round) {
      ++refused;
      options.start_rate = result.start_rate * (1.0 - 1e-9);
      options.end_rate = result.end_rate * (1.0 - 1e-9);
      result = retime(path, limits, options);
    }
    ASSERT_EQ(result.status, RetimeStatus::kDone) << "seed 15, trial " << trial;
    const auto motion = JointTrajectory::alongPath(path, result.law, result.duration);
    EXPECT_LT(denseUse(motion, limits, 5000, 2), 1.0 + 1e-9) << "seed 15, trial " << trial;
    EXPECT_NEAR(result.law.at(0.0).ds / result.duration, options.start_rate, 1e-9);
    EXPECT_NEAR(result.law.at(1.0).ds / result.duration, options.end_rate, 1e-9);
  }
  EXPECT_GT(refused, 3);
}

TEST(Retime, APathThatTurnsIsStoppedAt) {
  const Limits limits = limitsOf(2, 1.0, 4.0, HUGE_VAL);
  MatrixX way(2, 3);
  way << 0.0, 1.0, 1.0, 0.0, 0.0, 2.0;
  const JointPath path = linePath({0.0, 1.0, 3.0}, way);
  EXPECT_TRUE(path.turnsAt(1));
  const RetimeResult result = retime(path, limits);
  const auto motion = JointTrajectory::alongPath(path, result.law, result.duration);
  const double both = (1.0 + 0.25) + (2.0 + 0.25);  // Distance / v + v / a for each.
  EXPECT_NEAR(result.duration, both, 2e-3 * both);
  EXPECT_EQ(motion.continuity(), 1);
  TrajectoryPoint point(2);
  motion.sample(1.25 / both * result.duration, point);
  EXPECT_LT(point.velocity.norm(), 0.05);
  EXPECT_FALSE(verifyTrajectory(motion, limits, {}).has_value());
}

TEST(Retime, ARateBoundHolds) {
  Random random(16);
  const JointPath path = randomSpline(random, 6, 5);
  RetimeOptions options;
  options.rate_bound = [](double from, double) { return from < 0.5 ? 0.05 : HUGE_VAL; };
  const RetimeResult result = retime(path, randomLimits(random, 6), options);
  double most = 0.0;
  for (const auto& point : result.points) {
    if (point.u <= 0.5) {
      EXPECT_LE(point.rate, 0.05 * (1.0 + 1e-12));
    }
    most = std::max(most, point.rate);
  }
  EXPECT_GT(most, 0.06);
}

TEST(AlongPath, ExactFiguresBoundDenseSamplesOfEveryScaling) {
  Random random(17);
  const TimeLaw laws[] = {TimeLaw::cubic(), TimeLaw::polynomial345(), TimeLaw::polynomial4567(), TimeLaw::cycloidal(),
                          TimeLaw::trapezoidal(0.3)};
  for (int trial = 0; trial < 20; ++trial) {
    const JointPath path =
        trial % 2 == 0 ? randomSpline(random, 3, random.integer(2, 8)) : randomQuintic(random, 3, random.integer(2, 8));
    const double duration = random.uniform(0.5, 5.0);
    const auto motion = JointTrajectory::alongPath(path, laws[trial % 5], duration);
    TrajectoryPoint point(3);
    MatrixX peaks = MatrixX::Zero(3, 3);
    VectorX square = VectorX::Zero(3);
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      motion.sample(duration * (i + 0.5) / kSteps, point);
      peaks.col(0) = peaks.col(0).cwiseMax(point.velocity.cwiseAbs());
      peaks.col(1) = peaks.col(1).cwiseMax(point.acceleration.cwiseAbs());
      peaks.col(2) = peaks.col(2).cwiseMax(point.jerk.cwiseAbs());
      square += point.acceleration.cwiseAbs2() * (duration / kSteps);
    }
    for (int j = 0; j < 3; ++j) {
      const JointExtrema e = motion.extrema(j);
      const double exact[] = {e.velocity, e.acceleration, e.jerk};
      for (int order = 0; order < 3; ++order) {
        EXPECT_LE(peaks(j, order), exact[order] * (1.0 + 1e-9)) << "seed 17, trial " << trial << " order " << order;
        EXPECT_GT(peaks(j, order), exact[order] * 0.99) << "seed 17, trial " << trial << " order " << order;
      }
      EXPECT_NEAR(square[j], e.squared_acceleration, 2e-3 * e.squared_acceleration) << "seed 17, trial " << trial;
    }
  }
}

TEST(AlongPath, DerivativesEqualFiniteDifferences) {
  Random random(18);
  for (int trial = 0; trial < 10; ++trial) {
    const JointPath path = randomQuintic(random, 5, 4);
    const auto motion = JointTrajectory::alongPath(path, TimeLaw::polynomial4567(), 2.0);
    TrajectoryPoint before(5), at(5), after(5);
    constexpr double h = 1e-5;
    for (int i = 1; i < 50; ++i) {
      const double t = 2.0 * (i + 0.123) / 50.0;
      motion.sample(t - h, before);
      motion.sample(t, at);
      motion.sample(t + h, after);
      EXPECT_LT((at.velocity - (after.position - before.position) / (2.0 * h)).norm(), 1e-5) << "seed 18";
      EXPECT_LT((at.acceleration - (after.velocity - before.velocity) / (2.0 * h)).norm(), 1e-3) << "seed 18";
      EXPECT_LT((at.jerk - (after.acceleration - before.acceleration) / (2.0 * h)).norm(),
                0.05 * (1.0 + at.jerk.norm()))
          << "seed 18";
    }
  }
}

TEST(AlongPath, ContinuityAndEndsAsPromised) {
  Random random(19);
  const JointPath path = randomSpline(random, 3, 6);
  EXPECT_EQ(path.curve().continuity, 2);
  EXPECT_LT(stepInside(path.curve(), 0, 2), 1e-9);
  EXPECT_NEAR(path.curve().atEnd(0, 1, 2, false), 0.0, 1e-10);
  EXPECT_NEAR(path.curve().atEnd(4, 1, 2, true), 0.0, 1e-10);
  EXPECT_EQ(JointTrajectory::alongPath(path, TimeLaw::polynomial345(), 2.0).continuity(), 2);
  EXPECT_EQ(JointTrajectory::alongPath(path, TimeLaw::cubic(), 2.0).continuity(), 1);
  const auto still = JointTrajectory::alongPath(path, TimeLaw::cubic(), 0.0);
  TrajectoryPoint point(3);
  still.sample(1.0, point);
  EXPECT_EQ(point.velocity.norm(), 0.0);
  EXPECT_LT((point.position - VectorX(VectorX::NullaryExpr(
                                  3, [&](Eigen::Index j) { return path.curve().at(0, 0, static_cast<int>(j)); })))
                .norm(),
            1e-12);
}

TEST(PathTimeOptimal, BadRequestsAreRefusedAndGivenDurationsKept) {
  const std::vector<VectorX> way{vector({0.0, 1.0}), vector({0.7, 1.5}), vector({0.7, 1.5}), vector({0.9, -0.5})};
  const Limits limits = limitsOf(2, 1.0, 4.0, 40.0);
  PlanRequest r = request("path_time_optimal", way, limits);
  const double shortest = plan(r).trajectory.duration();
  r.duration = 2.0 * shortest;
  EXPECT_EQ(plan(r).trajectory.duration(), r.duration);
  r.duration = 0.99 * shortest;
  EXPECT_EQ(errorOf(r), AnswerCode::kLimitsInfeasible);
  EXPECT_NE(messageOf(r).find("duration"), std::string::npos);
  r.duration = 0.0;
  for (double count : {-1.0, 0.5, 1e6}) {
    r.parameters = {{"grid_points", count}};
    EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal) << count;
  }
  r.parameters = {};
  r.limits = Limits::unlimited(2);
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
  const PlanResult still = plan(request("path_time_optimal", {way[0], way[0]}, limits));
  EXPECT_EQ(still.trajectory.duration(), 0.0);
}

TEST(JointPath, WhatIsNoPathIsRefused) {
  const MatrixX way = MatrixX::Ones(2, 3);
  EXPECT_THROW(linePath({0.0, 1.0, 1.0}, way), InputError);
  EXPECT_THROW(linePath({0.5, 1.0, 2.0}, way), InputError);
  EXPECT_THROW(linePath({0.0, 1.0, std::nan("")}, way), InputError);
  PiecewisePolynomial gap(1, 0, {0.0, 1.0, 2.0}, 0);
  gap.at(1, 0, 0) = 1.0;
  EXPECT_THROW(JointPath{gap}, InputError);
  EXPECT_THROW(retime(linePath({0.0, 1.0, 2.0}, way), limitsOf(2, 1.0, 1.0, 1.0)), InputError);  // Nothing moves.
}

}  // namespace
}  // namespace screwline
