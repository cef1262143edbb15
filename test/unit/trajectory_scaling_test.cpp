// Polynomials, time scalings and the trapezoid against laws and the golden values of profiles.yaml.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <map>
#include <random>
#include <string>

#include "screwline/exception.h"
#include "screwline/spatial/pose.h"
#include "screwline/trajectory/time_law.h"
#include "screwline/trajectory/trapezoid.h"

namespace screwline {
namespace {

const YAML::Node& profiles() {
  static const YAML::Node file = YAML::LoadFile(std::string(SCREWLINE_TEST_DATA) + "/profiles.yaml");
  return file;
}

YAML::Node golden(const std::string& name) {
  for (const auto& profile : profiles()["profiles"]) {
    if (profile["name"].as<std::string>() == name) return profile;
  }
  throw std::runtime_error("no profile " + name);
}

std::map<std::string, TimeLaw> scalings() {
  return {{"rectangular", TimeLaw::rectangular()},
          {"cubic", TimeLaw::cubic()},
          {"trapezoid_thirds", TimeLaw::trapezoidal(1.0 / 3.0)},
          {"trapezoid_tenth", TimeLaw::trapezoidal(0.1)},
          {"triangle", TimeLaw::trapezoidal(0.5)},
          {"345", TimeLaw::polynomial345()},
          {"4567", TimeLaw::polynomial4567()},
          {"cycloidal", TimeLaw::cycloidal()},
          {"minimum_jerk", TimeLaw::minimumJerk()}};
}

void expectSamples(const TimeLaw& scaling, const YAML::Node& rows, double tolerance) {
  ASSERT_GE(rows.size(), 13u);
  for (const auto& row : rows) {
    const ScalingSample s = scaling.at(row[0].as<double>());
    EXPECT_NEAR(s.s, row[1].as<double>(), tolerance) << "tau " << row[0];
    EXPECT_NEAR(s.ds, row[2].as<double>(), tolerance) << "tau " << row[0];
    EXPECT_NEAR(s.dds, row[3].as<double>(), tolerance) << "tau " << row[0];
    EXPECT_NEAR(s.ddds, row[4].as<double>(), tolerance) << "tau " << row[0];
  }
}

TEST(Polynomial, RootsOfAProductAreItsFactors) {
  std::mt19937 random(41);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 300; ++trial) {
    Polynomial p{{1.0}};
    std::vector<double> expected;
    for (int i = 0; i < 5; ++i) {
      const double root = 0.1 + 0.2 * i * 0.9 + 0.05 * unit(random);
      expected.push_back(root);
      Polynomial next;
      for (std::size_t k = 0; k < 7; ++k) {
        next.c[k] -= root * p.c[k];
        next.c[k + 1] += p.c[k];
      }
      p = next;
    }
    const Roots roots = rootsInUnitInterval(p);
    ASSERT_EQ(roots.count, 5) << "seed 41, trial " << trial;
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(roots.at[i], expected[i], 1e-10);
  }
}

TEST(Polynomial, TouchingRootIsFoundAndZeroPolynomialHasNone) {
  EXPECT_EQ(rootsInUnitInterval({{0.25, -1.0, 1.0}}).count, 1);
  EXPECT_NEAR(rootsInUnitInterval({{0.25, -1.0, 1.0}}).at[0], 0.5, 1e-9);
  EXPECT_EQ(rootsInUnitInterval({}).count, 0);
  EXPECT_EQ(rootsInUnitInterval({{3.0}}).count, 0);
}

TEST(Polynomial, RangeAndVariationContainDenseSamples) {
  std::mt19937 random(42);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 300; ++trial) {
    Polynomial p;
    for (double& c : p.c) c = normal(random);
    const Range range = rangeOverUnitInterval(p);
    double lower = p(0.0), upper = p(0.0), variation = 0.0, square = 0.0;
    constexpr int kSteps = 4000;
    for (int i = 1; i <= kSteps; ++i) {
      const double value = p(static_cast<double>(i) / kSteps);
      variation += std::abs(value - p(static_cast<double>(i - 1) / kSteps));
      square += std::pow(p((i - 0.5) / kSteps), 2) / kSteps;
      lower = std::min(lower, value);
      upper = std::max(upper, value);
    }
    EXPECT_LE(range.lower, lower + 1e-12);
    EXPECT_GE(range.upper, upper - 1e-12);
    EXPECT_NEAR(range.lower, lower, 1e-5);
    EXPECT_NEAR(range.upper, upper, 1e-5);
    EXPECT_NEAR(totalVariation(p), variation, 1e-5);
    EXPECT_NEAR(integralOfSquare(p), square, 1e-5 * (1.0 + square));
  }
}

TEST(TimeLaw, BoundaryValuesAndMonotone) {
  for (const auto& [name, s] : scalings()) {
    EXPECT_NEAR(s.at(0.0).s, 0.0, 1e-15) << name;
    EXPECT_NEAR(s.at(1.0).s, 1.0, 1e-14) << name;
    EXPECT_TRUE(s.isMonotone()) << name;
    if (s.continuity() >= 1) {
      EXPECT_NEAR(s.at(0.0).ds, 0.0, 1e-14) << name;
      EXPECT_NEAR(s.at(1.0).ds, 0.0, 1e-13) << name;
    }
    if (s.continuity() >= 2) {
      EXPECT_NEAR(s.at(0.0).dds, 0.0, 1e-14) << name;
      EXPECT_NEAR(s.at(1.0).dds, 0.0, 1e-12) << name;
    }
    if (s.continuity() >= 3) {
      EXPECT_NEAR(s.at(0.0).ddds, 0.0, 1e-13) << name;
      EXPECT_NEAR(s.at(1.0).ddds, 0.0, 1e-11) << name;
    }
  }
}

TEST(TimeLaw, DerivativesEqualFiniteDifferences) {
  constexpr double kStep = 1e-5;
  for (const auto& [name, s] : scalings()) {
    for (int i = 1; i < 100; ++i) {
      const double tau = 0.0037 + 0.99 * i / 100.0;
      const ScalingSample before = s.at(tau - kStep), at = s.at(tau), after = s.at(tau + kStep);
      bool near_break = false;
      for (double b : s.breaks()) near_break |= std::abs(b - tau) < 2.0 * kStep;
      if (near_break) continue;
      EXPECT_NEAR(at.ds, (after.s - before.s) / (2.0 * kStep), 1e-7) << name << " tau " << tau;
      EXPECT_NEAR(at.dds, (after.ds - before.ds) / (2.0 * kStep), 1e-6) << name << " tau " << tau;
      EXPECT_NEAR(at.ddds, (after.dds - before.dds) / (2.0 * kStep), 1e-5) << name << " tau " << tau;
    }
  }
}

TEST(TimeLaw, SymmetricUnderTimeReversal) {
  for (const auto& [name, s] : scalings()) {
    for (int i = 0; i <= 50; ++i) {
      const double tau = 0.01 * i + 0.0007;
      const ScalingSample a = s.at(tau), b = s.at(1.0 - tau);
      EXPECT_NEAR(a.s, 1.0 - b.s, 1e-13) << name;
      EXPECT_NEAR(a.ds, b.ds, 1e-12) << name;
      EXPECT_NEAR(a.dds, -b.dds, 1e-11) << name;
      EXPECT_NEAR(a.ddds, b.ddds, 1e-10) << name;
    }
  }
}

TEST(TimeLaw, HeldOutsideTheInterval) {
  for (const auto& [name, s] : scalings()) {
    EXPECT_EQ(s.at(-0.5).s, s.at(0.0).s) << name;
    EXPECT_EQ(s.at(1.5).s, s.at(1.0).s) << name;
  }
}

TEST(TimeLaw, GoldenSamples) {
  for (const char* name : {"cubic", "345", "4567", "trapezoid_thirds", "cycloidal"}) {
    SCOPED_TRACE(name);
    expectSamples(scalings().at(name), golden(name)["samples_tau_s_s1_s2_s3"], 1e-12);
  }
}

TEST(TimeLaw, GoldenPeaks) {
  for (const char* name : {"cubic", "345", "4567"}) {
    const YAML::Node peaks = golden(name)["peaks"];
    const JointExtrema e = scalings().at(name).extrema();
    EXPECT_NEAR(e.velocity, peaks["s1"]["peak_abs"]["value"].as<double>(), 1e-13) << name;
    EXPECT_NEAR(e.acceleration, peaks["s2"]["peak_abs"]["value"].as<double>(), 1e-12) << name;
    EXPECT_NEAR(e.jerk, peaks["s3"]["peak_abs"]["value"].as<double>(), 1e-12) << name;
  }
  for (const char* name : {"trapezoid_thirds", "cycloidal"}) {
    const YAML::Node peaks = golden(name)["peaks"];
    EXPECT_NEAR(scalings().at(name).extrema().velocity, peaks["s1"]["value"].as<double>(), 1e-13) << name;
    EXPECT_NEAR(scalings().at(name).extrema().acceleration, peaks["s2"]["value"].as<double>(), 1e-12) << name;
  }
  EXPECT_NEAR(TimeLaw::cycloidal().extrema().jerk, golden("cycloidal")["peaks"]["s3"]["value"].as<double>(), 1e-11);
}

TEST(TimeLaw, InfinitePeaksWhereItStepsWithTheSizeOfTheStep) {
  EXPECT_TRUE(std::isinf(TimeLaw::rectangular().extrema().peak(2)));
  EXPECT_DOUBLE_EQ(TimeLaw::rectangular().extrema().velocity_step, 1.0);
  EXPECT_EQ(TimeLaw::cubic().extrema().peak(2), 6.0);
  EXPECT_TRUE(std::isinf(TimeLaw::cubic().extrema().peak(3)));
  EXPECT_DOUBLE_EQ(TimeLaw::cubic().extrema().acceleration_step, 6.0);
  EXPECT_NEAR(TimeLaw::trapezoidal(1.0 / 3.0).extrema().acceleration_step, 4.5, 1e-12);
  EXPECT_NEAR(TimeLaw::trapezoidal(0.5).extrema().acceleration_step, 8.0, 1e-12);  // +4 to -4 at the peak.
  for (const char* name : {"345", "4567", "cycloidal"})
    EXPECT_TRUE(std::isfinite(scalings().at(name).extrema().peak(3))) << name;
}

TEST(TimeLaw, TrapezoidPeaksByBlendFraction) {
  for (double b : {0.01, 0.1, 0.25, 1.0 / 3.0, 0.49, 0.5}) {
    const JointExtrema e = TimeLaw::trapezoidal(b).extrema();
    EXPECT_NEAR(e.velocity, 1.0 / (1.0 - b), 1e-12);
    EXPECT_NEAR(e.acceleration, 1.0 / (b * (1.0 - b)), 1e-10);
    EXPECT_NEAR(TimeLaw::trapezoidal(b).at(0.5).s, 0.5, 1e-13);
  }
  for (double b : {0.0, -0.1, 0.51, std::nan("")}) EXPECT_THROW(TimeLaw::trapezoidal(b), InputError);
}

TEST(TimeLaw, IntegralsOfSquares) {
  EXPECT_NEAR(TimeLaw::polynomial345().extrema().squared_jerk, 720.0, 1e-9);  // Minimum jerk: 720.
  EXPECT_NEAR(TimeLaw::cubic().extrema().squared_acceleration, 12.0, 1e-12);
  EXPECT_NEAR(TimeLaw::cycloidal().extrema().squared_acceleration, 2.0 * kPi * kPi, 1e-12);
  for (const double S : {1.0 / 3.0, 2.0, -3.0}) {
    const double expected = 144.0 * (1024.0 * S * S - 1024.0 * S + 291.0) / 7.0;
    EXPECT_NEAR(TimeLaw::via6(S).extrema().squared_jerk, expected, 1e-9 * expected);
  }
}

TEST(TimeLaw, MinimumJerkIsLeastAmongSmoothNeighbours) {
  const double least = TimeLaw::minimumJerk().extrema().squared_jerk;
  for (double S : {0.4, 0.49, 0.51, 0.6}) EXPECT_GT(TimeLaw::via6(S).extrema().squared_jerk, least);
  EXPECT_GT(TimeLaw::polynomial4567().extrema().squared_jerk, least);
  EXPECT_GT(TimeLaw::cycloidal().extrema().squared_jerk, least);
}

TEST(Via6, GoldenExamples) {
  const YAML::Node examples = golden("via6")["examples"];
  const std::map<std::string, double> values{
      {"S_1_3", 1.0 / 3.0}, {"S_1_2", 0.5}, {"S_seed004_printed", 0.0760279}, {"S_2", 2.0}, {"S_minus3", -3.0}};
  for (const auto& [name, S] : values) {
    SCOPED_TRACE(name);
    const TimeLaw s = TimeLaw::via6(S);
    expectSamples(s, examples[name]["samples_tau_s_s1_s2_s3"], 1e-9);
    const JointExtrema e = s.extrema();
    EXPECT_NEAR(e.position.lower, examples[name]["s_min"].as<double>(), 1e-12);
    EXPECT_NEAR(e.position.upper, examples[name]["s_max"].as<double>(), 1e-12);
    const double v = std::max(examples[name]["s1_max"].as<double>(), -examples[name]["s1_min"].as<double>());
    const double a = std::max(examples[name]["s2_max"].as<double>(), -examples[name]["s2_min"].as<double>());
    EXPECT_NEAR(e.velocity, v, 1e-11);
    EXPECT_NEAR(e.acceleration, a, 1e-10);
  }
}

TEST(Via6, PrintedCoefficientsOfSeed004) {
  // Printed: S = 0.0760279 and 27.13, -75.40, 66.40, -17.13 for the degrees 6 to 3.
  const double S = (90.0 - 83.14) / (173.37 - 83.14);
  EXPECT_NEAR(S, 0.0760279, 5e-8);
  const Polynomial p = TimeLaw::via6(S).pieces().piece(0, 0);
  EXPECT_NEAR(p.c[6], 27.13, 0.005);
  EXPECT_NEAR(p.c[5], -75.40, 0.005);
  EXPECT_NEAR(p.c[4], 66.40, 0.005);
  EXPECT_NEAR(p.c[3], -17.13, 0.005);
}

TEST(Via6, MonotoneExactlyBetweenElevenAndTwentyOneOver32) {
  EXPECT_TRUE(TimeLaw::via6(11.0 / 32.0).isMonotone());
  EXPECT_TRUE(TimeLaw::via6(21.0 / 32.0).isMonotone());
  EXPECT_FALSE(TimeLaw::via6(11.0 / 32.0 - 1e-2).isMonotone());
  EXPECT_FALSE(TimeLaw::via6(21.0 / 32.0 + 1e-2).isMonotone());
  EXPECT_FALSE(TimeLaw::via6(1.0 / 3.0).isMonotone());
}

TEST(Via6, AnyViaInstant) {
  for (double tau : {0.1, 0.3, 0.5, 0.77}) {
    for (double S : {-1.0, 0.2, 0.9}) EXPECT_NEAR(TimeLaw::via6(S, tau).at(tau).s, S, 1e-12);
  }
  for (double tau : {0.0, 1.0, -0.5, std::nan("")}) EXPECT_THROW(TimeLaw::via6(0.5, tau), InputError);
}

/// All four values, consistent with distance and the area under the trapezoid.
void expectTrapezoid(double d, const TrapezoidSpec& spec, double v, double a, double T, double ta) {
  const Trapezoid t = resolveTrapezoid(d, spec);
  EXPECT_NEAR(t.peak_velocity, v, 1e-12);
  EXPECT_NEAR(t.acceleration, a, 1e-12);
  EXPECT_NEAR(t.duration, T, 1e-12);
  EXPECT_NEAR(t.acceleration_time, ta, 1e-12);
  EXPECT_NEAR(t.peak_velocity * (t.duration - t.acceleration_time), d, 1e-12);
}

TEST(Trapezoid, EveryPairGivesTheSameProfile) {
  const double v = 0.8, ta = 0.5, a = 1.6, T = 3.0, d = v * (T - ta);  // 2 rad
  expectTrapezoid(d, {v, {}, T, {}}, v, a, T, ta);
  expectTrapezoid(d, {v, a, {}, {}}, v, a, T, ta);
  expectTrapezoid(d, {{}, a, T, {}}, v, a, T, ta);
  expectTrapezoid(d, {{}, a, {}, ta}, v, a, T, ta);
  expectTrapezoid(d, {v, {}, {}, ta}, v, a, T, ta);
  expectTrapezoid(d, {{}, {}, T, ta}, v, a, T, ta);
}

TEST(Trapezoid, NoneOrOneGivesThirds) {
  const double d = 2.0;
  expectTrapezoid(d, {}, 3.0, 9.0, 1.0, 1.0 / 3.0);
  expectTrapezoid(d, {{}, {}, 2.0, {}}, 1.5, 2.25, 2.0, 2.0 / 3.0);
  expectTrapezoid(d, {1.5, {}, {}, {}}, 1.5, 2.25, 2.0, 2.0 / 3.0);
  expectTrapezoid(d, {{}, 2.25, {}, {}}, 1.5, 2.25, 2.0, 2.0 / 3.0);
  expectTrapezoid(d, {{}, {}, {}, 2.0 / 3.0}, 1.5, 2.25, 2.0, 2.0 / 3.0);
}

TEST(Trapezoid, InfeasiblePairsNameTheRange) {
  const auto message = [](double d, const TrapezoidSpec& spec) {
    try {
      resolveTrapezoid(d, spec);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message(2.0, {0.9, {}, 2.0, {}}).find("feasible is 1 to 2"), std::string::npos);
  EXPECT_NE(message(2.0, {2.1, {}, 2.0, {}}).find("feasible is 1 to 2"), std::string::npos);
  EXPECT_NE(message(2.0, {{}, 1.9, 2.0, {}}).find("feasible is 2 or more"), std::string::npos);
  EXPECT_NE(message(2.0, {2.1, 2.0, {}, {}}).find("feasible is above 0 to 2"), std::string::npos);
  EXPECT_NE(message(2.0, {{}, 2.0, {}, 1.1}).find("feasible is above 0 to 1"), std::string::npos);
  EXPECT_NE(message(2.0, {2.0, {}, {}, 1.1}).find("feasible is above 0 to 1"), std::string::npos);
  EXPECT_NE(message(2.0, {{}, {}, 2.0, 1.1}).find("feasible is above 0 to 1"), std::string::npos);
  EXPECT_FALSE(message(2.0, {1.0, 1.0, 1.0, {}}).empty());
  EXPECT_FALSE(message(2.0, {-1.0, {}, {}, {}}).empty());
  EXPECT_FALSE(message(2.0, {std::nan(""), {}, {}, {}}).empty());
}

TEST(Trapezoid, BoundaryPairsAreFeasibleWithoutNan) {
  for (double d : {0.1, 1.0, 1.0 / 3.0, 2.7}) {
    for (double T : {0.1, 0.7, 3.0}) {
      const Trapezoid triangle = resolveTrapezoid(d, {2.0 * d / T, {}, T, {}});
      EXPECT_NEAR(triangle.acceleration_time, 0.5 * T, 1e-12);
      const Trapezoid same = resolveTrapezoid(d, {{}, 4.0 * d / (T * T), T, {}});
      EXPECT_NEAR(same.acceleration_time, 0.5 * T, 1e-6);
      EXPECT_TRUE(std::isfinite(same.peak_velocity));
    }
  }
}

TEST(Trapezoid, NoDistanceHolds) {
  const Trapezoid t = resolveTrapezoid(0.0, {{}, {}, 2.0, {}});
  EXPECT_EQ(t.duration, 2.0);
  EXPECT_EQ(t.peak_velocity, 0.0);
  EXPECT_EQ(resolveTrapezoid(0.0, {1.0, 1.0, {}, {}}).duration, 0.0);
}

}  // namespace
}  // namespace screwline
