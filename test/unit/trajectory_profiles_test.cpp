// Every profile of plan(): what it promises, golden studies, durations and refusals.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <string>

#include "screwline/exception.h"
#include "screwline/trajectory/metrics.h"
#include "screwline/trajectory/plan.h"
#include "screwline/trajectory/verify.h"
#include "unit/trajectory_support.h"

namespace screwline {
namespace {

using trajectory_test::errorOf;
using trajectory_test::limitsOf;
using trajectory_test::messageOf;
using trajectory_test::request;
using trajectory_test::vector;

constexpr double kDegree = kPi / 180.0;

const char* const kSingleMoves[] = {"rectangular",     "cubic",     "trapezoidal", "polynomial_345",
                                    "polynomial_4567", "cycloidal", "minimum_jerk"};
const char* const kMultipoint[] = {"multipoint_trapezoidal", "multipoint_cubic", "multipoint_quintic", "bspline",
                                   "bspline_interpolating"};

TEST(SingleMove, SeedZeroNinetyDegreesInOneSecond) {
  const YAML::Node golden =
      YAML::LoadFile(std::string(SCREWLINE_TEST_DATA) + "/profiles.yaml")["seed000_ninety_degrees_in_one_second"];
  const std::pair<const char*, const char*> names[] = {{"cubic", "cubic"},         {"trapezoidal", "trapezoid_thirds"},
                                                       {"polynomial_345", "345"},  {"polynomial_4567", "4567"},
                                                       {"cycloidal", "cycloidal"}, {"rectangular", "rectangular"}};
  for (const auto& [profile, key] : names) {
    PlanRequest r = request(profile, {vector({0.0}), vector({kPi / 2.0})}, Limits::unlimited(1));
    r.duration = 1.0;
    const PlanResult result = plan(r);
    const JointMetrics m = jointMetrics(result.trajectory, r.limits, vector({kPi / 2.0}));
    EXPECT_NEAR(m.peak_velocity[0], golden[key]["peak_velocity_rad_s"].as<double>(), 1e-12) << profile;
    if (golden[key]["peak_acceleration_rad_s2"]) {
      EXPECT_NEAR(m.peak_acceleration[0], golden[key]["peak_acceleration_rad_s2"].as<double>(), 1e-12) << profile;
    }
    if (golden[key]["peak_abs_jerk_rad_s3"] && std::string(profile) != "cubic") {
      EXPECT_NEAR(m.peak_jerk[0], golden[key]["peak_abs_jerk_rad_s3"].as<double>(), 1e-11) << profile;
    }
  }
}

TEST(SingleMove, ShortestDurationIsTheOneOfThePeakCoefficients) {
  const double v = 1.3, a = 2.1, j = 17.0, d = 1.7;
  const auto shortest = [&](const char* profile) {
    return plan(request(profile, {vector({0.2}), vector({0.2 - d})}, limitsOf(1, v, a, j))).trajectory.duration();
  };
  const auto expected = [&](double cv, double ca, double cj) {
    return std::max({cv * d / v, std::sqrt(ca * d / a), std::cbrt(cj * d / j)});
  };
  EXPECT_NEAR(shortest("rectangular"), d / v, 1e-12);
  EXPECT_NEAR(shortest("cubic"), expected(1.5, 6.0, 0.0), 1e-12);
  EXPECT_NEAR(shortest("polynomial_345"), expected(1.875, 10.0 / std::sqrt(3.0), 60.0), 1e-12);
  EXPECT_NEAR(shortest("polynomial_4567"), expected(35.0 / 16.0, 84.0 * std::sqrt(5.0) / 25.0, 52.5), 1e-12);
  EXPECT_NEAR(shortest("cycloidal"), expected(2.0, kTwoPi, kTwoPi * kTwoPi), 1e-12);
  EXPECT_NEAR(shortest("trapezoidal"), v * v < a * d ? d / v + v / a : 2.0 * std::sqrt(d / a), 1e-12);
}

TEST(SingleMove, SlowestJointDecidesAndOneOfItsLimitsIsMetExactly) {
  for (const char* profile : kSingleMoves) {
    const Limits limits = limitsOf(3, 1.0, 3.0, 20.0);
    const PlanResult result = plan(request(profile, {vector({0.0, 1.0, 2.0}), vector({1.0, -2.0, 2.0})}, limits));
    EXPECT_NEAR(tightestUse(result.trajectory, limits).stretch, 1.0, 1e-12) << profile;
    EXPECT_EQ(tightestUse(result.trajectory, limits).joint, 1) << profile;
  }
}

TEST(SingleMove, TooShortADurationIsRefusedWithTheShortestOne) {
  for (const char* profile : kSingleMoves) {
    PlanRequest r = request(profile, {vector({0.0, 0.0}), vector({1.0, 2.0})}, limitsOf(2, 1.0, 2.0, 10.0));
    const double shortest = plan(r).trajectory.duration();
    r.duration = 0.5 * shortest;
    EXPECT_EQ(errorOf(r), AnswerCode::kLimitsInfeasible) << profile;
    EXPECT_NE(messageOf(r).find("joint 1"), std::string::npos) << messageOf(r);
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", shortest);
    EXPECT_NE(messageOf(r).find(text), std::string::npos) << messageOf(r) << " should name " << text;
    r.duration = shortest;
    EXPECT_EQ(plan(r).trajectory.duration(), shortest) << profile;
    r.duration = 1.7 * shortest;
    EXPECT_EQ(plan(r).trajectory.duration(), 1.7 * shortest) << profile;
  }
}

TEST(SingleMove, MoreWaypointsThanTwoAreRefusedClearly) {
  const auto limits = limitsOf(1, 1.0, 1.0, 1.0);
  for (const char* profile : kSingleMoves) {
    const PlanRequest r = request(profile, {vector({0.0}), vector({1.0}), vector({2.0})}, limits);
    EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
    EXPECT_EQ(messageOf(r), "waypoints has 3 entries, profile '" + std::string(profile) + "' takes exactly 2");
  }
}

TEST(SingleMove, NoMoveTakesNoTimeAndIsFinite) {
  for (const char* profile : kSingleMoves) {
    PlanRequest r = request(profile, {vector({0.3, 1.0}), vector({0.3, 1.0})}, limitsOf(2, 1.0, 2.0, 10.0));
    EXPECT_EQ(plan(r).trajectory.duration(), 0.0) << profile;
    TrajectoryPoint point(2);
    plan(r).trajectory.sample(0.0, point);
    EXPECT_EQ(point.position, r.waypoints[0].position) << profile;
    EXPECT_TRUE(point.velocity.isZero(0.0) && point.acceleration.isZero(0.0) && point.jerk.isZero(0.0)) << profile;
    r.duration = 2.0;
    EXPECT_EQ(plan(r).trajectory.duration(), 2.0) << profile;
  }
}

TEST(Trapezoidal, ParametersDefineIt) {
  PlanRequest r = request("trapezoidal", {vector({0.0, 0.0}), vector({2.0, -1.0})}, Limits::unlimited(2));
  r.parameters = {{"peak_velocity", 0.8}, {"acceleration", 1.6}};
  const PlanResult result = plan(r);
  EXPECT_NEAR(result.trajectory.duration(), 3.0, 1e-12);
  EXPECT_NEAR(result.trajectory.extrema(0).velocity, 0.8, 1e-12);
  EXPECT_NEAR(result.trajectory.extrema(1).velocity, 0.4, 1e-12);
  EXPECT_NEAR(result.trajectory.extrema(0).acceleration, 1.6, 1e-12);
  r.parameters = {{"peak_velocity", 0.8}, {"acceleration", 1.6}};
  r.duration = 3.0;
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);  // Three of the four.
  r.parameters = {{"peak_velocity", 0.5}};
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);  // 2 rad in 3 s need more than 2/3.
}

TEST(Trapezoidal, GivenDurationTakesThirdsWhereTheLimitsAllow) {
  PlanRequest r = request("trapezoidal", {vector({0.0}), vector({1.0})}, limitsOf(1, 1.0, 2.0, 10.0));
  r.duration = 3.0;
  EXPECT_NEAR(plan(r).trajectory.scaling()->breaks().front(), 1.0 / 3.0, 1e-12);
  r.duration = plan(request("trapezoidal", {vector({0.0}), vector({1.0})}, r.limits)).trajectory.duration() * 1.001;
  EXPECT_NO_THROW(plan(r));
}

TEST(ViaScalar, StudyOfSeed004) {
  const YAML::Node study = YAML::LoadFile(std::string(SCREWLINE_TEST_DATA) + "/via_pose_study.yaml");
  const char* const keys[] = {"joints_plus_deg", "joints_minus_deg"};
  for (std::size_t branch = 0; branch < 2; ++branch) {
    PlanRequest r = request("via_scalar", {}, Limits::unlimited(3));
    r.duration = 2.0;
    for (const char* name : {"A", "B", "C"}) {
      const auto degrees = study["points"][name][keys[branch]].as<std::vector<double>>();
      r.waypoints.push_back({vector({degrees[0], degrees[1], degrees[2]}) * kDegree, {}, {}, 0.0});
    }
    const PlanResult result = plan(r);
    const YAML::Node expected = study["branches"][branch]["scalar_method"];
    ASSERT_EQ(result.via_joint_errors.rows(), 1);
    for (int j = 0; j < 3; ++j) {
      const double error = expected["joint_error_deg"][static_cast<std::size_t>(j)].as<double>();
      EXPECT_NEAR(result.via_joint_errors(0, j) / kDegree, error, 1e-9);
    }
    EXPECT_EQ(result.waypoint_times[1], 1.0);
    std::string notes;
    for (const auto& note : result.notes) notes += note + "\n";
    EXPECT_NE(notes.find("the via is missed"), std::string::npos) << notes;
    EXPECT_NE(notes.find("S = "), std::string::npos) << notes;
    EXPECT_NE(notes.find("reverses"), std::string::npos) << notes;
  }
}

TEST(ViaScalar, PrintedAnglesMissByTheStudiedError) {
  const YAML::Node printed =
      YAML::LoadFile(std::string(SCREWLINE_TEST_DATA) + "/via_pose_study.yaml")["with_printed_angles"];
  const double S = printed["S"].as<double>();
  const VectorX via = vector({90.0, -150.0, 90.0});
  VectorX start(3), goal(3);
  for (int j = 0; j < 3; ++j) {  // The start and goal that the study's S and position at the via belong to.
    const std::size_t i = static_cast<std::size_t>(j);
    const double own = printed["S_required_per_joint"][i].as<double>();
    const double reached = printed["joints_at_half_deg"][i].as<double>();
    const double travel = j == 0 ? 173.37 - 83.14 : (via[j] - reached) / (own - S);
    start[j] = via[j] - own * travel;
    goal[j] = start[j] + travel;
  }
  EXPECT_NEAR(start[0], 83.14, 1e-9);
  PlanRequest r = request("via_scalar", {start, via, goal}, Limits::unlimited(3));
  r.duration = 2.0;
  const PlanResult result = plan(r);
  for (int j = 0; j < 3; ++j) {
    EXPECT_NEAR(result.via_joint_errors(0, j), printed["joint_error_deg"][static_cast<std::size_t>(j)].as<double>(),
                1e-9);
  }
  EXPECT_NEAR(result.trajectory.scaling()->at(0.5).s, 0.0760279, 5e-8);
}

TEST(ViaScalar, FirstJointThatDoesNotMoveHasNoS) {
  const PlanRequest r =
      request("via_scalar", {vector({1.0, 0.0}), vector({2.0, 1.0}), vector({1.0, 2.0})}, limitsOf(2, 1, 1, 1));
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
  EXPECT_NE(messageOf(r).find("no S exists"), std::string::npos);
  EXPECT_NO_THROW(
      plan(request("via_per_joint", {vector({1.0, 0.0}), vector({2.0, 1.0}), vector({1.0, 2.0})}, r.limits)));
}

TEST(ViaPerJoint, StudyOfSeed004) {
  const YAML::Node study = YAML::LoadFile(std::string(SCREWLINE_TEST_DATA) + "/via_pose_study.yaml");
  const char* const keys[] = {"joints_plus_deg", "joints_minus_deg"};
  for (std::size_t branch = 0; branch < 2; ++branch) {
    PlanRequest r = request("via_per_joint", {}, Limits::unlimited(3));
    r.duration = 2.0;
    for (const char* name : {"A", "B", "C"}) {
      const auto degrees = study["points"][name][keys[branch]].as<std::vector<double>>();
      r.waypoints.push_back({vector({degrees[0], degrees[1], degrees[2]}) * kDegree, {}, {}, 0.0});
    }
    const JointTrajectory trajectory = plan(r).trajectory;
    for (std::size_t j = 0; j < 3; ++j) {
      const YAML::Node expected = study["branches"][branch]["per_joint_correct"][j];
      const Polynomial piece = trajectory.pieces()->piece(0, static_cast<int>(j));
      for (std::size_t k = 0; k < 7; ++k) {
        EXPECT_NEAR(piece.c[k] / kDegree, expected["coefficients_ascending_deg"][k].as<double>(), 1e-9);
      }
      const JointExtrema e = trajectory.extrema(static_cast<int>(j));
      EXPECT_NEAR(e.velocity / kDegree, expected["peak_speed_deg_s"].as<double>(), 1e-9);
      EXPECT_NEAR(e.position.lower / kDegree, expected["range_deg"][0].as<double>(), 1e-9);
      EXPECT_NEAR(e.position.upper / kDegree, expected["range_deg"][1].as<double>(), 1e-9);
    }
    TrajectoryPoint point(3);
    for (const auto& row : study["branches"][branch]["samples"]["rows"]) {
      trajectory.sample(row[0].as<double>(), point);
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(point.position[j] / kDegree, row[static_cast<std::size_t>(j + 1)].as<double>(), 1e-9);
    }
  }
}

TEST(ViaPerJoint, AnyInstantByTimeOrFraction) {
  const std::vector<VectorX> way{vector({0.0, 1.0}), vector({0.4, 3.0}), vector({1.0, 1.0})};
  PlanRequest r = request("via_per_joint", way, limitsOf(2, 2.0, 8.0, 200.0));
  r.parameters = {{"via_tau", 0.3}};
  const PlanResult fraction = plan(r);
  EXPECT_LT(fraction.via_joint_errors.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(fraction.waypoint_times[1], 0.3 * fraction.trajectory.duration(), 1e-12);
  r.parameters.clear();
  r.waypoints[1].time = 4.2;
  r.duration = 14.0;
  EXPECT_LT(plan(r).via_joint_errors.cwiseAbs().maxCoeff(), 1e-12);
  r.parameters = {{"via_tau", 0.3}};
  EXPECT_EQ(errorOf(r), AnswerCode::kInvalidGoal);
}

TEST(ViaPerJoint, ViaTimeWithFreeDurationIsSearched) {
  PlanRequest r = request("via_per_joint", {vector({0.0}), vector({0.5}), vector({1.0})}, limitsOf(1, 1.0, 4.0, 60.0));
  r.waypoints[1].time = 1.5;
  const PlanResult result = plan(r);
  EXPECT_EQ(result.waypoint_times[1], 1.5);
  EXPECT_LE(tightestUse(result.trajectory, r.limits).stretch, 1.0 + 1e-9);
  EXPECT_GT(result.trajectory.duration(), 1.5);
}

TEST(Registry, ListsEveryProfileWithItsParameters) {
  std::string all;
  for (const auto& info : listProfiles()) {
    all += info.name + " ";
    EXPECT_FALSE(info.meaning.empty());
    for (const auto& parameter : info.parameters) EXPECT_FALSE(parameter.meaning.empty()) << parameter.name;
  }
  for (const char* name : kSingleMoves) EXPECT_NE(all.find(name), std::string::npos);
  for (const char* name : kMultipoint) EXPECT_NE(all.find(name), std::string::npos);
  for (const char* name : {"via_scalar", "via_per_joint", "sinusoidal"}) EXPECT_NE(all.find(name), std::string::npos);
}

TEST(Notes, InfiniteOrdersAreSaid) {
  const std::vector<VectorX> way{vector({0.0}), vector({1.0})};
  const auto notes = [&](const char* profile) {
    std::string all;
    for (const auto& note : plan(request(profile, way, limitsOf(1, 1, 1, 1))).notes) all += note;
    return all;
  };
  EXPECT_NE(notes("rectangular").find("steps in velocity"), std::string::npos);
  EXPECT_NE(notes("cubic").find("steps in acceleration"), std::string::npos);
  EXPECT_NE(notes("trapezoidal").find("steps in acceleration"), std::string::npos);
  EXPECT_NE(notes("multipoint_cubic").find("steps in acceleration"), std::string::npos);
  for (const char* profile : {"polynomial_345", "polynomial_4567", "cycloidal", "minimum_jerk"})
    EXPECT_EQ(notes(profile), "");
}

}  // namespace
}  // namespace screwline
