// Values at and beyond the ends of their ranges, in every field and for every profile: refused with the field, the
// value and what is feasible, or planned within the limits.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "property/cartesian_support.h"
#include "property/trajectory_random.h"
#include "screwline/trajectory/format.h"
#include "unit/trajectory_support.h"

namespace screwline {
namespace {

using trajectory_test::jointProfiles;
using trajectory_test::limitsOf;
using trajectory_test::messageOf;
using trajectory_test::Random;
using trajectory_test::request;
using trajectory_test::vector;

constexpr double kInf = std::numeric_limits<double>::infinity();
const double kNan = std::nan("");

bool isVia(const std::string& profile) {
  return profile.rfind("via", 0) == 0;
}

bool takesMany(const std::string& profile) {
  return profile.rfind("multipoint", 0) == 0 || profile.rfind("bspline", 0) == 0 || profile == "time_optimal" ||
         profile == "path_time_optimal";
}

/// Two joints that a profile can move.
PlanRequest ordinary(const std::string& profile) {
  std::vector<VectorX> way{vector({0.0, 0.0}), vector({0.7, 0.6}), vector({1.0, 0.5})};
  if (!isVia(profile) && !takesMany(profile)) way.erase(way.begin() + 1);
  if (profile == "sinusoidal") way.resize(1);
  PlanRequest result = request(profile, way, limitsOf(2, 1.0, 4.0, 40.0));
  result.limits.lower = vector({-10.0, -10.0});
  result.limits.upper = vector({10.0, 10.0});
  if (profile == "sinusoidal") {
    result.duration = 1.0;
    result.parameters = {{"amplitude_1", 0.1}, {"omega_1", 1.0}};
  }
  return result;
}

using Spoil = std::function<void(PlanRequest&)>;

void expectRefused(const PlanRequest& base, const std::string& field, double value, const Spoil& spoil) {
  PlanRequest spoilt = base;
  spoil(spoilt);
  const std::string message = messageOf(spoilt);
  EXPECT_NE(message.find(field), std::string::npos) << base.profile << ", " << field << ": '" << message << "'";
  EXPECT_NE(message.find(number(value)), std::string::npos) << base.profile << ", " << field << ": '" << message << "'";
}

TEST(Ranges, LimitsOutsideTheirRange) {
  const char* const names[] = {"velocity", "acceleration", "jerk"};
  for (const auto& profile : jointProfiles()) {
    for (int order = 0; order < 3; ++order) {
      for (double value : {0.0, -1.0, kNan, -kInf, 5e-324, 1e-300, 9.9e-10, 1.01e12, 1e100, 1.7e308}) {
        PlanRequest r = ordinary(profile.name);
        VectorX* const limits[] = {&r.limits.velocity, &r.limits.acceleration, &r.limits.jerk};
        (*limits[order])[1] = value;
        EXPECT_EQ(messageOf(r), std::string(names[order]) + "_limits[1] is " + number(value) +
                                    ", it must be positive: 1e-09 to 1e+12, or infinite")
            << profile.name;
      }
      PlanRequest scaled = ordinary(profile.name);
      double* const scalings[] = {&scaled.velocity_scaling, &scaled.acceleration_scaling, &scaled.jerk_scaling};
      *scalings[order] = 1e-12;
      EXPECT_NE(messageOf(scaled).find(std::string(names[order]) + "_scaling is 1e-12, it brings " + names[order] +
                                       "_limits[0]"),
                std::string::npos)
          << profile.name << ": " << messageOf(scaled);
    }
  }
}

/// At the ends of the range a motion is planned and proved, or what makes it infeasible is named.
TEST(Ranges, LimitsAtTheEndsOfTheirRange) {
  for (const auto& profile : jointProfiles()) {
    for (int order = 0; order < 3; ++order) {
      for (double value : {1e-9, 1e12}) {
        for (double duration : {0.0, 1.0}) {
          PlanRequest r = ordinary(profile.name);
          if (profile.name != "sinusoidal") r.duration = duration;
          VectorX* const limits[] = {&r.limits.velocity, &r.limits.acceleration, &r.limits.jerk};
          (*limits[order])[1] = value;
          const std::string message = messageOf(r);  // An internal error would come through.
          if (message.empty()) continue;
          const bool named = message.find("its limit is ") != std::string::npos ||
                             message.find("the shortest motion found takes") != std::string::npos ||
                             message.find("the shortest feasible duration is") != std::string::npos;
          EXPECT_TRUE(named) << profile.name << ": " << message;
        }
      }
    }
  }
}

TEST(Ranges, NoFieldTakesWhatIsNoNumber) {
  for (const auto& profile : jointProfiles()) {
    const PlanRequest base = ordinary(profile.name);
    for (double bad : {kNan, kInf, -kInf}) {
      const auto refused = [&](const std::string& field, const Spoil& spoil) {
        expectRefused(base, field, bad, spoil);
      };
      for (std::size_t k = 0; k < base.waypoints.size(); ++k) {
        const std::string waypoint = indexed("waypoints", k);
        refused(waypoint + ".position[1]", [&](PlanRequest& r) { r.waypoints[k].position[1] = bad; });
        refused(waypoint + ".velocity[1]", [&](PlanRequest& r) { r.waypoints[k].velocity = vector({0.0, bad}); });
        refused(waypoint + ".acceleration[1]", [&](PlanRequest& r) {
          r.waypoints[k].acceleration = vector({0.0, bad});
        });
        refused(waypoint + ".time", [&](PlanRequest& r) { r.waypoints[k].time = bad; });
      }
      refused("duration", [&](PlanRequest& r) { r.duration = bad; });
      refused("sample_period", [&](PlanRequest& r) { r.sample_period = bad; });
      refused("velocity_scaling", [&](PlanRequest& r) { r.velocity_scaling = bad; });
      refused("acceleration_scaling", [&](PlanRequest& r) { r.acceleration_scaling = bad; });
      refused("jerk_scaling", [&](PlanRequest& r) { r.jerk_scaling = bad; });
      for (const auto& parameter : profile.parameters) {
        const std::string& stem = parameter.name;
        const std::string name = parameter.per_joint ? stem.substr(0, stem.size() - 1) + "1" : stem;
        refused("parameter '" + name + "'", [&](PlanRequest& r) { r.parameters = {{name, bad}}; });
      }
    }
  }
}

TEST(Ranges, PositionBoundsAreNumbersInOrder) {
  const PlanRequest base = ordinary("time_optimal");
  for (double bad : {kNan, kInf}) {
    expectRefused(base, "lower_position_limits[1]", bad, [&](PlanRequest& r) { r.limits.lower[1] = bad; });
    expectRefused(base, "upper_position_limits[1]", -bad, [&](PlanRequest& r) { r.limits.upper[1] = -bad; });
  }
  expectRefused(base, "lower_position_limits[1] is 11, above upper_position_limits[1], 10", 11.0,
                [](PlanRequest& r) { r.limits.lower[1] = 11.0; });
  PlanRequest open = base;
  open.limits.lower[0] = -kInf;
  open.limits.upper[1] = kInf;
  EXPECT_EQ(messageOf(open), "");
}

TEST(Ranges, CartesianFieldsTakeNumbersOnly) {
  const trajectory_test::Arm arm("puma560");
  const VectorX here = vector({0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
  const Pose pose = forwardKinematics(arm.chain, here);
  Pose other = pose;
  other.p[2] += 0.05;
  for (double bad : {kNan, kInf}) {
    const PlanRequest base = arm.request("cartesian_line", {pose, other}, here);
    expectRefused(base, "waypoints[1].pose.position", bad, [&](PlanRequest& r) { r.waypoints[1].pose.p[1] = bad; });
    PlanRequest turned = base;
    turned.waypoints[0].pose.R(1, 2) = bad;
    EXPECT_NE(messageOf(turned).find("waypoints[0].pose.orientation is no rotation"), std::string::npos);
    expectRefused(base, "present[3]", bad, [&](PlanRequest& r) { r.present[3] = bad; });
    expectRefused(base, "ik_timeout", bad, [&](PlanRequest& r) { r.ik_timeout = bad; });
    for (const char* name : {"tool_speed", "blend_radius", "hold_jerk", "screw"}) {
      expectRefused(base, name, bad, [&](PlanRequest& r) { r.parameters = {{name, bad}}; });
    }
  }
}

/// A duration that an answer gives can be asked for, and every longer one.
TEST(Ranges, TheShortestDurationAndLongerOnesAreFeasible) {
  constexpr unsigned kSeed = 5;
  Random random(kSeed);
  for (int trial = 0; trial < 12; ++trial) {
    for (const auto& profile : jointProfiles()) {
      if (profile.name == "sinusoidal") continue;
      const int joints = 1 + trial % 3;
      const int count = isVia(profile.name) ? 3 : takesMany(profile.name) ? 2 + trial % 4 : 2;
      std::vector<VectorX> way;
      for (int k = 0; k < count; ++k) way.push_back(random.vector(joints, -2.0, 2.0));
      PlanRequest r = request(profile.name, way, limitsOf(joints, 1.0, 4.0, 40.0));
      const double shortest = plan(r).trajectory.duration();
      for (double factor : {1.0, 1.0 + 1e-12, 1.0 + 1e-9, 1.0001, 1.5, 10.0}) {
        r.duration = factor * shortest;
        EXPECT_EQ(messageOf(r), "") << profile.name << ", seed " << kSeed << ", trial " << trial << ", x " << factor;
      }
    }
  }
}

/// Joints whose limits differ by ten orders of magnitude: the fast one's ramps are lost in the slow one's time unless
/// they are made longer.
TEST(Ranges, FastJointsBesideSlowOnes) {
  constexpr unsigned kSeed = 6;
  Random random(kSeed);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<VectorX> way;
    for (int k = 0; k < 2 + trial % 3; ++k) way.push_back(random.vector(3, -3.0, 3.0));
    PlanRequest r = request("time_optimal", way, limitsOf(3, 1.0, 4.0, 40.0));
    r.sample_period = 1e6;
    for (VectorX* limits : {&r.limits.velocity, &r.limits.acceleration, &r.limits.jerk}) {
      *limits = VectorX::NullaryExpr(limits->size(), [&] { return std::pow(10.0, random.uniform(-5.0, 5.0)); });
    }
    EXPECT_EQ(messageOf(r), "") << "seed " << kSeed << ", trial " << trial;
  }
}

/// Where a joint turns back on its spline, intervals of the grid are so short that their instants' rounding shows.
TEST(Ranges, SplinesThatTurnBackKeepTheirLimits) {
  const double ways[][5] = {
      {1.7302112816359929, -0.83074017568791225, -1.4426013799489508, -1.4764410858206123, -1.5568826049789954},
      {-0.1343471191898622, -1.4604309479542472, -0.73145057551518478, -0.45862226241333537, 1.133007415106305}};
  const double limits[][2] = {{2.2446743302973835, 4.0934729003165264}, {2.1927379422365512, 7.455581983770589}};
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<VectorX> way;
    for (double q : ways[i]) way.push_back(vector({q}));
    EXPECT_EQ(messageOf(request("path_time_optimal", way, limitsOf(1, limits[i][0], limits[i][1], 50.0))), "");
  }
}

}  // namespace
}  // namespace screwline
