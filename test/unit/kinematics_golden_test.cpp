#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "golden.h"
#include "screwline/kinematics/propagation.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/kinematics/statics.h"
#include "screwline/kinematics/task_selection.h"
#include "screwline/kinematics/velocity.h"

namespace screwline {
namespace {

constexpr double kTolerance = 1e-9;

/// Largest difference of two matrices; infinite where their sizes differ.
double deviation(const MatrixX& a, const MatrixX& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return std::numeric_limits<double>::infinity();
  return a.size() == 0 ? 0.0 : (a - b).cwiseAbs().maxCoeff();
}

/// How far two sets of orthonormal rows are from spanning the same space.
double spanDeviation(const MatrixX& a, const MatrixX& b) {
  if (a.rows() == 0 && b.rows() == 0) return 0.0;
  if (a.rows() != b.rows() || a.cols() != b.cols()) return std::numeric_limits<double>::infinity();
  return deviation(a.transpose() * a, b.transpose() * b);
}

Vector6 inTool(const golden::Case& c, const Vector6& v) {
  Vector6 turned;
  turned << c.pose.R.transpose() * v.head<3>(), c.pose.R.transpose() * v.tail<3>();
  return turned;
}

Vector6 inBase(const golden::Case& c, const Vector6& v) {
  Vector6 turned;
  turned << c.pose.R * v.head<3>(), c.pose.R * v.tail<3>();
  return turned;
}

class KinematicsGolden : public testing::TestWithParam<std::string> {
 protected:
  /// Both chains of the file, at every case.
  void forEach(const std::function<void(const SerialChain&, const golden::Case&)>& check) const {
    for (const SerialChain* chain : {&file_.chain, &file_.table}) {
      for (const golden::Case& c : file_.cases) {
        SCOPED_TRACE(file_.name + ", " + c.id + (chain == &file_.table ? ", from its table" : ", from its screw axes"));
        check(*chain, c);
      }
    }
  }

  const golden::File& file_ = *golden::load(GetParam());
};

TEST_P(KinematicsGolden, Pose) {
  forEach([](const SerialChain& chain, const golden::Case& c) {
    const Pose X = forwardKinematics(chain, c.q);
    EXPECT_LE(deviation(X.R, c.pose.R), kTolerance);
    EXPECT_LE(deviation(X.p, c.pose.p), kTolerance);
  });
}

TEST_P(KinematicsGolden, JacobianInTheBaseByEveryMethod) {
  forEach([](const SerialChain& chain, const golden::Case& c) {
    for (int method = 0; method < kJacobianMethodCount; ++method) {
      EXPECT_LE(deviation(jacobian(chain, c.q, static_cast<JacobianMethod>(method)), c.jacobian_base), kTolerance)
          << method;
    }
  });
}

TEST_P(KinematicsGolden, JacobianInTheTool) {
  forEach([](const SerialChain& chain, const golden::Case& c) {
    Matrix6X J;
    const Pose X_BT = geometricJacobian(chain, c.q, J);
    EXPECT_LE(deviation(expressedIn(J, X_BT.R.transpose()), c.jacobian_tool), kTolerance);
  });
}

TEST_P(KinematicsGolden, CheckerSeesOneWrongColumn) {
  const golden::Case& c = file_.cases.front();
  Matrix6X J;
  geometricJacobian(file_.chain, c.q, J);
  J.col(J.cols() - 1) *= 1.0 + 1e-8;
  EXPECT_GT(deviation(J, c.jacobian_base), kTolerance);
  EXPECT_TRUE(std::isinf(deviation(J.leftCols(1), c.jacobian_base)));
}

TEST_P(KinematicsGolden, DeterminantWithItsSign) {
  forEach([this](const SerialChain& chain, const golden::Case& c) {
    const SingularityAnalysis analysis = analyzeSingularity(chain, c.q, file_.task);
    EXPECT_NEAR(analysis.determinant, c.det_task, kTolerance);
    EXPECT_NEAR(analysis.manipulability, c.manipulability_task, kTolerance);
  });
}

TEST_P(KinematicsGolden, Ranks) {
  forEach([this](const SerialChain& chain, const golden::Case& c) {
    Matrix6X J;
    geometricJacobian(chain, c.q, J);
    EXPECT_EQ(taskRank(J, jacobianNoise(J)).rank, c.rank_full);
    const SingularityAnalysis analysis = analyzeSingularity(chain, c.q, file_.task);
    EXPECT_EQ(analysis.rank.rank, c.rank_task);
    EXPECT_EQ(analysis.singular, c.rank_task < chain.size());
    EXPECT_TRUE(std::isfinite(analysis.condition_number));
    EXPECT_EQ(analysis.condition_number == kMaxCondition, analysis.singular);
  });
}

TEST_P(KinematicsGolden, SingularValues) {
  forEach([this](const SerialChain& chain, const golden::Case& c) {
    Matrix6X J;
    geometricJacobian(chain, c.q, J);
    EXPECT_LE(deviation(taskRank(J).singular_values, c.singular_values_full), kTolerance);
    EXPECT_LE(deviation(taskRank(taskJacobian(file_.task, J)).singular_values, c.singular_values_task), kTolerance);
  });
}

TEST_P(KinematicsGolden, LostDirectionsAndSelfMotions) {
  forEach([this](const SerialChain& chain, const golden::Case& c) {
    const TaskRank rank = analyzeSingularity(chain, c.q, file_.task).rank;
    EXPECT_LE(spanDeviation(rank.lost_directions, c.lost_task_directions), kTolerance);
    EXPECT_LE(spanDeviation(rank.self_motions, c.null_joint_rates), kTolerance);
  });
}

TEST_P(KinematicsGolden, ConditionsAgreeWithTheRank) {
  forEach([this](const SerialChain& chain, const golden::Case& c) {
    const SingularityAnalysis analysis = analyzeSingularity(chain, c.q, file_.task);
    ASSERT_FALSE(analysis.conditions.empty());
    for (const SingularCondition& condition : analysis.conditions) {
      EXPECT_TRUE(std::isfinite(condition.value));
      EXPECT_NE(condition.name, "determinant") << "every arm of the golden files has explicit conditions";
      EXPECT_EQ(condition.active, analysis.singular && std::abs(condition.value) < 1e-9) << condition.expression;
    }
    const bool any = std::any_of(analysis.conditions.begin(), analysis.conditions.end(),
                                 [](const SingularCondition& condition) { return condition.active; });
    EXPECT_EQ(any, c.rank_task < chain.size());
  });
}

TEST_P(KinematicsGolden, TwistOfJointRates) {
  forEach([](const SerialChain& chain, const golden::Case& c) {
    const Vector6 V = tipTwist(chain, c.q, c.qd);
    EXPECT_LE(deviation(V, c.twist_base), kTolerance);
    EXPECT_LE(deviation(inTool(c, V), c.twist_tool), kTolerance);
    EXPECT_LE(deviation(tipTwist(chain, propagateVelocity(chain, c.q, c.qd).back()), c.twist_tool), kTolerance);
  });
}

TEST_P(KinematicsGolden, RatesOfATwistThatTheArmCanGive) {
  forEach([this](const SerialChain& chain, const golden::Case& c) {
    const VelocitySolution solution = solveVelocity(chain, c.q, c.twist_base, file_.task);
    EXPECT_TRUE(solution.exact);
    EXPECT_EQ(solution.damping, 0.0);
    EXPECT_LE(solution.residual, kTolerance);
    EXPECT_LE(deviation(file_.task.select(solution.twist), file_.task.select(c.twist_base)), kTolerance);
    EXPECT_LE(solution.velocity.norm(), c.qd.norm() + kTolerance) << "of least norm";
    if (c.null_joint_rates.size() > 0) {
      EXPECT_LE((c.null_joint_rates * solution.velocity).norm(), kTolerance);
    } else {
      EXPECT_LE(deviation(solution.velocity, c.qd), kTolerance);
    }
  });
}

TEST_P(KinematicsGolden, VelocityOfEveryLink) {
  for (const golden::Case& c : file_.cases) {
    SCOPED_TRACE(c.id);
    const std::vector<LinkVelocity> links = propagateVelocity(file_.table, c.q, c.qd);
    ASSERT_EQ(static_cast<Eigen::Index>(links.size()), c.link_w.rows());
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Eigen::Index row = static_cast<Eigen::Index>(i);
      EXPECT_LE(deviation(links[i].w, c.link_w.row(row).transpose()), kTolerance) << "link " << i + 1;
      EXPECT_LE(deviation(links[i].v, c.link_v.row(row).transpose()), kTolerance) << "link " << i + 1;
    }
  }
}

TEST_P(KinematicsGolden, ForceAndMomentOfEveryLink) {
  for (const golden::Case& c : file_.cases) {
    SCOPED_TRACE(c.id);
    const std::vector<LinkWrench> links = propagateForce(file_.table, c.q, c.wrench);
    ASSERT_EQ(static_cast<Eigen::Index>(links.size()), c.link_f.rows());
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Eigen::Index row = static_cast<Eigen::Index>(i);
      EXPECT_LE(deviation(links[i].f, c.link_f.row(row).transpose()), kTolerance) << "link " << i + 1;
      EXPECT_LE(deviation(links[i].n, c.link_n.row(row).transpose()), kTolerance) << "link " << i + 1;
    }
  }
}

TEST_P(KinematicsGolden, EffortsInBothFrames) {
  forEach([](const SerialChain& chain, const golden::Case& c) {
    EXPECT_LE(deviation(effortOf(chain, c.q, c.wrench), c.tau_if_wrench_in_base), kTolerance);
    EXPECT_LE(deviation(effortOf(chain, c.q, inBase(c, c.wrench)), c.tau_if_wrench_in_tool), kTolerance);
    EXPECT_LE(deviation(effortsOf(chain, propagateForce(chain, c.q, c.wrench)), c.tau_if_wrench_in_tool), kTolerance);
  });
}

TEST_P(KinematicsGolden, WrenchOfEfforts) {
  forEach([this](const SerialChain& chain, const golden::Case& c) {
    Vector6 F = Vector6::Zero();
    for (int i = 0; i < file_.task.size(); ++i) F[file_.task.row(i)] = c.wrench[file_.task.row(i)];
    const VectorX effort = effortOf(chain, c.q, F);
    const WrenchSolution solution = wrenchOf(chain, c.q, effort, file_.task);
    EXPECT_TRUE(solution.exact);
    EXPECT_LE(deviation(effortOf(chain, c.q, solution.wrench), effort), kTolerance);
    if (c.rank_task == chain.size()) {
      EXPECT_LE(deviation(solution.wrench, F), 1e-8);
    }
    const MatrixX supported = supportedWrenches(chain, c.q);
    ASSERT_EQ(supported.rows(), 6 - c.rank_full);
    EXPECT_LE(deviation(supported * supported.transpose(), MatrixX::Identity(supported.rows(), supported.rows())),
              kTolerance);
    EXPECT_LE(deviation(supported * c.jacobian_base, MatrixX::Zero(supported.rows(), chain.size())), kTolerance);
  });
}

TEST_P(KinematicsGolden, TaskIsDerived) {
  EXPECT_TRUE(deriveTask(file_.chain) == file_.task);
  EXPECT_TRUE(deriveTask(file_.table) == file_.task);
}

std::string fileName(const testing::TestParamInfo<std::string>& info) {
  return info.param;
}

INSTANTIATE_TEST_SUITE_P(Files, KinematicsGolden, testing::ValuesIn(golden::names()), fileName);

TEST(Golden, AllFilesAreThere) {
  EXPECT_EQ(golden::names().size(), 24u);
}

TEST(Golden, EvaluatesExpressions) {
  const std::map<std::string, double> symbols = {{"L1", 0.7}, {"theta2", 0.25}};
  EXPECT_DOUBLE_EQ(golden::evaluate("-pi/2 + theta2", symbols), 0.25 - kPi / 2.0);
  EXPECT_DOUBLE_EQ(golden::evaluate("-2*(L1 - 1)**2/3", symbols), -2.0 * 0.09 / 3.0);
  EXPECT_DOUBLE_EQ(golden::evaluate("sqrt(3)/2 - .5", symbols), std::sqrt(3.0) / 2.0 - 0.5);
  EXPECT_THROW(golden::evaluate("L2", symbols), std::runtime_error);
  EXPECT_THROW(golden::evaluate("L1 +", symbols), std::runtime_error);
  EXPECT_THROW(golden::evaluate("L1 L1", symbols), std::runtime_error);
}

}  // namespace
}  // namespace screwline
