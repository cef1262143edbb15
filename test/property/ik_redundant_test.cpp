#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <iostream>

#include "redundant_arms.h"
#include "screwline/ik/redundant/self_motion_solver.h"
#include "screwline/ik/task_error.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/singularity.h"

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261122;
constexpr int kIiwa = test::RedundantArmMaker::kClasses;
constexpr int kPanda = kIiwa + 1;

double wrappedDistance(const SerialChain& chain, const VectorX& a, const VectorX& b) {
  VectorX d = b - a;
  for (int i = 0; i < d.size(); ++i) {
    if (chain.joint(i).isRevolute()) d[i] = std::remainder(d[i], kTwoPi);
  }
  return d.norm();
}

double poseError(const SerialChain& chain, const Pose& target, const VectorX& q) {
  return taskError(Task(), target, forwardByExponentials(chain, q)).norm();
}

bool isWithin(const SerialChain& chain, const VectorX& q, double band) {
  for (int i = 0; i < q.size(); ++i) {
    const JointLimits& limits = chain.joint(i).limits;
    double value = q[i];
    if (chain.joint(i).isRevolute() && std::isfinite(limits.lower)) {
      const double center = 0.5 * (limits.lower + limits.upper);
      value = center + std::remainder(value - center, kTwoPi);
    }
    if (value < limits.lower - band || value > limits.upper + band) return false;
  }
  return true;
}

Vector7 cubic(const SelfMotionNode& a, const SelfMotionNode& b, double s) {
  const double r = 1.0 - s;
  return r * r * (1.0 + 2.0 * s) * a.q + s * s * (1.0 + 2.0 * r) * b.q +
         (b.arc - a.arc) * s * r * (r * a.tangent - s * b.tangent);
}

/// Distance to the curve near a point on it: the point is brought to the pose by Newton steps, and moved along the
/// tangent towards q.
double exactDistance(const SerialChain& chain, const Pose& target, VectorX point, const VectorX& q) {
  Matrix6X J(6, 7);
  VectorX off;
  for (int k = 0; k < 8; ++k) {
    for (int step = 0; step < 3; ++step) {
      const TaskError error = taskError(Task(), target, geometricJacobian(chain, point, J));
      point += J.transpose() * (J * J.transpose()).ldlt().solve(error.twist);
    }
    off = q - point;
    for (int i = 0; i < 7; ++i) {
      if (chain.joint(i).isRevolute()) off[i] = std::remainder(off[i], kTwoPi);
    }
    const VectorX tangent = taskRank(MatrixX(J)).self_motions.row(0).transpose();
    point += tangent * tangent.dot(off);
  }
  return off.norm();
}

/// Distance to the stretch between two nodes, independent of the solver.
double distanceToSegment(const SerialChain& chain, const Pose& target, const SelfMotionNode& a, const SelfMotionNode& b,
                         const VectorX& q) {
  double least = 1e9;
  double best = 0.0;
  for (int i = 0; i <= 8; ++i) {
    const double d = wrappedDistance(chain, cubic(a, b, i / 8.0), q);
    if (d < least) best = i / 8.0;
    least = std::min(least, d);
  }
  for (double h = 0.06; h > 1e-7; h *= 0.5) {
    for (double s : {best - h, best + h}) {
      const double d = wrappedDistance(chain, cubic(a, b, std::min(1.0, std::max(0.0, s))), q);
      if (d >= least) continue;
      least = d;
      best = std::min(1.0, std::max(0.0, s));
    }
  }
  return least < 5e-3 ? exactDistance(chain, target, cubic(a, b, best), q) : least;
}

double distanceToIntervals(const SerialChain& chain, const Pose& target, const SelfMotionSet& set, const VectorX& q) {
  double least = 1e9;
  for (const SelfMotionCurve& curve : set.curves) {
    for (const SelfMotionInterval& interval : curve.intervals) {
      for (int i = interval.first; i <= interval.last; ++i) {
        const SelfMotionNode a = nodeAt(curve, i);
        const double near = wrappedDistance(chain, a.q, q);
        least = std::min(least, near);
        if (i == interval.last) break;
        const SelfMotionNode b = nodeAt(curve, i + 1);
        if (near < 2.0 * (b.arc - a.arc) + 0.1) least = std::min(least, distanceToSegment(chain, target, a, b, q));
      }
    }
  }
  return least;
}

class RedundantLaws : public testing::TestWithParam<int> {
 protected:
  SerialChain make(bool limited) {
    if (GetParam() == kIiwa) return test::iiwa14();
    if (GetParam() == kPanda) return test::panda();
    return maker_.makeArm(GetParam(), limited);
  }
  test::RedundantArmMaker maker_{kSeed + static_cast<unsigned>(GetParam())};
};

TEST_P(RedundantLaws, EveryBranchAtOneValueReachesThePose) {
  for (int trial = 0; trial < 20; ++trial) {
    const SerialChain chain = make(false);
    const std::optional<RedundantSolver> solver = RedundantSolver::compile(chain);
    ASSERT_TRUE(solver.has_value());
    const VectorX q = test::randomWithin(maker_, chain);
    const Pose target = forwardKinematics(chain, q);
    RedundantSolutions solutions;
    solver->solveAt(target, q[solver->parameterJoint()], Vector7::Zero(), solutions);
    double nearest = 1e9;
    for (const RedundantSolution& solution : solutions) {
      EXPECT_LE(poseError(chain, target, solution.q), 1e-8);
      nearest = std::min(nearest, wrappedDistance(chain, solution.q, q));
    }
    EXPECT_LE(nearest, 1e-6);
  }
}

TEST_P(RedundantLaws, TheGeneratingConfigurationLiesOnACurveAndEveryNodeReachesThePose) {
  int nodes = 0;
  double seconds = 0.0;
  for (int trial = 0; trial < 40; ++trial) {
    const SerialChain chain = make(true);
    const std::optional<SelfMotionSolver> solver = SelfMotionSolver::compile(chain);
    ASSERT_TRUE(solver);
    const VectorX q = test::randomWithin(maker_, chain);
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", trial " + std::to_string(trial));
    SelfMotionQuestion question;
    question.target = forwardKinematics(chain, q);
    const auto start = std::chrono::steady_clock::now();
    const SelfMotionSet set = solver->trace(question);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_TRUE(set.complete) << set.note;
    EXPECT_LE(distanceToIntervals(chain, question.target, set, q), 1e-8) << q.transpose();
    for (const SelfMotionCurve& curve : set.curves) {
      nodes += static_cast<int>(curve.nodes.size());
      for (const SelfMotionNode& node : curve.nodes) {
        ASSERT_TRUE(node.q.allFinite() && node.tangent.allFinite());
        ASSERT_LE(poseError(chain, question.target, node.q), 1e-9);
      }
      for (const SelfMotionInterval& interval : curve.intervals) {
        for (int i = interval.first; i <= interval.last; ++i) EXPECT_TRUE(isWithin(chain, nodeAt(curve, i).q, 1e-9));
      }
    }
  }
  std::cout << "mean nodes " << nodes / 40 << ", mean time of trace " << seconds / 40 * 1e3 << " ms\n";
}

TEST_P(RedundantLaws, TheJacobianWithoutTheParameterIsSingularAtFolds) {
  for (int trial = 0; trial < 10; ++trial) {
    const SerialChain chain = make(false);
    const std::optional<SelfMotionSolver> solver = SelfMotionSolver::compile(chain);
    SelfMotionQuestion question;
    question.target = forwardKinematics(chain, test::randomWithin(maker_, chain));
    question.ignore_limits = true;
    for (const SelfMotionCurve& curve : solver->trace(question).curves) {
      for (int fold : curve.folds) {
        Matrix6X J(6, 7);
        geometricJacobian(chain, curve.nodes[static_cast<std::size_t>(fold)].q, J);
        Matrix6X six(6, 6);
        for (int i = 0, k = 0; i < 7; ++i) {
          if (i != solver->parameterJoint()) six.col(k++) = J.col(i);
        }
        EXPECT_LE(singularValues(six).minCoeff(), 1e-9);
      }
    }
  }
}

TEST_P(RedundantLaws, DenseSamplesOfTheParameterFindTheSameIntervals) {
  for (int trial = 0; trial < 2; ++trial) {
    const SerialChain chain = make(true);
    const std::optional<SelfMotionSolver> solver = SelfMotionSolver::compile(chain);
    const RedundantSolver& one_given = *solver->oneGiven();
    const int joint = solver->parameterJoint();
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", trial " + std::to_string(trial));
    SelfMotionQuestion question;
    question.target = forwardKinematics(chain, test::randomWithin(maker_, chain));
    const SelfMotionSet set = solver->trace(question);
    int wrong = 0;
    for (double value = -kPi; value < kPi; value += 1e-3) {
      RedundantSolutions solutions;
      one_given.solveAt(question.target, value, Vector7::Zero(), solutions);
      int sampled = 0;
      int bordering = 0;
      for (const RedundantSolution& solution : solutions) {
        sampled += isWithin(chain, solution.q, 0.0) ? 1 : 0;
        bordering += isWithin(chain, solution.q, 1e-6) != isWithin(chain, solution.q, -1e-6) ? 1 : 0;
      }
      int traced = 0;
      for (const SelfMotionCurve& curve : set.curves) {
        for (const SelfMotionInterval& interval : curve.intervals) {
          for (int i = interval.first; i < interval.last; ++i) {
            const double a = nodeAt(curve, i).q[joint];
            const double b = nodeAt(curve, i + 1).q[joint];
            if (chain.joint(joint).isRevolute()) {
              const double low = std::min(a, b);
              const double turned = value + kTwoPi * std::ceil((low - value) / kTwoPi);
              traced += turned < std::max(a, b) ? 1 : 0;
            } else {
              traced += value >= std::min(a, b) && value < std::max(a, b) ? 1 : 0;
            }
          }
        }
      }
      wrong += std::abs(sampled - traced) > bordering ? 1 : 0;
    }
    EXPECT_LE(wrong, 1);
  }
}

TEST_P(RedundantLaws, ContinuationByNullSpaceStaysOnTheSameCurve) {
  for (int trial = 0; trial < 5; ++trial) {
    const SerialChain chain = make(false);
    const std::optional<SelfMotionSolver> solver = SelfMotionSolver::compile(chain);
    VectorX q = test::randomWithin(maker_, chain);
    SelfMotionQuestion question;
    question.target = forwardKinematics(chain, q);
    question.seed = q;
    question.ignore_limits = true;
    const SelfMotionSet set = solver->trace(question);
    SelfMotionSet first;
    first.curves = {set.curves.front()};
    VectorX way = VectorX::Zero(7);
    for (int step = 0; step < 400; ++step) {
      Matrix6X J(6, 7);
      geometricJacobian(chain, q, J);
      VectorX tangent = taskRank(MatrixX(J)).self_motions.row(0).transpose();
      if (way.norm() > 0.0 && tangent.dot(way) < 0.0) tangent = -tangent;
      way = tangent;
      q += 2e-3 * tangent;
      for (int k = 0; k < 2; ++k) {
        geometricJacobian(chain, q, J);
        const TaskError error = taskError(Task(), question.target, forwardKinematics(chain, q));
        q += J.transpose() * (J * J.transpose()).ldlt().solve(error.twist);
      }
      if (step % 40 == 39) {
        EXPECT_LE(distanceToIntervals(chain, question.target, first, q), 1e-8) << "trial " << trial << " step " << step;
      }
    }
  }
}

TEST_P(RedundantLaws, AnswersAreNearestWithinLimitsAndTheSameInEveryRun) {
  for (int trial = 0; trial < 10; ++trial) {
    const SerialChain chain = make(true);
    const std::optional<SelfMotionSolver> solver = SelfMotionSolver::compile(chain);
    const VectorX q = test::randomWithin(maker_, chain);
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", trial " + std::to_string(trial));
    SelfMotionQuestion question;
    question.target = forwardKinematics(chain, q);
    question.seed = q;
    const SelfMotionAnswers answers = solver->answer(question);
    ASSERT_FALSE(answers.answers.empty());
    EXPECT_LE(answers.answers.front().distance, 1e-8);
    for (const SelfMotionAnswer& answer : answers.answers) {
      EXPECT_LE(poseError(chain, question.target, answer.q), 1e-9);
      EXPECT_TRUE(answer.within_limits);
      EXPECT_NEAR(answer.self_motion.row(0).norm(), 1.0, 1e-12);
      ASSERT_EQ(static_cast<std::size_t>(answer.lower.size()), answer.free_joints.size());
      for (Eigen::Index i = 0; i < answer.lower.size(); ++i) {
        const double value = answer.q[answer.free_joints[static_cast<std::size_t>(i)]];
        EXPECT_LE(answer.lower[i], value + 1e-9);
        EXPECT_GE(answer.upper[i], value - 1e-9);
      }
      EXPECT_FALSE(answer.parameter.empty());
    }
    question.seed += VectorX::Constant(7, 0.1);
    const SelfMotionAnswers once = solver->answer(question);
    const SelfMotionAnswers again = SelfMotionSolver::compile(chain)->answer(question);
    ASSERT_EQ(once.answers.size(), again.answers.size());
    for (std::size_t i = 0; i < once.answers.size(); ++i) {
      EXPECT_TRUE(once.answers[i].q == again.answers[i].q);
      EXPECT_LE(once.answers[0].distance, (q - question.seed).norm() + 1e-9);
    }
  }
}

TEST_P(RedundantLaws, OptimaAreNoWorseThanAnyMember) {
  for (int trial = 0; trial < 3; ++trial) {
    const SerialChain chain = make(true);
    const std::optional<SelfMotionSolver> solver = SelfMotionSolver::compile(chain);
    SelfMotionQuestion question;
    question.seed = test::randomWithin(maker_, chain);
    question.target = forwardKinematics(chain, question.seed);
    const auto manipulable = [&](const VectorX& q) {
      Matrix6X J(6, 7);
      geometricJacobian(chain, q, J);
      return manipulability(J);
    };
    const SelfMotionSet set = solver->trace(question);
    for (const SelfMotionCurve& curve : set.curves) {
      for (const SelfMotionInterval& interval : curve.intervals) {
        const VectorX best = solver->bestMember(question, curve, interval, SelfMotionGoal::kMostManipulable);
        const VectorX safest = solver->bestMember(question, curve, interval, SelfMotionGoal::kFarthestFromLimits);
        EXPECT_LE(poseError(chain, question.target, best), 1e-9);
        EXPECT_LE(poseError(chain, question.target, safest), 1e-9);
        EXPECT_TRUE(isWithin(chain, safest, 1e-9));
        for (int i = interval.first; i <= interval.last; ++i)
          EXPECT_GE(manipulable(best), manipulable(nodeAt(curve, i).q) - 1e-9);
      }
    }
  }
}

TEST_P(RedundantLaws, SpecialConfigurationsAndTheirNeighbourhoodAreFound) {
  const double special[] = {0.0, 0.5 * kPi, -0.5 * kPi};
  int missed = 0;
  int asked = 0;
  for (double offset : {0.0, 1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
    for (int trial = 0; trial < 8; ++trial) {
      const SerialChain chain = make(false);
      const std::optional<SelfMotionSolver> solver = SelfMotionSolver::compile(chain);
      VectorX q = test::randomWithin(maker_, chain);
      for (int i = 0; i < 7; ++i) {
        if (maker_.index(2) == 0) q[i] = special[maker_.index(3)] + offset;
      }
      SelfMotionQuestion question;
      question.target = forwardKinematics(chain, q);
      question.ignore_limits = true;
      const SelfMotionAnswers answers = solver->answer(question);
      ++asked;
      missed += answers.answers.empty() ? 1 : 0;
      EXPECT_FALSE(answers.answers.empty()) << offset << " " << q.transpose();
      for (const SelfMotionAnswer& answer : answers.answers) {
        ASSERT_TRUE(answer.q.allFinite() && answer.self_motion.allFinite() && answer.lower.allFinite());
        EXPECT_LE(poseError(chain, question.target, answer.q), 1e-9) << offset << " " << q.transpose();
      }
    }
  }
  EXPECT_EQ(missed, 0) << "of " << asked;
}

TEST_P(RedundantLaws, OneSolutionWithinLimitsIsAlwaysFound) {
  const int count = GetParam() == test::RedundantArmMaker::kGeneral ? 1000 : 10000;
  const SerialChain chain = make(true);
  const std::optional<SelfMotionSolver> solver = SelfMotionSolver::compile(chain);
  int missed = 0;
  double seconds = 0.0;
  for (int trial = 0; trial < count; ++trial) {
    const VectorX q = test::randomWithin(maker_, chain);
    SelfMotionQuestion question;
    question.target = forwardKinematics(chain, q);
    const auto start = std::chrono::steady_clock::now();
    const std::optional<VectorX> found = solver->anyWithinLimits(question);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    missed += found ? 0 : 1;
    if (!found) continue;
    EXPECT_TRUE(chain.clamped(*found) == *found);
    EXPECT_LE(poseError(chain, question.target, *found), 1e-8);
  }
  EXPECT_EQ(missed, 0) << "of " << count;
  std::cout << "mean time of one solution within limits " << seconds / count * 1e6 << " us\n";
}

INSTANTIATE_TEST_SUITE_P(Arms, RedundantLaws, testing::Range(0, kPanda + 1));

}  // namespace
}  // namespace screwline
