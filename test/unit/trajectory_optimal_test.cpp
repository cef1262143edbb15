// Reference durations of time-optimal motions, and cases made to hurt.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>

#include "property/trajectory_optimal_random.h"
#include "unit/quintic_bridge.h"
#include "unit/trajectory_support.h"

namespace screwline {
namespace {

using trajectory_test::brokenLaw;
using trajectory_test::limitsOf;
using trajectory_test::messageOf;
using trajectory_test::request;
using trajectory_test::vector;

using Row = std::map<std::string, double>;

std::vector<Row> rowsOf(const std::string& name) {
  std::ifstream in(std::string(SCREWLINE_TEST_DATA) + "/" + name);
  std::vector<std::string> names;
  std::vector<Row> rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    std::vector<std::string> values;
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(cell);
    if (names.empty()) {
      names = values;
      continue;
    }
    rows.emplace_back();
    for (std::size_t i = 0; i < values.size(); ++i) rows.back()[names[i]] = std::atof(values[i].c_str());
  }
  return rows;
}

double cell(const Row& row, const std::string& name, int joint) {
  const auto at = row.find(name + "_" + std::to_string(joint));
  return at != row.end() ? at->second : 0.0;
}

constexpr int kJoints = 6;

void ask(const Row& row, StateToState& question) {
  question.joints = kJoints;
  for (int joint = 0; joint < kJoints; ++joint) {
    const std::size_t j = static_cast<std::size_t>(joint);
    question.from[j] = {cell(row, "q0", joint), cell(row, "v0", joint), cell(row, "a0", joint)};
    question.to[j] = {cell(row, "q1", joint), cell(row, "v1", joint), cell(row, "a1", joint)};
    question.limits[j] =
        AxisLimits::symmetric(cell(row, "vmax", joint), cell(row, "amax", joint), cell(row, "jmax", joint));
  }
}

void expectReference(const std::string& file, const std::string& duration, const std::string& least) {
  const auto question = std::make_unique<StateToState>();
  const auto motion = std::make_unique<StateToStateMotion>();
  const std::vector<Row> rows = rowsOf(file);
  ASSERT_EQ(rows.size(), 500u);
  for (const Row& row : rows) {
    const std::string id = file + ", id " + std::to_string(static_cast<int>(row.at("id")));
    ask(row, *question);
    moveStateToState(*question, *motion);
    ASSERT_EQ(motion->status, MotionStatus::kFound) << id;
    EXPECT_NEAR(motion->duration, row.at(duration), 1e-7 * row.at(duration)) << id;
    for (int joint = 0; joint < kJoints; ++joint) {
      const double reference = cell(row, least, joint);
      EXPECT_NEAR(motion->shortest[static_cast<std::size_t>(joint)], reference, 1e-7 * reference) << id;
    }
    EXPECT_EQ(brokenLaw(*question, *motion), "") << id;
  }
}

TEST(TimeOptimalReference, RestToRestDurations) {
  expectReference("rest_to_rest_durations.csv", "duration_jerk_limited", "tmin_jerk");
}

TEST(TimeOptimalReference, StateToStateDurations) {
  expectReference("state_to_state_durations.csv", "duration", "tmin");
}

TEST(DoubleS, IsTheCommonScalingOfTheReferenceMoves) {
  double ratio = 0.0;
  int count = 0;
  for (const Row& row : rowsOf("rest_to_rest_durations.csv")) {
    VectorX from(kJoints), to(kJoints);
    Limits limits = Limits::unlimited(kJoints);
    for (int j = 0; j < kJoints; ++j) {
      from[j] = cell(row, "q0", j);
      to[j] = cell(row, "q1", j);
      limits.velocity[j] = cell(row, "vmax", j);
      limits.acceleration[j] = cell(row, "amax", j);
      limits.jerk[j] = cell(row, "jmax", j);
    }
    if (from == to) continue;
    const JointTrajectory motion = plan(request("double_s", {from, to}, limits)).trajectory;
    ASSERT_NE(motion.scaling(), nullptr);
    EXPECT_GE(motion.duration(), row.at("duration_jerk_limited") * (1.0 - 1e-9));
    ratio += motion.duration() / row.at("duration_jerk_limited");
    ++count;
  }
  EXPECT_LT(ratio / count, 1.05);
  RecordProperty("mean_ratio", std::to_string(ratio / count));
}

TEST(TimeOptimalPlan, GivenDurationIsTakenExactlyOrRefused) {
  PlanRequest r = request("time_optimal", {vector({0.0, 1.0}), vector({1.0, -1.0})}, limitsOf(2, 1.0, 4.0, 40.0));
  const double shortest = plan(r).trajectory.duration();
  r.duration = 2.0 * shortest;
  EXPECT_EQ(plan(r).trajectory.duration(), 2.0 * shortest);
  r.duration = 0.5 * shortest;
  EXPECT_NE(messageOf(r).find("the shortest feasible duration is"), std::string::npos);
}

TEST(TimeOptimalPlan, MovingEndsAreMet) {
  PlanRequest r = request("time_optimal", {vector({0.0}), vector({1.0})}, limitsOf(1, 1.0, 4.0, 40.0));
  r.waypoints[0].velocity = vector({-0.5});
  r.waypoints[0].acceleration = vector({1.0});
  r.waypoints[1].velocity = vector({0.7});
  const JointTrajectory motion = plan(r).trajectory;
  TrajectoryPoint point(1);
  motion.sample(0.0, point);
  EXPECT_NEAR(point.velocity[0], -0.5, 1e-12);
  EXPECT_NEAR(point.acceleration[0], 1.0, 1e-12);
  motion.sample(motion.duration(), point);
  EXPECT_NEAR(point.velocity[0], 0.7, 1e-9);
  EXPECT_NEAR(point.acceleration[0], 0.0, 1e-9);
}

TEST(TimeOptimalPlan, AStartThatPushesThroughALimitIsRefused) {
  PlanRequest r = request("time_optimal", {vector({0.0}), vector({1.0})}, limitsOf(1, 1.0, 4.0, 40.0));
  r.waypoints[0].velocity = vector({1.0});
  r.waypoints[0].acceleration = vector({2.0});
  EXPECT_NE(messageOf(r).find("waypoints[0]: joint 0 has velocity 1 with its acceleration, feasible is -1 to 0.95"),
            std::string::npos)
      << messageOf(r);
}

TEST(TimeOptimalWaypoints, AreMetWithinLimitsAndNeverSlowerThanWithStops) {
  trajectory_test::Questions random(93);
  double ratio = 0.0;
  constexpr int kTrials = 30;
  for (int trial = 0; trial < kTrials; ++trial) {
    const int n = random.integer(1, 6);
    const Limits limits = limitsOf(n, random.uniform(0.5, 3.0), random.uniform(1.0, 9.0), random.uniform(10.0, 90.0));
    std::vector<VectorX> way;
    for (int k = random.integer(3, 8); k > 0; --k) {
      way.push_back(VectorX::NullaryExpr(n, [&](Eigen::Index) { return random.uniform(-2.0, 2.0); }));
    }
    double stops = 0.0;
    for (std::size_t k = 1; k < way.size(); ++k) {
      stops += plan(request("time_optimal", {way[k - 1], way[k]}, limits)).trajectory.duration();
    }
    PlanRequest r = request("time_optimal", way, limits);
    const PlanResult through = plan(r);
    EXPECT_LE(through.trajectory.duration(), stops * (1.0 + 1e-9)) << "seed 93, trial " << trial;
    EXPECT_LT(through.via_joint_errors.cwiseAbs().maxCoeff(), 1e-9) << "seed 93, trial " << trial;
    EXPECT_EQ(through.trajectory.continuity(), 2);
    r.duration = 2.0 * through.trajectory.duration();
    EXPECT_EQ(plan(r).trajectory.duration(), r.duration);
    ratio += through.trajectory.duration() / stops / kTrials;
  }
  EXPECT_LT(ratio, 0.95);
  RecordProperty("ratio_to_stops", std::to_string(ratio));
}

TEST(TimeOptimalWaypoints, ARepeatedOneIsAStop) {
  PlanRequest r = request("time_optimal", {vector({0.0}), vector({1.0}), vector({1.0}), vector({2.0})},
                          limitsOf(1, 1.0, 4.0, 40.0));
  const double one = plan(request("time_optimal", {vector({0.0}), vector({1.0})}, r.limits)).trajectory.duration();
  EXPECT_NEAR(plan(r).trajectory.duration(), 2.0 * one, 1e-9);
}

TEST(TimeOptimalBraking, AStartOutsideTheLimitsComesBackAtFullJerkAndStaysInside) {
  trajectory_test::Questions random(91);
  const auto question = std::make_unique<StateToState>();
  const auto motion = std::make_unique<StateToStateMotion>();
  for (int trial = 0; trial < 3000; ++trial) {
    random.fill(*question, 1);
    const AxisLimits& limits = question->limits[0];
    question->from[0].velocity = 3.0 * random.uniform(limits.velocity.lower, limits.velocity.upper);
    question->from[0].acceleration = 2.0 * random.uniform(limits.acceleration.lower, limits.acceleration.upper);
    moveStateToState(*question, *motion);
    ASSERT_EQ(motion->status, MotionStatus::kFound) << "seed 91, trial " << trial;
    JerkPhases rest = motion->phases[0];
    const EndState end = rest.end();
    EXPECT_NEAR(end.position, question->to[0].position, 1e-8 * (1.0 + rest.extent().position.peak()));
    const std::size_t braking = motion->braking_phases[0];
    JerkPhases brake = rest;
    brake.count = braking;
    const EndState back = brake.end();
    AxisLimits wider = limits;  // By rounding.
    for (Range* range : {&wider.velocity, &wider.acceleration})
      *range = {range->lower * 1.00000001, range->upper * 1.00000001};
    EXPECT_EQ(checkState(back, wider, true).fault, StateFault::kNone) << "seed 91, trial " << trial;
    rest.start = back;
    for (std::size_t k = braking; k < rest.count; ++k) rest.phases[k - braking] = rest.phases[k];
    rest.count -= braking;
    const AxisLimits extent = rest.extent();
    EXPECT_LE(extent.velocity.upper, limits.velocity.upper * (1.0 + 1e-9)) << "seed 91, trial " << trial;
    EXPECT_GE(extent.velocity.lower, limits.velocity.lower * (1.0 + 1e-9)) << "seed 91, trial " << trial;
    EXPECT_LE(extent.acceleration.upper, limits.acceleration.upper * (1.0 + 1e-9)) << "seed 91, trial " << trial;
    EXPECT_GE(extent.acceleration.lower, limits.acceleration.lower * (1.0 + 1e-9)) << "seed 91, trial " << trial;
  }
}

TEST(TimeOptimalBridge, IsNeverLongerThanTheQuintic) {
  trajectory_test::Questions random(92);
  for (int trial = 0; trial < 300; ++trial) {
    const Limits limits = limitsOf(1, random.uniform(0.5, 3.0), random.uniform(1.0, 9.0), random.uniform(10.0, 90.0));
    const AxisLimits axis = axisLimits(limits, 0);
    const EndState a = random.state(axis, true);
    const EndState b = random.state(axis, false);
    const MotionState from{vector({a.position}), vector({a.velocity}), vector({a.acceleration})};
    const MotionState to{vector({b.position}), vector({b.velocity}), vector({b.acceleration})};
    const double quintic = trajectory_test::quinticBridge(from, to, limits).duration();
    const JointTrajectory best = timeOptimalBridge(from, to, limits);
    EXPECT_LE(best.duration(), quintic * (1.0 + 1e-6)) << "seed 92, trial " << trial;
    EXPECT_LE(tightestUse(best, limits).stretch, 1.0 + 1e-8) << "seed 92, trial " << trial;
  }
}

TEST(TimeOptimalRefusals, NameTheJointTheValueAndTheFeasibleRange) {
  const auto question = std::make_unique<StateToState>();
  const auto motion = std::make_unique<StateToStateMotion>();
  const auto refusal = [&] {
    moveStateToState(*question, *motion);
    return describe(*motion);
  };
  EXPECT_EQ(refusal(), "the number of joints is 0, feasible is 1 to 64");
  question->joints = 2;
  question->limits[0] = question->limits[1] = AxisLimits::symmetric(1.0, 2.0, 10.0);
  question->to[1] = {1.0, 1.2, 0.0};
  EXPECT_EQ(refusal(), "joint 1: goal velocity is 1.2, feasible is -1 to 1");
  question->to[1] = {1.0, -0.9, 2.0};
  EXPECT_EQ(refusal(), "joint 1: goal velocity is -0.9, feasible is -0.8 to 1");
  question->to[1] = {1.0, 0.0, 0.0};
  question->from[0] = {0.0, 1.0, 0.0};
  question->limits[0].position = {-1.0, 0.1};
  EXPECT_EQ(refusal().rfind("joint 0: on the way position is 0.3466666667, feasible is -1 to 0.1", 0), 0u) << refusal();
  question->from[0] = {std::nan(""), 0.0, 0.0};
  EXPECT_NE(refusal().find("joint 0: start value is nan"), std::string::npos);
}

}  // namespace
}  // namespace screwline
