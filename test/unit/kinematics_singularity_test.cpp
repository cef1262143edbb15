#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "golden.h"
#include "kinematics_arms.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/kinematics/task_selection.h"

namespace screwline {
namespace {

VectorX vec(std::initializer_list<double> values) {
  VectorX v(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), v.data());
  return v;
}

// ---- The conditions of the golden arms.

struct Expected {
  std::string file;
  std::vector<std::string> conditions;  ///< "name: expression"
};

class ConditionsOf : public testing::TestWithParam<Expected> {};

TEST_P(ConditionsOf, AreThoseOfItsGeometry) {
  const golden::File& file = *golden::load(GetParam().file);
  for (const SerialChain* chain : {&file.chain, &file.table}) {
    std::vector<std::string> found;
    for (const SingularityFactor& factor : factorsOf(*chain, file.task)) {
      found.push_back(factor.name + ": " + factor.expression);
      EXPECT_FALSE(factor.latex.empty());
      EXPECT_FALSE(factor.meaning.empty());
    }
    EXPECT_EQ(found, GetParam().conditions);
  }
}

const std::vector<Expected> kExpected = {
    {"seed000_prrr", {"elbow: sin(theta3) = 0"}},
    {"seed001_rrp_spherical", {"shoulder: cos(q2) = 0", "extension: d3 + 0.5 = 0"}},
    {"seed001_rrp_spherical__special", {"shoulder: cos(q2) = 0", "extension: d3 + 1 = 0"}},
    {"seed003_01_rr_planar", {"elbow: sin(theta2) = 0"}},
    {"seed003_02_rrr_planar", {"elbow: sin(theta2) = 0"}},
    {"seed003_03_rrr_articulated",
     {"elbow: sin(theta3) = 0", "shoulder: 0.7*cos(theta2) + 0.5*cos(theta2 + theta3) = 0"}},
    {"seed003_03_rrr_articulated__special",
     {"elbow: sin(theta3) = 0", "shoulder: 0.6*cos(theta2) + 0.6*cos(theta2 + theta3) = 0"}},
    {"seed003_04_rrp_offset", {"shoulder: sin(theta2) = 0", "extension: d3 = 0"}},
    {"seed003_05_rpp_cylindrical", {"extension: d3 = 0"}},
    {"seed003_06_wrist", {"wrist: sin(theta5) = 0"}},
    {"seed003_07_scara", {"elbow: sin(theta2) = 0"}},
    {"seed003_08_prrr", {"elbow: sin(theta3) = 0"}},
    {"seed004_01_rrprrr", {"elbow: cos(q2) = 0", "wrist: cos(q5) = 0"}},
    {"seed004_02_rrr_dh", {"shoulder: cos(theta2) = 0", "elbow: cos(theta3) = 0"}},
    {"seed004_03_orienting_3r", {"wrist: sin(theta2) = 0"}},
    {"seed004_05_planar_3r", {"elbow: sin(theta2) = 0"}},
};

std::string expectedName(const testing::TestParamInfo<Expected>& info) {
  return info.param.file;
}

INSTANTIATE_TEST_SUITE_P(Arms, ConditionsOf, testing::ValuesIn(kExpected), expectedName);

TEST(Conditions, OfASixJointArmWithWristAndOffsets) {
  const std::vector<SingularityFactor> factors = factorsOf(arms::offsetArmWithWrist(), Task());
  ASSERT_EQ(factors.size(), 3u);
  EXPECT_EQ(factors[0].name, "elbow");
  EXPECT_EQ(factors[0].joints, std::vector<int>({2}));
  // Straight where atan2(0.02, 0.38) lines wrist, elbow and shoulder up.
  EXPECT_NEAR(factors[0].roots[1], std::atan2(0.02, 0.38), 1e-12);
  EXPECT_EQ(factors[1].name, "shoulder");
  EXPECT_EQ(factors[1].expression, "0.43*cos(q2) + 0.38*cos(q2 + q3) + 0.1 + 0.02*sin(q2 + q3) = 0");
  EXPECT_EQ(factors[2].name, "wrist");
  EXPECT_EQ(factors[2].expression, "sin(q5) = 0");
}

TEST(Conditions, OfASixJointArmWithoutSphericalWrist) {
  const std::vector<SingularityFactor> factors = factorsOf(arms::parallelArm(), Task());
  ASSERT_EQ(factors.size(), 3u);
  EXPECT_EQ(factors[0].expression, "sin(q3) = 0");
  EXPECT_EQ(factors[1].expression, "0.42*cos(q2) + 0.39*cos(q2 + q3) - 0.1*sin(q2 + q3 + q4) = 0");
  EXPECT_EQ(factors[1].name, "shoulder");
  EXPECT_EQ(factors[2].name, "wrist");
  EXPECT_EQ(factors[2].expression, "sin(q5) = 0");
}

TEST(Conditions, AreWrittenInLatexToo) {
  const golden::File& file = *golden::load("seed003_03_rrr_articulated");
  const std::vector<SingularityFactor> factors = factorsOf(file.chain, file.task);
  EXPECT_EQ(factors[0].latex, "\\sin(\\theta_{3}) = 0");
  EXPECT_EQ(factors[1].latex, "0.7 \\cos(\\theta_{2}) + 0.5 \\cos(\\theta_{2} + \\theta_{3}) = 0");
}

TEST(Conditions, OfARedundantArmAreTheDeterminant) {
  const std::vector<SingularityFactor> factors = factorsOf(arms::anthropomorphicArm(), Task());
  ASSERT_EQ(factors.size(), 1u);
  EXPECT_EQ(factors[0].name, "determinant");
  EXPECT_EQ(factors[0].expression, "det(J_task * J_task^T) = 0");
}

TEST(Conditions, NoneWhereTheTaskIsNeverSingular) {
  const SerialChain gantry =
      arms::chainOf({arms::sliding(arms::kX), arms::sliding(arms::kY), arms::sliding(arms::kZ)}, Vector3::Zero());
  const SingularityAnalysis analysis = analyzeSingularity(gantry, vec({0.1, 0.2, 0.3}), Task::fromRows({0, 1, 2}));
  EXPECT_FALSE(analysis.singular);
  EXPECT_TRUE(analysis.conditions.empty());
  EXPECT_EQ(analysis.nearest.size(), 0);
  EXPECT_TRUE(std::isinf(analysis.distance));
  EXPECT_DOUBLE_EQ(analysis.condition_number, 1.0);
}

TEST(Conditions, AlwaysWhereTheTaskCannotBeGiven) {
  const SerialChain planar = arms::planarArm(3);
  const VectorX q = vec({0.1, 0.7, -0.4});
  const SingularityAnalysis analysis = analyzeSingularity(planar, q, Task::fromRows({0, 1, 2}));
  EXPECT_TRUE(analysis.singular);
  EXPECT_EQ(analysis.rank.rank, 2);
  ASSERT_EQ(analysis.conditions.size(), 1u);
  EXPECT_EQ(analysis.conditions[0].name, "always");
  EXPECT_TRUE(analysis.conditions[0].active);
  EXPECT_EQ(analysis.nearest, q);
  EXPECT_EQ(analysis.distance, 0.0);
}

// ---- Rank.

TEST(Rank, OfNothingIsZero) {
  const TaskRank rank = taskRank(MatrixX::Zero(3, 4));
  EXPECT_EQ(rank.rank, 0);
  EXPECT_EQ(rank.lost_directions.rows(), 3);
  EXPECT_EQ(rank.self_motions.rows(), 4);
}

TEST(Rank, IsRelativeToTheLargest) {
  MatrixX J = MatrixX::Identity(3, 3) * 1e-5;
  EXPECT_EQ(taskRank(J).rank, 3);
  J(2, 2) = 1.01e-14;
  EXPECT_EQ(taskRank(J).rank, 3);
  J(2, 2) = 0.99e-14;
  EXPECT_EQ(taskRank(J).rank, 2);
}

TEST(Rank, OfAWristWhoseTipIsItsCentreIsZeroInPosition) {
  const golden::File& wrist = *golden::load("seed003_06_wrist");
  // Turned so that no entry is an exact zero.
  std::vector<Axis> axes = wrist.chain.axes();
  const Pose X = {rotationAbout(Vector3(1.0, 2.0, 3.0).normalized(), 0.7), Vector3(0.3, 0.1, 0.2)};
  for (Axis& axis : axes) {
    axis.direction = (X.R * axis.direction).normalized();
    axis.point = X * axis.point;
  }
  const SerialChain turned = arms::chainOf(axes, X.p);
  const SingularityAnalysis analysis = analyzeSingularity(turned, vec({0.4, 0.9, -0.3}), Task::fromRows({0, 1, 2}));
  EXPECT_EQ(analysis.rank.rank, 0);
  EXPECT_EQ(analysis.condition_number, kMaxCondition);
}

TEST(Rank, OutputsAreNumbersAtASingularity) {
  const SerialChain arm = arms::planarArm(2);
  const SingularityAnalysis analysis = analyzeSingularity(arm, vec({0.3, 0.0}), Task::fromRows({0, 1}));
  EXPECT_TRUE(analysis.singular);
  EXPECT_EQ(analysis.condition_number, kMaxCondition);
  EXPECT_NEAR(analysis.determinant, 0.0, 1e-15);
  EXPECT_TRUE(std::isnan(analyzeSingularity(arm, vec({0.3, 0.0}), Task::fromRows({0})).determinant));
}

// ---- The nearest singular configuration.

/// Shortest distance from q to a sign change of the determinant along rays: every joint, every pair, and many random
/// directions.
double byRays(const SerialChain& chain, const Task& task, const VectorX& q, double reach, unsigned seed) {
  const TaskDeterminant determinant(chain, task);
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<VectorX> rays;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    for (double side : {-1.0, 1.0}) rays.push_back(side * VectorX::Unit(q.size(), i));
  }
  for (int k = 0; k < 1500; ++k) {
    VectorX ray(q.size());
    for (Eigen::Index i = 0; i < ray.size(); ++i) ray[i] = k % 3 == 0 || normal(engine) > 0.0 ? normal(engine) : 0.0;
    if (ray.norm() > 1e-3) rays.push_back(ray.normalized());
  }
  const double f = determinant(q);
  double shortest = reach;
  for (const VectorX& ray : rays) {
    double low = 0.0;
    double high = 0.0;
    while (high < shortest && determinant(q + high * ray) * f > 0.0) {
      low = high;
      high += 0.05;
    }
    if (high >= shortest) continue;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + high);
      (determinant(q + middle * ray) * f > 0.0 ? low : high) = middle;
    }
    shortest = high;
  }
  return shortest;
}

void expectSingularAt(const SerialChain& chain, const Task& task, const SingularityAnalysis& analysis,
                      const VectorX& q) {
  ASSERT_EQ(analysis.nearest.size(), q.size());
  EXPECT_DOUBLE_EQ(analysis.distance, (analysis.nearest - q).norm());
  EXPECT_TRUE(analyzeSingularity(chain, analysis.nearest, task).singular);
  EXPECT_FALSE(analysis.nearest_note.empty());
}

class Nearest : public testing::TestWithParam<std::string> {};

TEST_P(Nearest, IsNoFartherThanARaySearchFinds) {
  const golden::File& file = *golden::load(GetParam());
  for (const golden::Case& c : file.cases) {
    SCOPED_TRACE(c.id);
    const SingularityAnalysis analysis = analyzeSingularity(file.chain, c.q, file.task);
    expectSingularAt(file.chain, file.task, analysis, c.q);
    if (c.rank_task < file.chain.size()) {
      EXPECT_EQ(analysis.nearest, c.q);
      EXPECT_EQ(analysis.distance, 0.0);
    } else {
      EXPECT_GT(analysis.distance, 0.0);
      EXPECT_LE(analysis.distance, byRays(file.chain, file.task, c.q, 4.0, 17) + 1e-9);
    }
  }
}

std::string fileName(const testing::TestParamInfo<std::string>& info) {
  return info.param;
}

INSTANTIATE_TEST_SUITE_P(Files, Nearest, testing::ValuesIn(golden::names()), fileName);

TEST(NearestSingularity, OfATwoLinkArmIsStraightOrFolded) {
  const SerialChain arm = arms::planarArm(2);
  for (double elbow : {0.2, 1.4, 1.7, 3.0, -0.5, -2.0, 4.0, 7.0}) {
    const SingularityAnalysis analysis = analyzeSingularity(arm, vec({0.3, elbow}), Task::fromRows({0, 1}));
    EXPECT_NEAR(analysis.distance, std::abs(elbow - kPi * std::round(elbow / kPi)), 1e-12) << elbow;
    EXPECT_DOUBLE_EQ(analysis.nearest[0], 0.3);
  }
}

TEST(NearestSingularity, OfASlideIsWhereItIsDrawnIn) {
  const golden::File& file = *golden::load("seed001_rrp_spherical");
  const SingularityAnalysis analysis = analyzeSingularity(file.chain, vec({0.3, 0.1, -0.2}), file.task);
  EXPECT_NEAR(analysis.distance, 0.3, 1e-12);  // rho = d3 + 0.5
  EXPECT_NEAR(analysis.nearest[2], -0.5, 1e-12);
}

TEST(NearestSingularity, OfAnArticulatedArmAgreesWithAFineSearchOfTheShoulderCurve) {
  const golden::File& file = *golden::load("seed003_03_rrr_articulated");
  for (double q2 : {-1.3, -0.4, 0.5, 1.1, 2.5}) {
    for (double q3 : {-2.2, -1.0, 0.9, 1.6, 2.6}) {
      double best = std::abs(q3 - kPi * std::round(q3 / kPi));
      for (int k = 0; k < 200000; ++k) {  // theta2 of the curve from theta3, both branches.
        const double x3 = q3 + kTwoPi * (k / 200000.0 - 0.5);
        const double x2 = std::atan2(0.7 + 0.5 * std::cos(x3), 0.5 * std::sin(x3));
        const double to_curve = x2 - q2 - kPi * std::round((x2 - q2) / kPi);
        best = std::min(best, std::hypot(to_curve, x3 - q3));
      }
      const SingularityAnalysis analysis = analyzeSingularity(file.chain, vec({0.2, q2, q3}), file.task);
      EXPECT_NEAR(analysis.distance, best, 1e-8) << q2 << " " << q3;
    }
  }
}

TEST(NearestSingularity, KeepsWithinLimitsWhereItCan) {
  JointLimits limits;
  limits.lower = -2.5;
  limits.upper = 3.0;
  const SerialChain arm = arms::chainOf({arms::turning(arms::kZ, Vector3::Zero()), arms::turning(arms::kZ, arms::kX)},
                                        2.0 * arms::kX, limits);
  const SingularityAnalysis analysis = analyzeSingularity(arm, vec({0.0, 2.9}), Task::fromRows({0, 1}));
  EXPECT_TRUE(analysis.nearest_within_limits);
  EXPECT_NEAR(analysis.distance, 2.9, 1e-12);
  EXPECT_NEAR(analysis.nearest[1], 0.0, 1e-12);
}

TEST(NearestSingularity, LeavesLimitsWhereThereIsNoneWithin) {
  JointLimits limits;
  limits.lower = 0.5;
  limits.upper = 3.0;
  const SerialChain arm = arms::chainOf({arms::turning(arms::kZ, Vector3::Zero()), arms::turning(arms::kZ, arms::kX)},
                                        2.0 * arms::kX, limits);
  const SingularityAnalysis analysis = analyzeSingularity(arm, vec({1.0, 2.9}), Task::fromRows({0, 1}));
  EXPECT_FALSE(analysis.nearest_within_limits);
  EXPECT_NEAR(analysis.distance, kPi - 2.9, 1e-12);
  EXPECT_NE(analysis.nearest_note.find("outside"), std::string::npos);
}

TEST(NearestSingularity, OfASixJointArmStaysInItsLimitsAndBeatsRays) {
  JointLimits limits;
  limits.lower = -2.0;
  limits.upper = 2.0;
  const SerialChain arm = arms::offsetArmWithWrist(limits);
  const SerialChain unlimited = arms::offsetArmWithWrist();
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> uniform(-2.0, 2.0);
  for (int k = 0; k < 20; ++k) {
    VectorX q(6);
    for (Eigen::Index i = 0; i < 6; ++i) q[i] = uniform(engine);
    const SingularityAnalysis analysis = analyzeSingularity(arm, q, Task());
    expectSingularAt(arm, Task(), analysis, q);
    EXPECT_TRUE(analysis.nearest_within_limits);
    EXPECT_TRUE((analysis.nearest.array().abs() <= 2.0).all());
    const SingularityAnalysis free = analyzeSingularity(unlimited, q, Task());
    EXPECT_LE(free.distance, analysis.distance + 1e-9);
    EXPECT_LE(free.distance, byRays(unlimited, Task(), q, 4.0, 3) + 1e-9);
  }
}

TEST(NearestSingularity, OfARedundantPlanarArmHasAllLinksInLine) {
  const SerialChain arm = arms::planarArm(4);
  const Task task = Task::fromRows({0, 1, 5});
  EXPECT_TRUE(deriveTask(arm) == task);
  // Of four parallel axes the first three joints' lines decide: q2 and q3 both 0 or pi.
  for (const VectorX& q : {vec({0.1, 0.3, -0.4, 1.0}), vec({0.1, 2.8, 0.3, 1.0}), vec({0.4, -0.2, 2.9, 0.3})}) {
    const SingularityAnalysis analysis = analyzeSingularity(arm, q, task);
    expectSingularAt(arm, task, analysis, q);
    const double d2 = q[1] - kPi * std::round(q[1] / kPi);
    const double d3 = q[2] - kPi * std::round(q[2] / kPi);
    EXPECT_NEAR(analysis.distance, std::hypot(d2, d3), 1e-7);
  }
}

TEST(NearestSingularity, OfARedundantArmIsSingular) {
  const SerialChain arm = arms::anthropomorphicArm();
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> uniform(-1.5, 1.5);
  for (int k = 0; k < 20; ++k) {
    VectorX q(7);
    for (Eigen::Index i = 0; i < 7; ++i) q[i] = uniform(engine);
    const SingularityAnalysis analysis = analyzeSingularity(arm, q, Task());
    expectSingularAt(arm, Task(), analysis, q);
    EXPECT_LE(analysis.distance, std::abs(q[3]) + 1e-9) << "a straight elbow is singular";
  }
}

}  // namespace
}  // namespace screwline
