#include <cmath>

#include <gtest/gtest.h>

#include "model_random.h"
#include "screwline/kinematics/propagation.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/kinematics/statics.h"
#include "screwline/kinematics/task_selection.h"
#include "screwline/kinematics/velocity.h"
#include "screwline/spatial/screw.h"

namespace screwline {
namespace {

constexpr int kChains = 40;

/// The size that rounding and differences are relative to.
double scaleOf(const Matrix6X& J) {
  return std::max(1.0, J.cwiseAbs().maxCoeff());
}

/// Largest deviation of each method's Jacobian from J, over its scale; the numerical one is counted with its own
/// tolerance.
double disagreement(const SerialChain& chain, const VectorX& q, const Matrix6X& J) {
  double worst = 0.0;
  for (int method = 0; method < kJacobianMethodCount; ++method) {
    const double deviation =
        (jacobian(chain, q, static_cast<JacobianMethod>(method)) - J).cwiseAbs().maxCoeff() / scaleOf(J);
    worst = std::max(worst,
                     static_cast<JacobianMethod>(method) == JacobianMethod::kNumerical ? 1e-4 * deviation : deviation);
  }
  return worst;
}

/// Each seed gives chains of 1 to 8 axes, with and without mimic, at random, near-singular and singular configurations.
class KinematicsLaws : public testing::TestWithParam<unsigned> {
 protected:
  void SetUp() override { SCOPED_TRACE("seed " + std::to_string(GetParam())); }

  template <class Check>
  void forEach(bool mimic, Check check) {
    for (int k = 0; k < kChains; ++k) {
      const SerialChain chain = random_.chain(1 + k % 8, mimic);
      const Task task = deriveTask(chain);
      const VectorX q = random_.configuration(chain.size());
      SCOPED_TRACE("seed " + std::to_string(GetParam()) + ", chain " + std::to_string(k));
      check(chain, task, q);
      if (k % 4 != 0) continue;
      const SingularityAnalysis analysis = analyzeSingularity(chain, q, task);
      if (analysis.nearest.size() == 0) continue;
      SCOPED_TRACE("at and near a singular configuration");
      check(chain, task, analysis.nearest);
      check(chain, task, VectorX(analysis.nearest + 1e-6 * random_.configuration(chain.size())));
    }
  }

  RandomModel random_{GetParam()};
};

TEST_P(KinematicsLaws, MethodsAgree) {
  forEach(true, [](const SerialChain& chain, const Task&, const VectorX& q) {
    Matrix6X J;
    geometricJacobian(chain, q, J);
    EXPECT_LE(disagreement(chain, q, J), 1e-9);
  });
}

TEST_P(KinematicsLaws, ADeliberatelyWrongJacobianIsSeen) {
  forEach(false, [](const SerialChain& chain, const Task&, const VectorX& q) {
    Matrix6X J;
    geometricJacobian(chain, q, J);
    J(5 - static_cast<int>(chain.axes().back().prismatic) * 3, J.cols() - 1) += 1e-8 * scaleOf(J);
    EXPECT_GT(disagreement(chain, q, J), 1e-9);
  });
}

TEST_P(KinematicsLaws, ExponentialsGiveTheKernelsPose) {
  forEach(true, [](const SerialChain& chain, const Task&, const VectorX& q) {
    const Pose X = forwardKinematics(chain, q);
    EXPECT_TRUE(isApprox(X, forwardByExponentials(chain, q), 1e-11 * (1.0 + X.p.norm())));
  });
}

TEST_P(KinematicsLaws, RatesGiveTheDifferenceOfPoses) {
  forEach(true, [this](const SerialChain& chain, const Task&, const VectorX& q) {
    const VectorX qd = random_.configuration(chain.size());
    const double h = 1e-5;
    const Vector6 difference =
        poseDifference(forwardKinematics(chain, q + h * qd), forwardKinematics(chain, q - h * qd)) / (2.0 * h);
    const Vector6 V = tipTwist(chain, q, qd);
    EXPECT_LE((difference - V).norm(), 1e-5 * (1.0 + V.norm()));
  });
}

TEST_P(KinematicsLaws, PropagatedVelocityIsTheJacobians) {
  forEach(true, [this](const SerialChain& chain, const Task&, const VectorX& q) {
    const VectorX qd = random_.configuration(chain.size());
    const Vector6 V_T = tipTwist(chain, propagateVelocity(chain, q, qd).back());
    const Matrix3 R = forwardKinematics(chain, q).R;
    const Vector6 V = tipTwist(chain, q, qd);
    EXPECT_LE((R * V_T.head<3>() - V.head<3>()).norm(), 1e-10 * (1.0 + V.norm()));
    EXPECT_LE((R * V_T.tail<3>() - V.tail<3>()).norm(), 1e-10 * (1.0 + V.norm()));
  });
}

TEST_P(KinematicsLaws, AnotherFrameAndPointDifferByTheAdjoint) {
  forEach(true, [this](const SerialChain& chain, const Task&, const VectorX& q) {
    Matrix6X J;
    const Pose X_BT = geometricJacobian(chain, q, J);
    const Pose X_TP = random_.pose();  // A point P of the tip's body with its own axes.
    const Matrix6X moved = expressedIn(movedReference(J, X_BT.R * X_TP.p), (X_BT.R * X_TP.R).transpose());
    const Matrix6X expected = adjoint(X_TP.inverse()) * expressedIn(J, X_BT.R.transpose());
    EXPECT_LE((moved - expected).cwiseAbs().maxCoeff(), 1e-11 * scaleOf(J));
  });
}

TEST_P(KinematicsLaws, VirtualWorkOfEffortsAndWrenchIsTheSame) {
  forEach(true, [this](const SerialChain& chain, const Task&, const VectorX& q) {
    const VectorX qd = random_.configuration(chain.size());
    const Vector6 F = random_.configuration(6);
    const VectorX effort = effortOf(chain, q, F);
    const Vector6 V = tipTwist(chain, q, qd);
    EXPECT_NEAR(effort.dot(qd), F.dot(V), 1e-11 * (1.0 + F.norm() * V.norm()));

    const Matrix3 R_TB = forwardKinematics(chain, q).R.transpose();
    Vector6 F_T;
    F_T << R_TB * F.head<3>(), R_TB * F.tail<3>();
    EXPECT_LE((effortsOf(chain, propagateForce(chain, q, F_T)) - effort).norm(), 1e-10 * (1.0 + effort.norm()));
  });
}

TEST_P(KinematicsLaws, RankSplitsTwistsAndRates) {
  forEach(true, [](const SerialChain& chain, const Task& task, const VectorX& q) {
    Matrix6X J;
    geometricJacobian(chain, q, J);
    const MatrixX A = taskJacobian(chain, q, task);
    const TaskRank rank = taskRank(A, jacobianNoise(J));
    ASSERT_EQ(rank.lost_directions.rows(), A.rows() - rank.rank);
    ASSERT_EQ(rank.self_motions.rows(), A.cols() - rank.rank);
    const double noise = 1e-8 * scaleOf(J);
    const auto isOrthonormal = [](const MatrixX& rows) {
      return (rows * rows.transpose() - MatrixX::Identity(rows.rows(), rows.rows())).norm() < 1e-12;
    };
    EXPECT_TRUE(isOrthonormal(rank.lost_directions));
    EXPECT_TRUE(isOrthonormal(rank.self_motions));
    EXPECT_LE((rank.lost_directions * A).norm(), noise);
    EXPECT_LE((A * rank.self_motions.transpose()).norm(), noise);
    EXPECT_TRUE((rank.singular_values.array() >= 0.0).all());
  });
}

TEST_P(KinematicsLaws, RatesOfATwistThatRatesMadeAreExact) {
  forEach(true, [this](const SerialChain& chain, const Task& task, const VectorX& q) {
    const VectorX qd = random_.configuration(chain.size());
    const Vector6 V = tipTwist(chain, q, qd);
    const VelocitySolution solution = solveVelocity(chain, q, V, task);
    EXPECT_TRUE(solution.exact) << solution.damping << " " << solution.residual;
    EXPECT_LE(solution.velocity.norm(), qd.norm() * (1.0 + 1e-6)) << "of least norm";
  });
}

TEST_P(KinematicsLaws, RatesOfAnyTwistAreBounded) {
  forEach(true, [this](const SerialChain& chain, const Task& task, const VectorX& q) {
    const Vector6 V = random_.configuration(6);
    const VelocitySolution solution = solveVelocity(chain, q, V, task);
    Matrix6X J;
    geometricJacobian(chain, q, J);
    const double largest = taskRank(taskJacobian(chain, q, task)).singular_values[0];
    ASSERT_TRUE(solution.velocity.allFinite());
    EXPECT_LE(solution.velocity.norm(), 2.5 * V.norm() / (kDampingThreshold * largest));
    EXPECT_LE(solution.residual, V.norm() * (1.0 + 1e-12));
    EXPECT_LE((solution.twist - J * solution.velocity).norm(), 1e-12 * (1.0 + solution.twist.norm()));
  });
}

TEST_P(KinematicsLaws, WrenchesOfEffortsHoldThem) {
  forEach(true, [this](const SerialChain& chain, const Task& task, const VectorX& q) {
    const Matrix3 R_BT = forwardKinematics(chain, q).R;
    VectorX rows(task.size());
    for (int i = 0; i < task.size(); ++i) rows[i] = random_.uniform(-1.0, 1.0);
    const Vector6 F = task.spread(rows, R_BT);
    const WrenchSolution solution = wrenchOf(chain, q, effortOf(chain, q, F), task);
    EXPECT_TRUE(solution.exact) << solution.residual;
    const Vector6 within = task.spread(task.select(solution.wrench, R_BT), R_BT);
    EXPECT_LE((solution.wrench - within).norm(), task.usesToolAxes() ? 1e-12 * (1.0 + within.norm()) : 0.0);
    const MatrixX supported = supportedWrenches(chain, q);
    for (Eigen::Index k = 0; k < supported.rows(); ++k) {
      EXPECT_LE(effortOf(chain, q, supported.row(k).transpose()).norm(), 1e-8 * (1.0 + effortOf(chain, q, F).norm()));
    }
  });
}

TEST_P(KinematicsLaws, NearestSingularityIsSingularAndItsDistanceHolds) {
  for (int k = 0; k < kChains; ++k) {
    const SerialChain chain = random_.chain(2 + k % 6, k % 3 == 0);
    const Task task = deriveTask(chain);
    const VectorX q = chain.clamped(random_.configuration(chain.size()));
    SCOPED_TRACE("seed " + std::to_string(GetParam()) + ", chain " + std::to_string(k));
    const SingularityAnalysis analysis = analyzeSingularity(chain, q, task);
    EXPECT_FALSE(analysis.nearest_note.empty());
    EXPECT_TRUE(std::isfinite(analysis.condition_number));
    if (analysis.nearest.size() == 0) {
      EXPECT_TRUE(std::isinf(analysis.distance));
      continue;
    }
    EXPECT_DOUBLE_EQ(analysis.distance, (analysis.nearest - q).norm());
    EXPECT_TRUE(analyzeSingularity(chain, analysis.nearest, task).singular);
    EXPECT_EQ(analysis.nearest_within_limits, analysis.nearest == chain.clamped(analysis.nearest));
  }
}

/// Every sign change of the determinant along random lines must be a zero of some factor: the factors are complete.
TEST_P(KinematicsLaws, FactorsCoverEverySingularity) {
  int crossings = 0;
  for (int k = 0; k < kChains; ++k) {
    const SerialChain chain = random_.chain(2 + k % 5);
    const Task task = deriveTask(chain);
    if (task.size() != chain.size()) continue;
    SCOPED_TRACE("seed " + std::to_string(GetParam()) + ", chain " + std::to_string(k));
    const TaskDeterminant determinant(chain, task);
    const std::vector<SingularityFactor> factors = factorsOf(chain, task);
    for (int line = 0; line < 5; ++line) {
      VectorX low = random_.configuration(chain.size());
      VectorX high = random_.configuration(chain.size());
      const double f_low = determinant(low);
      if (f_low * determinant(high) >= 0.0) continue;
      for (int i = 0; i < 60; ++i) {
        const VectorX middle = 0.5 * (low + high);
        (determinant(middle) * f_low > 0.0 ? low : high) = middle;
      }
      ++crossings;
      const SingularityAnalysis analysis = analyzeSingularity(chain, high, task, factors);
      double smallest = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < factors.size(); ++i) {
        smallest = std::min(smallest, std::abs(analysis.conditions[i].value) / factors[i].scale);
      }
      EXPECT_LE(smallest, 1e-7);
    }
  }
  EXPECT_GT(crossings, 20);
}

INSTANTIATE_TEST_SUITE_P(Seeds, KinematicsLaws, testing::Values(1u, 2u, 3u, 4u, 5u));

}  // namespace
}  // namespace screwline
