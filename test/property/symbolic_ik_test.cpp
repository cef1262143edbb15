// Inverse kinematics as formulas, worked off from the symbolic objects, against the solver and forward kinematics.

#include <algorithm>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "golden.h"
#include "ik_arms.h"
#include "parallel_arms.h"
#include "quartic_arms.h"
#include "screwline/ik/method_summary.h"
#include "screwline/ik/task_error.h"
#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/task_selection.h"
#include "screwline/spatial/rotation.h"
#include "screwline/symbolic/derivation.h"
#include "screwline/symbolic/inverse_document.h"
#include "shipped_robots.h"

namespace screwline {
namespace {

constexpr int kPoses = 100;
constexpr double kTask = 1e-12;  // [rad, chain's lengths]
constexpr double kJoint = 1e-9;  // [rad, m]

const std::vector<std::string>& written() {
  static const std::vector<std::string> names = {
      "rr_planar",     "rrr_planar",   "planar_3r",       "rrr_articulated", "rrr_orthogonal",
      "rrp_spherical", "rrp_offset",   "rpp_cylindrical", "spherical_wrist", "orienting_3r",
      "scara",         "scara_600",    "prrr_arm",        "prrr_column",     "rrprrr",
      "puma560",       "stanford_arm", "kr6_r900",        "irb6640",         "m10ia",
      "ur5",           "ur10e",        "iiwa14",          "panda",           "gen3_7dof"};
  return names;
}

std::optional<InverseFormulas> formulasOf(const SerialChain& chain, const Task& task) {
  const std::optional<InverseOutline> outline = InverseKinematics(chain, task).outline();
  return outline ? inverseFormulasOf(chain, task, *outline) : std::nullopt;
}

double difference(const SerialChain& chain, const VectorX& a, const VectorX& b) {
  double worst = 0.0;
  for (int i = 0; i < chain.size(); ++i)
    worst = std::max(worst, std::abs(chain.joint(i).isRevolute() ? wrapAngle(a[i] - b[i]) : a[i] - b[i]));
  return worst;
}

TEST(SymbolicInverse, FormulasOfShippedRobotsGiveTheSolversSolutions) {
  for (const std::string& name : written()) {
    SCOPED_TRACE(name);
    const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, name);
    const std::optional<InverseFormulas> formulas = formulasOf(robot.chain, robot.task);
    ASSERT_TRUE(formulas.has_value());
    const InverseKinematics ik(robot.chain, robot.task);
    const InverseCheck check = checkInverse(*formulas, robot.chain, robot.task, everySolution(ik), kPoses);
    EXPECT_EQ(check.poses, kPoses);
    EXPECT_GE(check.solutions, kPoses);
    EXPECT_TRUE(check.agrees()) << check.missing << " missing, " << check.extra << " extra of " << check.solutions;
    EXPECT_LE(check.worst_task, kTask);
    EXPECT_LE(check.worst_joint, kJoint);
  }
}

/// The mechanisms of the golden data, from screw axes and from tables, at poses where solutions may meet or be
/// infinitely many: the configuration itself is found where free joints have its values.
TEST(SymbolicInverse, FormulasReachGoldenPosesSingularOnesToo) {
  for (const std::string& name : golden::names()) {
    SCOPED_TRACE(name);
    const golden::File* file = golden::load(name);
    ASSERT_NE(file, nullptr);
    for (const SerialChain* chain : {&file->chain, &file->table}) {
      if (chain == &file->table && !InverseKinematics(*chain, file->task).outline()) continue;
      const std::optional<InverseFormulas> formulas = formulasOf(*chain, file->task);
      ASSERT_TRUE(formulas.has_value());
      for (const golden::Case& one : file->cases) {
        SCOPED_TRACE(one.id);
        const Pose target = forwardKinematics(*chain, one.q);
        const std::vector<InverseSolution> found = evaluate(*formulas, target, one.q);
        double nearest = 10.0;
        for (const InverseSolution& solution : found) {
          nearest = std::min(nearest, difference(*chain, solution.q, one.q));
          const Pose reached = forwardKinematics(*chain, solution.q);
          EXPECT_LE(taskError(file->task, target, reached).norm(), 1e-7);
        }
        EXPECT_LE(nearest, 1e-6);
      }
    }
  }
}

TEST(SymbolicInverse, UnreachablePosesHaveNoSolution) {
  int poses = 0;
  for (const std::string& name : golden::names()) {
    SCOPED_TRACE(name);
    const golden::File* file = golden::load(name);
    ASSERT_NE(file, nullptr);
    const std::optional<InverseFormulas> formulas = formulasOf(file->chain, file->task);
    ASSERT_TRUE(formulas.has_value());
    for (const golden::UnreachablePose& one : file->unreachable) {
      EXPECT_TRUE(evaluate(*formulas, one.pose, VectorX::Zero(file->chain.size())).empty()) << one.reason;
      ++poses;
    }
  }
  EXPECT_GT(poses, 10);
}

void expectFormulas(const SerialChain& chain, const Task& task) {
  const std::optional<InverseFormulas> formulas = formulasOf(chain, task);
  ASSERT_TRUE(formulas.has_value());
  const InverseKinematics ik(chain, task);
  const InverseCheck check = checkInverse(*formulas, chain, task, everySolution(ik), 20);
  EXPECT_EQ(check.poses, 20);
  EXPECT_TRUE(check.agrees()) << check.missing << " missing, " << check.extra << " extra";
  EXPECT_LE(check.worst_task, kTask);
  EXPECT_LE(check.worst_joint, kJoint);
}

/// Random arms of the closed forms' structures, mounted anyhow, with any tool.
TEST(SymbolicInverse, FormulasOfRandomArmsGiveTheSolversSolutions) {
  for (int structure = 0; structure < test::ArmMaker::kStructures; ++structure) {
    // Wrists take longer; the first of structure 12 has more lengths and angles than a derivation holds.
    const std::vector<unsigned> seeds = structure < 10 ? std::vector<unsigned>{1, 2, 3} : std::vector<unsigned>{2, 3};
    for (const unsigned seed : seeds) {
      test::ArmMaker maker(100 * seed + static_cast<unsigned>(structure));
      const test::ArmMaker::Arm arm = maker.make(structure);
      SCOPED_TRACE(arm.structure + ", seed " + std::to_string(seed));
      expectFormulas(arm.chain, arm.task);
    }
  }
}

TEST(SymbolicInverse, FormulasOfThreeParallelAxesAnywhereGiveTheSolversSolutions) {
  for (int structure = 0; structure < test::ParallelArmMaker::kStructures; structure += 2) {
    SCOPED_TRACE(test::ParallelArmMaker::name(structure));
    test::ParallelArmMaker maker(100 + static_cast<unsigned>(structure));
    expectFormulas(maker.make(structure), Task());
  }
}

TEST(SymbolicInverse, FormulasWithAQuarticGiveTheSolversSolutions) {
  for (int structure = 0; structure < test::QuarticArmMaker::kStructures; ++structure) {
    test::QuarticArmMaker maker(300 + static_cast<unsigned>(structure));
    const test::ArmMaker::Arm arm = maker.make(structure);
    SCOPED_TRACE(arm.structure);
    expectFormulas(arm.chain, arm.task);
    const std::optional<InverseFormulas> formulas = formulasOf(arm.chain, arm.task);
    ASSERT_TRUE(formulas.has_value());
    EXPECT_TRUE(std::any_of(formulas->steps.begin(), formulas->steps.end(),
                            [](const InverseStep& step) { return step.equation.size() == 5; }));
  }
}

/// Where the arm is singular two roots of the quartic meet, and rounding may put both off the real line.
TEST(SymbolicInverse, DoubleRootsOfAQuarticAreFound) {
  const test::ArmMaker::Arm arm = test::QuarticArmMaker(311).make(0);
  const std::optional<InverseFormulas> formulas = formulasOf(arm.chain, arm.task);
  ASSERT_TRUE(formulas.has_value());
  const auto determinant = [&](const VectorX& q) {
    Matrix6X J(6, 3);
    geometricJacobian(arm.chain, q, J);
    return Matrix3(J.topRows<3>()).determinant();
  };
  std::mt19937 random(7);
  int met = 0;
  for (int k = 0; k < 40; ++k) {
    VectorX q(3);
    for (int i = 0; i < 3; ++i) q[i] = kPi * (static_cast<double>(random()) / 2147483648.0 - 1.0);
    VectorX other = q;
    other[2] += 1.0;
    if (determinant(q) * determinant(other) > 0.0) continue;
    for (int i = 0; i < 60; ++i) {
      const VectorX middle = 0.5 * (q + other);
      (determinant(middle) * determinant(q) > 0.0 ? q : other) = middle;
    }
    double nearest = 10.0;
    for (const InverseSolution& solution : evaluate(*formulas, forwardKinematics(arm.chain, q), q))
      nearest = std::min(nearest, difference(arm.chain, solution.q, q));
    EXPECT_LE(nearest, 1e-6) << q.transpose();
    ++met;
  }
  EXPECT_GE(met, 10);
}

TEST(SymbolicInverse, AQuarticReadsWithItsCoefficients) {
  const test::ArmMaker::Arm arm = test::QuarticArmMaker(300).make(0);
  const std::optional<InverseFormulas> formulas = formulasOf(arm.chain, arm.task);
  ASSERT_TRUE(formulas.has_value());
  const std::string text = inverseSection(*formulas, DocumentFormat::kText);
  for (const char* line : {"0 = (K3 - A3 + C3) t3^4 + (2 B3 - 4 D3) t3^3 + (2 K3 - 6 C3) t3^2 + (2 B3 + 4 D3) t3 + K3",
                           "theta3 = 2 atan2(t3, 1)", "4 solutions at most"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
  }
}

/// Five rows: the tool's turn about its direction is one angle more, which no joint makes.
TEST(SymbolicInverse, ATasksOpenTurnIsOneAngleMore) {
  const SerialChain chain = test::shippedRobot(SCREWLINE_SOURCE_DIR, "youbot_arm").chain;
  const Task task = deriveTask(chain);
  ASSERT_EQ(task.size(), 5);
  expectFormulas(chain, task);
  const std::optional<InverseFormulas> formulas = formulasOf(chain, task);
  ASSERT_TRUE(formulas.has_value());
  EXPECT_GE(formulas->tool_turn, chain.size());
}

TEST(SymbolicInverse, AJointThatTurnsTheToolOnlyMayTakeAnyValue) {
  const SerialChain chain = test::shippedRobot(SCREWLINE_SOURCE_DIR, "puma560").chain;
  const Task task = Task::pointing(2);
  expectFormulas(chain, task);
  const std::optional<InverseFormulas> formulas = formulasOf(chain, task);
  ASSERT_TRUE(formulas.has_value());
  EXPECT_EQ(formulas->open_joint, 5);
  VectorX q(6);
  q << 0.3, -0.5, 0.2, -1.8, 0.4, 1.9;
  const Pose target = forwardKinematics(chain, q);
  for (const InverseSolution& solution : evaluate(*formulas, target, VectorX::Constant(6, 0.8))) {
    EXPECT_EQ(solution.q[5], 0.8);
    EXPECT_EQ(solution.free, 1U << 5U);
    EXPECT_LE(taskError(task, target, forwardKinematics(chain, solution.q)).norm(), 1e-12);
  }
}

TEST(SymbolicInverse, SevenJointsHaveTheirParameterGiven) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "panda");
  const std::optional<InverseFormulas> formulas = formulasOf(robot.chain, robot.task);
  ASSERT_TRUE(formulas.has_value());
  EXPECT_EQ(formulas->given, 6);
  VectorX q(7);
  q << 0.3, -0.5, 0.2, -1.8, 0.4, 1.9, 0.7;
  const Pose target = forwardKinematics(robot.chain, q);
  for (const double value : {0.7, 0.9}) {
    VectorX preferred = VectorX::Zero(7);
    preferred[6] = value;
    const std::vector<InverseSolution> found = evaluate(*formulas, target, preferred);
    EXPECT_FALSE(found.empty());
    for (const InverseSolution& solution : found) {
      EXPECT_EQ(solution.q[6], value);
      EXPECT_LE(taskError(robot.task, target, forwardKinematics(robot.chain, solution.q)).norm(), 1e-12);
    }
  }
  const std::string text = inverseSection(*formulas, DocumentFormat::kText);
  EXPECT_NE(text.find("theta7 is given"), std::string::npos) << text;
}

/// One joint more in front of, or behind, arms whose third joint takes a quartic.
TEST(SymbolicInverse, FormulasOfSevenJointsAnyhowGiveTheSolversSolutions) {
  for (const int structure : {4, 5, 7}) {
    for (const bool in_front : {true, false}) {
      test::ArmMaker maker(static_cast<unsigned>(structure));
      const test::ArmMaker::Arm arm = test::QuarticArmMaker(330).make(structure);
      SCOPED_TRACE(arm.structure + (in_front ? ", a joint in front" : ", a joint behind"));
      std::vector<Axis> axes = arm.chain.axes();
      axes.insert(in_front ? axes.begin() : axes.end(), test::ArmMaker::turn(maker.direction(), maker.vector(0.8)));
      const SerialChain chain = test::ArmMaker::chain(axes, arm.chain.home(), maker.pose());
      expectFormulas(chain, Task());
    }
  }
}

/// The checker sees a solution that is missing, one too much, and a formula of another robot.
TEST(SymbolicInverse, TheCheckCanFail) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "puma560");
  const std::optional<InverseFormulas> formulas = formulasOf(robot.chain, robot.task);
  ASSERT_TRUE(formulas.has_value());
  const InverseKinematics ik(robot.chain, robot.task);
  const InverseSolver whole = everySolution(ik);
  const auto fewer = [&](const Pose& X, const VectorX& q) {
    std::vector<VectorX> all = whole(X, q);
    all.pop_back();
    return all;
  };
  EXPECT_EQ(checkInverse(*formulas, robot.chain, robot.task, fewer, 10).extra, 10);
  InverseFormulas other_lengths = *formulas;
  SymbolTable symbols;
  for (int id = 0; id < formulas->symbols.size(); ++id) {
    Symbol symbol = formulas->symbols[id];
    if (symbol.kind == SymbolKind::kLength) symbol.value *= 1.0001;
    symbols.add(symbol);
  }
  other_lengths.symbols = symbols;
  const InverseCheck wrong = checkInverse(other_lengths, robot.chain, robot.task, whole, 10);
  EXPECT_FALSE(wrong.agrees());
  EXPECT_GT(wrong.worst_task, 1e-6);
}

TEST(SymbolicInverse, FormulasThatFailTheCheckAreNotShown) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "puma560");
  const InverseKinematics ik(robot.chain, robot.task);
  DerivationOptions options;
  options.quantities = {"ik"};
  options.format = DocumentFormat::kText;
  InverseMethod method{{"method"}, ik.outline(), everySolution(ik)};
  options.inverse = [&method](const SerialChain&) { return method; };
  const Derivation shown = deriveDocument(robot.chain, robot.task, options);
  EXPECT_NE(shown.document.find("theta2 = atan2(-wz, f)"), std::string::npos) << shown.document;
  EXPECT_NE(shown.document.find("the 800 solutions that the numeric solver finds"), std::string::npos);
  EXPECT_TRUE(shown.no_inverse.empty());
  method.solver = [](const Pose&, const VectorX&) { return std::vector<VectorX>(); };
  const Derivation refused = deriveDocument(robot.chain, robot.task, options);
  EXPECT_EQ(refused.document.find("theta2 = atan2(-wz, f)"), std::string::npos);
  EXPECT_NE(refused.no_inverse.find("do not hold"), std::string::npos);
  method.outline.reset();
  EXPECT_NE(deriveDocument(robot.chain, robot.task, options).no_inverse.find("no closed form"), std::string::npos);
}

TEST(SymbolicInverse, APlanarArmReadsAsInTextbooks) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "rr_planar");
  const std::optional<InverseFormulas> formulas = formulasOf(robot.chain, robot.task);
  ASSERT_TRUE(formulas.has_value());
  const std::string text = inverseSection(*formulas, DocumentFormat::kText);
  for (const char* line : {"D2 = (px^2 + py^2 - a1^2 - a2^2)/(2 a1 a2)\n", "S2 = +- sqrt(1 - D2^2)\n",
                           "theta2 = atan2(S2, D2)\n", "theta1 = atan2(py, px) - atan2(a2 s2, a1 + a2 c2)\n",
                           "|D2| > 1", "theta1 may take any value where px = py = 0"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
  }
  EXPECT_NE(inverseSection(*formulas, DocumentFormat::kMarkdown).find("\\pm \\sqrt{1 - D_{2}^{2}}"), std::string::npos);
}

TEST(SymbolicInverse, RobotsWithoutAClosedFormHaveNone) {
  for (const char* name : {"jaco2_6dof", "six_r_16"}) {
    const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, name);
    EXPECT_FALSE(InverseKinematics(robot.chain, robot.task).outline().has_value()) << name;
  }
}

}  // namespace
}  // namespace screwline
