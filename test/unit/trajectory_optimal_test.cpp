// Reference durations of time-optimal motions, and cases made to hurt.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>

#include "property/trajectory_optimal_random.h"
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

}  // namespace
}  // namespace screwline
