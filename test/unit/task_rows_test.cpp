#include <gtest/gtest.h>

#include <cstdio>

#include "property/model_random.h"
#include "screwline/exception.h"
#include "screwline/ik/task_error.h"
#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/kinematics/singularity_factors.h"
#include "screwline/kinematics/statics.h"
#include "screwline/kinematics/task_selection.h"
#include "screwline/kinematics/velocity.h"
#include "screwline/symbolic/derivation.h"
#include "shipped_robots.h"

namespace screwline {
namespace {

const Task kPointing = Task::parse({"x", "y", "z", "tx", "ty"});

std::string refusalOf(const std::vector<std::string>& names) {
  try {
    Task::parse(names);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(TaskRows, OfTheToolAreParsedAndNamed) {
  EXPECT_EQ(kPointing.size(), 5);
  EXPECT_EQ(kPointing.translationCount(), 3);
  EXPECT_EQ(kPointing.rotationCount(), 2);
  EXPECT_EQ(kPointing.names(), (std::vector<std::string>{"x", "y", "z", "tx", "ty"}));
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(Task::pointing(axis).pointingAxis(), axis);
  EXPECT_EQ(Task::parse({"ty", "tz"}).pointingAxis(), 0);
  for (const std::vector<std::string>& names :
       std::vector<std::vector<std::string>>{{"x", "y"}, {"tx"}, {"tx", "ty", "tz"}, {"rx", "ry"}})
    EXPECT_EQ(Task::parse(names).pointingAxis(), -1);
}

TEST(TaskRows, OfBaseAndToolAreNotMixed) {
  EXPECT_NE(refusalOf({"x", "rx", "ty"}).find("'ty' stands beside 'rx'"), std::string::npos);
  EXPECT_NE(refusalOf({"tx", "rz"}).find("'rz' stands beside 'tx'"), std::string::npos);
  EXPECT_NE(refusalOf({"tw"}).find("known rows are x, y, z, rx, ry, rz, tx, ty, tz"), std::string::npos);
  EXPECT_NE(refusalOf({"tx", "tx"}).find("given twice"), std::string::npos);
}

TEST(TaskRows, OfTheToolNeedItsOrientation) {
  EXPECT_THROW(kPointing.select(Matrix6X(Matrix6X::Zero(6, 5))), Exception);
  EXPECT_THROW(kPointing.select(Vector6(Vector6::Zero())), Exception);
}

TEST(TaskRows, SpreadIsTheTransposeOfSelect) {
  RandomModel random(11);
  for (const Task& task : {kPointing, Task::pointing(0), Task::parse({"ty", "x"}), Task::parse({"rz", "y"}), Task()}) {
    const Matrix3 R = random.pose().R;
    const Vector6 twist = Vector6::Random();
    const VectorX values = VectorX::Random(task.size());
    EXPECT_NEAR(values.dot(task.select(twist, R)), task.spread(values, R).dot(twist), 1e-14);
    EXPECT_LE((task.select(task.spread(values, R), R) - values).norm(), 1e-14);
  }
}

TEST(TaskRows, ErrorIsTheSmallestTurnOfThePointingAxis) {
  RandomModel random(12);
  for (int k = 0; k < 300; ++k) {
    const int axis = random.integer(0, 2);
    const Pose target = random.pose();
    Pose actual = random.pose();
    if (k % 3 == 0) {  // Almost the same direction, turned about it.
      const Matrix3 about = rotationAbout(target.R.col(axis), random.uniform(-3.0, 3.0));
      actual.R = rotationAbout(random.direction(), 1e-9) * about * target.R;
    }
    const TaskError error = taskError(Task::pointing(axis), target, actual);
    const double angle = error.orientation;
    ASSERT_LE(angle, kPi);
    EXPECT_NEAR(error.twist.tail<3>().dot(actual.R.col(axis)), 0.0, 1e-12);
    const Matrix3 turned =
        angle > 0.0 ? Matrix3(rotationAbout(error.twist.tail<3>() / angle, angle) * actual.R) : actual.R;
    EXPECT_LE((turned.col(axis) - target.R.col(axis)).norm(), 1e-14);
    EXPECT_NEAR(
        angle,
        std::atan2(actual.R.col(axis).cross(target.R.col(axis)).norm(), actual.R.col(axis).dot(target.R.col(axis))),
        1e-14);
  }
}

TEST(TaskRows, ErrorOfOppositeDirectionsIsHalfATurn) {
  for (int axis = 0; axis < 3; ++axis) {
    Pose target;
    target.R = rotationAbout(Vector3::Unit((axis + 2) % 3), kPi);
    EXPECT_NEAR(taskError(Task::pointing(axis), target, Pose()).orientation, kPi, 1e-12);
    target.R = -Matrix3::Identity();  // Directions opposite to the last bit.
    const TaskError error = taskError(Task::pointing(axis), target, Pose());
    EXPECT_NEAR(error.orientation, kPi, 1e-15);
    EXPECT_TRUE(error.twist.allFinite());
  }
}

/// The rows tell how the error changes: by finite differences of the error at the target, in the tool's axes.
double worstRowError(const SerialChain& chain, const VectorX& q, const Task& task, const MatrixX& rows) {
  constexpr double kStep = 1e-6;
  const Pose target = forwardKinematics(chain, q);
  double worst = 0.0;
  for (int i = 0; i < chain.size(); ++i) {
    const auto at = [&](double step) -> VectorX {
      const Pose moved = forwardKinematics(chain, q + step * VectorX::Unit(chain.size(), i));
      return task.select(taskError(task, target, moved).twist, moved.R);
    };
    const VectorX difference = (at(-kStep) - at(kStep)) / (2.0 * kStep);
    worst = std::max(worst, (difference - rows.col(i)).cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(TaskRows, JacobianIsTheDerivativeOfTheError) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    RandomModel random(seed);
    const SerialChain chain = random.chain(random.integer(2, 7), random.chance(0.3));
    const VectorX q = random.configuration(chain.size());
    const Task task = Task::pointing(random.integer(0, 2));
    MatrixX rows = taskJacobian(chain, q, task);
    ASSERT_LE(worstRowError(chain, q, task, rows), 2e-8) << "seed " << seed;
    rows(3, chain.size() - 1) += 1e-5;
    EXPECT_GT(worstRowError(chain, q, task, rows), 1e-6) << "the check sees nothing";
  }
}

/// With one more joint that turns the tool about its pointing axis, the determinant is that of the whole pose.
TEST(TaskRows, DeterminantIsThatOfAJointMore) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    RandomModel random(seed);
    const SerialChain chain = random.chain(5);
    const VectorX q = random.configuration(5);
    const int axis = random.integer(0, 2);
    Matrix6X J;
    const Pose tip = geometricJacobian(chain, q, J);
    Matrix6 longer;
    longer.leftCols<5>() = J;
    longer.col(5) << Vector3::Zero(), tip.R.col(axis);
    const double expected = std::abs(longer.determinant());
    const double scale = 1e-13 * std::pow(1.0 + J.norm(), 5);
    EXPECT_NEAR(std::abs(taskJacobian(chain, q, Task::pointing(axis)).determinant()), expected, scale)
        << "seed " << seed;
    EXPECT_NEAR(std::abs(TaskDeterminant(chain, Task::pointing(axis))(q)), expected, scale) << "seed " << seed;
  }
}

TEST(TaskRows, PowerIsTheSameInJointsAndAtTheTool) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    RandomModel random(seed);
    const SerialChain chain = random.chain(5);
    const VectorX q = random.configuration(5);
    const Matrix3 R = forwardKinematics(chain, q).R;
    const VectorX rates = VectorX::Random(5);
    const Vector6 wrench = kPointing.spread(VectorX::Random(5), R);
    EXPECT_NEAR(wrench.tail<3>().dot(R.col(2)), 0.0, 1e-14) << "no moment about the free axis";
    EXPECT_NEAR(effortOf(chain, q, wrench).dot(rates), wrench.dot(tipTwist(chain, q, rates)), 1e-12);
    if (taskRank(taskJacobian(chain, q, kPointing)).rank < 5) continue;
    const double least = singularValues(taskJacobian(chain, q, kPointing)).minCoeff();
    const WrenchSolution back = wrenchOf(chain, q, effortOf(chain, q, wrench), kPointing);
    EXPECT_LE((back.wrench - wrench).norm(), 1e-12 / least) << "seed " << seed;
    const VelocitySolution velocity = solveVelocity(chain, q, tipTwist(chain, q, rates), kPointing);
    if (velocity.damping == 0.0) {
      EXPECT_LE((velocity.velocity - rates).norm(), 1e-12 / least) << "seed " << seed;
    }
  }
}

/// youBot's last joint turns about the tool's z axis: pointing that axis it is always singular, pointing the x axis
/// not.
TEST(TaskRows, AnArmThatTurnsAboutThePointingAxisIsAlwaysSingular) {
  const SerialChain youbot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "youbot_arm").chain;
  const VectorX q = (VectorX(5) << 0.4, -0.5, 0.9, 0.3, -0.2).finished();
  const SingularityAnalysis z = analyzeSingularity(youbot, q, Task::pointing(2));
  EXPECT_TRUE(z.singular);
  EXPECT_EQ(z.rank.rank, 4);
  EXPECT_NEAR(std::abs(z.rank.self_motions(0, 4)), 1.0, 1e-12);
  ASSERT_EQ(z.conditions.size(), 1U);
  EXPECT_EQ(z.conditions.front().name, "always");
  const SingularityAnalysis x = analyzeSingularity(youbot, q, Task::pointing(0));
  EXPECT_FALSE(x.singular);
  for (const SingularCondition& condition : x.conditions)
    std::printf("youbot, direction of x: %s, %s\n", condition.name.c_str(), condition.expression.c_str());
  EXPECT_GE(x.conditions.size(), 2U);
}

TEST(TaskRows, FormulaOfTheDeterminantIsTheNumber) {
  const SerialChain youbot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "youbot_arm").chain;
  for (int axis = 0; axis < 3; ++axis) {
    DerivationOptions options;
    options.quantities = {"determinant", "singularities"};
    options.check_configurations = 20;
    const Derivation derivation = deriveDocument(youbot, Task::pointing(axis), options);
    EXPECT_LE(derivation.worst_deviation, 1e-12);
    for (const std::string& factor : derivation.factors)
      std::printf("youbot, axis %d: factor %s\n", axis, factor.c_str());
    EXPECT_EQ(derivation.factors.size() == 1, axis == 2) << "zero, or a product";
  }
}

TEST(TaskRows, FiveJointsAreGivenTheDirectionThatTheyControl) {
  const SerialChain youbot = test::shippedRobot(SCREWLINE_SOURCE_DIR, "youbot_arm").chain;
  EXPECT_EQ(deriveTask(youbot), Task::pointing(0)) << "its last joint turns about z";
}

}  // namespace
}  // namespace screwline
