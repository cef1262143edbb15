#include <cmath>

#include <gtest/gtest.h>

#include "golden.h"
#include "kinematics_arms.h"
#include "screwline/kinematics/propagation.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/kinematics/statics.h"
#include "screwline/kinematics/task_selection.h"
#include "screwline/kinematics/velocity.h"

namespace screwline {
namespace {

const Task kPlane = Task::fromRows({0, 1});

VectorX pair(double first, double second) {
  VectorX v(2);
  v << first, second;
  return v;
}

Vector6 twistOf(double vx, double vy) {
  Vector6 V = Vector6::Zero();
  V[0] = vx;
  V[1] = vy;
  return V;
}

TEST(Velocity, IsExactAwayFromSingularities) {
  const SerialChain arm = arms::planarArm(2);
  const VelocitySolution solution = solveVelocity(arm, pair(0.2, 1.1), twistOf(0.3, -0.4), kPlane);
  EXPECT_TRUE(solution.exact);
  EXPECT_EQ(solution.damping, 0.0);
  EXPECT_NEAR(solution.twist[0], 0.3, 1e-12);
  EXPECT_NEAR(solution.twist[1], -0.4, 1e-12);
}

TEST(Velocity, AtASingularityGivesExactlyWhatTheArmCanGive) {
  const SerialChain arm = arms::planarArm(2);
  const VelocitySolution across = solveVelocity(arm, pair(0.0, 0.0), twistOf(0.0, 0.5), kPlane);
  EXPECT_TRUE(across.exact);
  EXPECT_EQ(across.damping, 0.0);
  EXPECT_NEAR(across.twist[1], 0.5, 1e-12);
  // Of least norm: rates in proportion to the arms' lengths.
  EXPECT_NEAR(across.velocity[0], 2.0 * across.velocity[1], 1e-12);
}

TEST(Velocity, AtASingularityIsDampedWhereTheArmCannotFollow) {
  const SerialChain arm = arms::planarArm(2);
  const VelocitySolution along = solveVelocity(arm, pair(0.0, 0.0), twistOf(0.5, 0.2), kPlane);
  EXPECT_FALSE(along.exact);
  EXPECT_GT(along.damping, 0.0);
  EXPECT_NEAR(along.residual, 0.5, 1e-9);
  EXPECT_NEAR(along.twist[1], 0.2, 1e-9);
}

TEST(Velocity, NearASingularityGivesModerateRatesExactly) {
  const SerialChain arm = arms::planarArm(2);
  for (double elbow : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    const VectorX rates = pair(0.7, -0.9);
    const VectorX q = pair(0.3, elbow);
    const VelocitySolution solution = solveVelocity(arm, q, tipTwist(arm, q, rates), kPlane);
    EXPECT_TRUE(solution.exact) << elbow;
    EXPECT_LE((solution.velocity - rates).norm(), 1e-6) << elbow;
  }
}

TEST(Velocity, StaysBoundedAndContinuousThroughASingularity) {
  const SerialChain arm = arms::planarArm(2);
  const Vector6 twist = twistOf(0.5, 0.2);
  double largest_rate = 0.0;
  double largest_step = 0.0;
  VectorX previous;
  for (int k = -20000; k <= 20000; ++k) {
    const VelocitySolution solution = solveVelocity(arm, pair(0.0, 5e-7 * k), twist, kPlane);
    ASSERT_TRUE(solution.velocity.allFinite());
    largest_rate = std::max(largest_rate, solution.velocity.norm());
    if (previous.size() > 0) largest_step = std::max(largest_step, (solution.velocity - previous).norm());
    previous = solution.velocity;
  }
  // The threshold's own rate: twist / (threshold * largest singular value), about 0.54 / (1e-3 * 1.2).
  EXPECT_LE(largest_rate, 600.0);
  EXPECT_GT(largest_rate, 100.0);
  EXPECT_LE(largest_step, 1.0);
}

TEST(Velocity, OfMoreJointsThanRowsIsOfLeastNorm) {
  const SerialChain arm = arms::planarArm(4);
  VectorX q(4);
  q << 0.1, 0.5, -0.7, 0.9;
  const VelocitySolution solution = solveVelocity(arm, q, twistOf(0.2, 0.1), kPlane);
  EXPECT_TRUE(solution.exact);
  Matrix6X J;
  geometricJacobian(arm, q, J);
  const MatrixX self_motions = taskRank(taskJacobian(kPlane, J)).self_motions;
  ASSERT_EQ(self_motions.rows(), 2);
  EXPECT_LE((self_motions * solution.velocity).norm(), 1e-12);
}

TEST(Velocity, OfMoreRowsThanJointsIsLeastSquares) {
  const SerialChain arm = arms::planarArm(2);
  const VectorX q = pair(0.2, 1.1);
  const Task task = Task::fromRows({0, 1, 5});
  Vector6 wanted = twistOf(0.3, -0.4);
  wanted[5] = 2.0;
  const VelocitySolution solution = solveVelocity(arm, q, wanted, task);
  EXPECT_FALSE(solution.exact);
  EXPECT_EQ(solution.damping, 0.0);
  Matrix6X J;
  geometricJacobian(arm, q, J);
  const MatrixX A = taskJacobian(task, J);
  EXPECT_LE((A.transpose() * (task.select(wanted) - A * solution.velocity)).norm(), 1e-12) << "normal equations";
  EXPECT_NEAR(solution.residual, (task.select(wanted) - A * solution.velocity).norm(), 1e-12);
}

TEST(Velocity, OfATaskThatNothingMovesIsZero) {
  const SerialChain arm = arms::planarArm(2);
  Vector6 up = Vector6::Zero();
  up[2] = 1.0;
  const VelocitySolution solution = solveVelocity(arm, pair(0.2, 1.1), up, Task::fromRows({2}));
  EXPECT_EQ(solution.velocity.norm(), 0.0);
  EXPECT_FALSE(solution.exact);
  EXPECT_DOUBLE_EQ(solution.residual, 1.0);
}

TEST(Statics, SignIsOfTheToolOnTheEnvironment) {
  // The tool pushes the environment along +y at 1 m from the axis: the joint must drive in its positive sense.
  const SerialChain arm = arms::planarArm(1, 1.0);
  Vector6 F = Vector6::Zero();
  F[1] = 2.0;
  const VectorX effort = effortOf(arm, VectorX::Zero(1), F);
  EXPECT_NEAR(effort[0], 2.0, 1e-15);
}

TEST(Statics, OfTheOrientingRobotIsTheMomentOfTheStudy) {
  const golden::File& file = *golden::load("seed004_03_orienting_3r");
  VectorX q(3);
  q << 0.0, kPi / 2.0, 0.4;
  VectorX effort(3);
  effort << 20.0, 20.0, -10.0;
  const WrenchSolution solution = wrenchOf(file.chain, q, effort, file.task);
  EXPECT_TRUE(solution.exact);
  EXPECT_EQ(solution.wrench.head<3>().norm(), 0.0);
  // Components in modified-DH frame 2: (0, 20 sqrt3, 20).
  const Matrix3 R = file.table.modifiedDh().link(1, false, q[0]).R * file.table.modifiedDh().link(2, false, 0.0).R;
  const Vector3 n = R.transpose() * solution.wrench.tail<3>();
  EXPECT_NEAR(n.norm(), 40.0, 1e-9);
  EXPECT_NEAR(std::abs(n.z()), 20.0, 1e-9);
}

TEST(Statics, EffortsThatNoWrenchOfTheTaskHoldsLeaveAResidual) {
  const SerialChain arm = arms::planarArm(2);
  const WrenchSolution solution = wrenchOf(arm, pair(0.0, 0.0), pair(1.0, 1.0), kPlane);
  EXPECT_FALSE(solution.exact);
  // Straight arm: only efforts in the ratio 2 : 1 come from forces; the rest is (1, -2) (1, -2) . (1, 1) / 5.
  EXPECT_NEAR(solution.residual, 1.0 / std::sqrt(5.0), 1e-12);
}

TEST(Statics, ASingularArmCarriesAForceAlongItself) {
  const SerialChain arm = arms::planarArm(2);
  const MatrixX supported = supportedWrenches(arm, pair(0.0, 0.0));
  ASSERT_EQ(supported.rows(), 4);
  const VectorX along = Vector6::Unit(0);
  EXPECT_NEAR((supported * along).norm(), 1.0, 1e-12);
}

TEST(TaskSelection, GivesSixRowsToSixJoints) {
  EXPECT_EQ(deriveTask(arms::planarArm(6)).size(), 6);
  EXPECT_EQ(deriveTask(arms::anthropomorphicArm()).size(), 6);
}

TEST(TaskSelection, GivesThePlaneOfAPlanarArm) {
  const Matrix3 tilt = rotationAbout(arms::kX, -kPi / 2.0);
  std::vector<Axis> axes = arms::planarArm(3).axes();
  for (Axis& axis : axes) {
    axis.direction = tilt * axis.direction;
    axis.point = tilt * axis.point;
  }
  const SerialChain upright = arms::chainOf(axes, tilt * Vector3(1.5, 0.0, 0.0));
  EXPECT_EQ(deriveTask(upright).names(), std::vector<std::string>({"x", "z", "ry"}));
}

TEST(TaskSelection, GivesOneRowToOneJoint) {
  EXPECT_EQ(deriveTask(arms::chainOf({arms::sliding(arms::kZ)}, Vector3::Zero())).names(),
            std::vector<std::string>({"z"}));
  EXPECT_EQ(deriveTask(arms::chainOf({arms::turning(arms::kX, Vector3::Zero())}, Vector3::Zero())).names(),
            std::vector<std::string>({"rx"}));
}

}  // namespace
}  // namespace screwline
