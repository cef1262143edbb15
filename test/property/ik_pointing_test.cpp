#include <gtest/gtest.h>

#include <cstdio>
#include <map>

#include "ik_arms.h"
#include "ik_gate.h"
#include "property/model_random.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "shipped_robots.h"

namespace screwline {
namespace {

using test::ArmMaker;
using test::jointDifference;

SerialChain shipped(const std::string& name) {
  return test::shippedRobot(SCREWLINE_SOURCE_DIR, name).chain;
}

/// [m] and difference of unit vectors, by the product of exponentials and nothing of the solver.
double errorOf(const SerialChain& chain, int axis, const Pose& target, const VectorX& q) {
  const Pose actual = forwardByExponentials(chain, q);
  return std::max((actual.p - target.p).norm(), (actual.R.col(axis) - target.R.col(axis)).norm());
}

IkRequest requestFor(const Pose& target) {
  IkRequest request;
  request.target = target;
  request.ignore_limits = true;
  request.timeout = 20.0;
  request.find_closest = false;
  return request;
}

VectorX configuration(const SerialChain& chain, RandomModel& random) {
  VectorX q(chain.size());
  for (int i = 0; i < chain.size(); ++i) q[i] = random.uniform(-1.0, 1.0) * (chain.joint(i).isRevolute() ? kPi : 0.8);
  return q;
}

bool isAmong(const SerialChain& chain, const IkResult& result, const VectorX& q, double tolerance) {
  return std::any_of(result.solutions.begin(), result.solutions.end(),
                     [&](const IkAnswer& answer) { return jointDifference(chain, answer.position, q) <= tolerance; });
}

double leastSingularValue(const SerialChain& chain, const Task& task, const VectorX& q) {
  return singularValues(taskJacobian(chain, q, task)).minCoeff();
}

/// What came of all poses of one kind of arm.
struct Tally {
  int poses = 0;
  int complete = 0;
  int solutions = 0;
  int most = 0;
  int searched = 0;  ///< Solutions that a search from many starts found.
  int missed = 0;    ///< Of these, not in a complete list.
  double worst = 0.0;
};

/// The laws at a regular configuration of an arm of five joints: it is found again, everything is a solution, nothing
/// is twice, and what another method finds is there.
void expectAllSolutions(const SerialChain& chain, int axis, const VectorX& q, bool search_too, Tally& tally) {
  const Task task = Task::pointing(axis);
  const InverseKinematics ik(chain, task);
  const Pose target = forwardKinematics(chain, q);
  const IkResult result = ik.solve(requestFor(target));
  ++tally.poses;
  tally.complete += result.complete ? 1 : 0;
  tally.solutions += static_cast<int>(result.solutions.size());
  tally.most = std::max(tally.most, static_cast<int>(result.solutions.size()));
  const double tolerance = 1e-6 + 1e-12 / leastSingularValue(chain, task, q);
  EXPECT_TRUE(isAmong(chain, result, q, tolerance))
      << ik.method() << ", q = " << q.transpose() << ", " << result.message;
  for (std::size_t i = 0; i < result.solutions.size(); ++i) {
    const double error = errorOf(chain, axis, target, result.solutions[i].position);
    tally.worst = std::max(tally.worst, error);
    EXPECT_LE(error, 1e-9);
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_GT(jointDifference(chain, result.solutions[i].position, result.solutions[k].position), 1e-7);
  }
  if (!search_too) return;
  SearchOptions options;
  options.restarts = 150;
  options.timeout = 20.0;
  options.descent.honour_limits = false;
  for (const VectorX& found : search(chain, task, target, {VectorX::Zero(chain.size())}, options).solutions) {
    ++tally.searched;
    if (!result.complete || isAmong(chain, result, found, 1e-5)) continue;
    ++tally.missed;
    ADD_FAILURE() << ik.method() << " misses " << found.transpose() << " of the pose of " << q.transpose();
  }
}

void print(const std::string& what, const Tally& tally) {
  std::printf("%s: %d poses, %d complete, %d solutions (at most %d), worst error %.1e; a search found %d, %d missed\n",
              what.c_str(), tally.poses, tally.complete, tally.solutions, tally.most, tally.worst, tally.searched,
              tally.missed);
}

/// Five axes of no special relation; `slides` of them at random places are slides.
SerialChain generalArm(unsigned seed, int slides) {
  ArmMaker maker(seed);
  std::vector<Axis> axes;
  for (int i = 0; i < 5; ++i) axes.push_back(ArmMaker::turn(maker.direction(), maker.vector(0.6)));
  for (int i = 0; i < slides; ++i) axes[static_cast<std::size_t>(maker.index(5))].prismatic = true;
  return ArmMaker::chain(axes, maker.pose(), maker.pose());
}

TEST(IkPointing, EverySolutionOfGeneralArms) {
  std::map<int, Tally> tallies;
  for (unsigned seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const int slides = seed % 4 == 0 ? 1 : 0;
    const SerialChain chain = generalArm(seed, slides);
    RandomModel random(1000 + seed);
    const int axis = random.integer(0, 2);
    for (int k = 0; k < 4; ++k) expectAllSolutions(chain, axis, configuration(chain, random), k == 0, tallies[slides]);
  }
  for (const auto& [slides, tally] : tallies) {
    print("five joints in general, " + std::to_string(slides) + " slides", tally);
    EXPECT_GE(tally.complete, tally.poses * 9 / 10);
  }
}

/// Turret, three parallel axes, roll, with offsets; the tool in any orientation: a closed form with one joint more
/// where that meets the roll.
TEST(IkPointing, EverySolutionOfArmsWithParallelAxes) {
  Tally tally;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ArmMaker maker(seed);
    const Vector3 y = Vector3::UnitY();
    const Vector3 z = Vector3::UnitZ();
    const double forward = maker.uniform(0.0, 0.1);
    const std::vector<Axis> axes = {ArmMaker::turn(z, Vector3::Zero()), ArmMaker::turn(y, Vector3(forward, 0.0, 0.2)),
                                    ArmMaker::turn(y, Vector3(forward, 0.0, 0.5)),
                                    ArmMaker::turn(y, Vector3(forward, 0.0, 0.5 + maker.uniform(0.2, 0.4))),
                                    ArmMaker::turn(z, Vector3(forward, maker.uniform(0.0, 0.1), 0.0))};
    Pose home = maker.pose();
    if (seed % 2 == 0) home = {Matrix3::Identity(), Vector3(forward, axes[4].point.y(), 1.1)};
    const SerialChain chain = ArmMaker::chain(axes, home, maker.pose());
    RandomModel random(2000 + seed);
    for (int k = 0; k < 4; ++k)
      expectAllSolutions(chain, seed % 2 == 0 ? 0 : 2, configuration(chain, random), k == 0, tally);
  }
  print("turret, three parallel axes, roll", tally);
  EXPECT_GE(tally.complete, tally.poses * 9 / 10);
}

TEST(IkPointing, RandomChainsOfAnyStructureAreAnsweredHonestly) {
  int regular = 0;
  int complete = 0;
  int found = 0;
  for (unsigned seed = 1; seed <= 120; ++seed) {
    RandomModel random(seed);
    const SerialChain chain = random.chain(random.integer(3, 6), random.chance(0.1));
    const int axis = random.integer(0, 2);
    const Task task = Task::pointing(axis);
    const VectorX q = configuration(chain, random);
    const InverseKinematics ik(chain, task);
    const Pose target = forwardKinematics(chain, q);
    IkRequest request = requestFor(target);
    request.seed = q;
    const IkResult seeded = ik.solve(request);
    ASSERT_FALSE(seeded.solutions.empty()) << "seed " << seed << ", " << ik.method();
    EXPECT_LE(seeded.solutions.front().distance, 1e-9) << "seed " << seed << ", " << ik.method();
    for (const IkAnswer& answer : seeded.solutions) {
      ASSERT_LE(errorOf(chain, axis, target, answer.position), 1e-9) << "seed " << seed << ", " << ik.method();
      EXPECT_TRUE(answer.self_motion.allFinite());
      for (Eigen::Index k = 0; k < answer.self_motion.rows(); ++k) {
        const VectorX moved = answer.position + 1e-5 * answer.self_motion.row(k).transpose();
        EXPECT_LE(errorOf(chain, axis, target, moved), 1e-8) << "seed " << seed << ", " << ik.method();
      }
    }
    EXPECT_NE(ik.solve(requestFor(target)).status, IkStatus::kUnreachable) << "seed " << seed << ", " << ik.method();
    if (chain.size() != 5 || leastSingularValue(chain, task, q) < 1e-3) continue;
    ++regular;
    request.seed = VectorX();
    const IkResult result = ik.solve(request);
    complete += result.complete ? 1 : 0;
    found += isAmong(chain, result, q, 1e-6) ? 1 : 0;
    if (result.complete) {
      EXPECT_TRUE(isAmong(chain, result, q, 1e-6)) << "seed " << seed << ", " << ik.method();
    }
  }
  std::printf("random chains, seeds 1..120: %d of five joints and regular, %d complete, %d found again\n", regular,
              complete, found);
}

/// youBot turns its tool about z: the direction of z takes four joints, the fifth is free.
TEST(IkPointing, YoubotPointsItsToolWithItsLastJointFree) {
  const SerialChain chain = shipped("youbot_arm");
  const InverseKinematics ik(chain, Task::pointing(2));
  std::printf("youbot, z: %s\n", ik.method().c_str());
  EXPECT_TRUE(ik.complete());
  RandomModel random(31);
  int solutions = 0;
  for (int k = 0; k < 100; ++k) {
    const VectorX q = configuration(chain, random);
    IkRequest request = requestFor(forwardKinematics(chain, q));
    request.target.R = request.target.R * rotationAbout(Vector3::UnitZ(), random.uniform(-3.0, 3.0));
    request.seed = VectorX::Constant(5, 0.3);
    const IkResult result = ik.solve(request);
    ASSERT_TRUE(result.complete) << result.message;
    bool found = false;
    for (const IkAnswer& answer : result.solutions) {
      EXPECT_LE(errorOf(chain, 2, request.target, answer.position), 1e-9);
      ASSERT_EQ(answer.free_joints, std::vector<int>{4});
      EXPECT_TRUE(answer.singular);
      EXPECT_EQ(answer.position[4], request.seed[4]) << "the free joint has the seed's value";
      VectorX turned = answer.position;
      turned[4] = q[4];
      found = found || jointDifference(chain, turned, q) <= 1e-6;
    }
    EXPECT_TRUE(found) << q.transpose();
    solutions += static_cast<int>(result.solutions.size());
  }
  std::printf("youbot, z: 100 poses, %d solutions\n", solutions);
  IkRequest request = requestFor(forwardKinematics(chain, VectorX::Constant(5, 0.4)));
  request.target.R = request.target.R * rotationAbout(Vector3::UnitY(), 0.1) * rotationAbout(Vector3::UnitX(), 0.1);
  EXPECT_EQ(ik.solve(request).status, IkStatus::kUnreachable) << "out of the arm's plane";
}

TEST(IkPointing, LimitsCutTheFreeJointsRange) {
  const SerialChain chain = shipped("youbot_arm");
  const InverseKinematics ik(chain, Task::pointing(2));
  const VectorX q = (VectorX(5) << 0.3, 0.4, -0.6, 0.5, 1.0).finished();
  IkRequest request = requestFor(forwardKinematics(chain, q));
  request.ignore_limits = false;
  request.seed = q;
  request.seed[4] = 9.0;
  const IkResult result = ik.solve(request);
  ASSERT_FALSE(result.solutions.empty());
  EXPECT_NEAR(result.solutions.front().position[4], chain.upper()[4], 1e-12) << "the seed's value, clamped";
  EXPECT_NEAR(result.solutions.front().self_motion_lower[0], chain.lower()[4], 1e-12);
  EXPECT_NEAR(result.solutions.front().self_motion_upper[0], chain.upper()[4], 1e-12);
}

TEST(IkPointing, YoubotTurnsItsXAxisAnywhere) {
  const SerialChain chain = shipped("youbot_arm");
  Tally tally;
  RandomModel random(32);
  std::printf("youbot, x: %s\n", InverseKinematics(chain, Task::pointing(0)).method().c_str());
  for (int k = 0; k < 40; ++k) expectAllSolutions(chain, 0, configuration(chain, random), k < 10, tally);
  print("youbot, x", tally);
  EXPECT_GE(tally.complete, 38);
}

/// A whole pose of five joints: one row too many, all solutions of those that can be reached.
TEST(IkPointing, WholePosesOfFiveJoints) {
  int complete = 0;
  int solutions = 0;
  int poses = 0;
  int proved = 0;
  for (unsigned seed = 0; seed <= 8; ++seed) {
    const SerialChain chain = seed == 0 ? shipped("youbot_arm") : generalArm(seed, seed % 3 == 0 ? 1 : 0);
    const InverseKinematics ik(chain, Task());
    if (seed < 2) std::printf("whole poses: %s\n", ik.method().c_str());
    RandomModel random(3000 + seed);
    for (int k = 0; k < 10; ++k) {
      const VectorX q = configuration(chain, random);
      IkRequest request = requestFor(forwardKinematics(chain, q));
      const IkResult result = ik.solve(request);
      ++poses;
      complete += result.complete ? 1 : 0;
      solutions += static_cast<int>(result.solutions.size());
      EXPECT_TRUE(isAmong(chain, result, q, 1e-6)) << "seed " << seed << ", q = " << q.transpose();
      for (const IkAnswer& answer : result.solutions)
        EXPECT_LE(taskError(Task(), request.target, forwardByExponentials(chain, answer.position)).norm(), 1e-9);
      request.target.R = rotationAbout(random.direction(), 0.02) * request.target.R;
      proved += ik.solve(request).status == IkStatus::kUnreachable ? 1 : 0;
    }
  }
  std::printf("whole poses, seeds 0..8: %d poses, %d complete, %d solutions; %d beside them proved unreachable\n",
              poses, complete, solutions, proved);
  EXPECT_GE(complete, poses - 4);
  EXPECT_GE(proved, poses - 8);
}

/// Six joints of which the last turns the tool about its pointing axis: the whole pose's solutions, the last joint
/// free.
TEST(IkPointing, SixJointsWithTheLastFree) {
  for (const char* name : {"puma560", "kr6_r900", "ur5", "stanford_arm", "jaco2_6dof"}) {
    const SerialChain chain = shipped(name);
    const InverseKinematics ik(chain, Task::pointing(2));
    const InverseKinematics whole(chain, Task());
    std::printf("%s: %s\n", name, ik.method().c_str());
    RandomModel random(41);
    for (int k = 0; k < 15; ++k) {
      const VectorX q = configuration(chain, random);
      IkRequest request = requestFor(forwardKinematics(chain, q));
      const IkResult all = whole.solve(request);
      request.target.R = request.target.R * rotationAbout(Vector3::UnitZ(), random.uniform(-3.0, 3.0));
      const IkResult result = ik.solve(request);
      EXPECT_EQ(result.complete, all.complete) << name;
      if (result.complete) {
        EXPECT_EQ(result.solutions.size(), all.solutions.size()) << name;
      }
      for (const IkAnswer& answer : result.solutions) {
        EXPECT_LE(errorOf(chain, 2, request.target, answer.position), 1e-9);
        EXPECT_FALSE(answer.singular);
        ASSERT_EQ(answer.free_joints, std::vector<int>{5}) << name;
      }
    }
  }
}

TEST(IkPointing, TwoJointsPointATool) {
  const std::vector<Axis> axes = {ArmMaker::turn(Vector3::UnitZ(), Vector3::Zero()),
                                  ArmMaker::turn(Vector3::UnitY(), Vector3(0.0, 0.0, 0.3))};
  const SerialChain chain =
      ArmMaker::chain(axes, {rotationAbout(Vector3::UnitX(), 0.2), Vector3(0.4, 0.0, 0.3)}, Pose());
  const InverseKinematics ik(chain, Task::parse({"tx", "ty"}));
  EXPECT_TRUE(ik.complete()) << ik.method();
  RandomModel random(51);
  for (int k = 0; k < 50; ++k) {
    const VectorX q = configuration(chain, random);
    const IkResult result = ik.solve(requestFor(forwardKinematics(chain, q)));
    EXPECT_TRUE(result.complete);
    EXPECT_EQ(result.solutions.size(), 2U);
    EXPECT_TRUE(isAmong(chain, result, q, 1e-6));
  }
}

/// Exactly singular: the roll in line with the turret, the arm straight, the tool's turn in line with a joint.
TEST(IkPointing, SingularConfigurations) {
  const SerialChain youbot = shipped("youbot_arm");
  int continua = 0;
  for (int axis : {0, 2}) {
    const InverseKinematics ik(youbot, Task::pointing(axis));
    for (const std::vector<double>& values :
         std::vector<std::vector<double>>{{0, 0, 0, 0, 0},
                                          {0.3, 0, 0, 0, 0.5 * kPi},
                                          {0.2, 0.5, 0, -0.3, 0.7},
                                          {0.1, 0.6, -0.9, 0.3, 0.0},
                                          {0.1, 0.6, -0.9, 0.3, 0.5 * kPi},
                                          {0.4, 0.3, 0.8, 0.5 * kPi - 1.1, -0.5 * kPi}}) {
      const VectorX q = Eigen::Map<const VectorX>(values.data(), 5);
      for (double off : {0.0, 1e-12, 1e-9, 1e-6, 1e-3}) {
        const VectorX near = q + off * VectorX::LinSpaced(5, 0.3, 1.0);
        IkRequest request = requestFor(forwardKinematics(youbot, near));
        request.seed = near;
        const IkResult result = ik.solve(request);
        ASSERT_FALSE(result.solutions.empty()) << q.transpose() << ", " << off << ", " << result.message;
        EXPECT_LE(result.solutions.front().distance, 1e-9) << q.transpose() << ", " << off;
        for (const IkAnswer& answer : result.solutions) {
          EXPECT_LE(errorOf(youbot, axis, request.target, answer.position), 1e-9);
          continua += answer.self_motion.rows() > (axis == 2 ? 1 : 0) ? 1 : 0;
        }
        request.seed = VectorX();
        EXPECT_NE(ik.solve(request).status, IkStatus::kUnreachable) << q.transpose() << ", " << off;
      }
    }
  }
  std::printf("youbot, singular: %d continua\n", continua);
}

TEST(IkPointing, CheckerSeesAWrongSolution) {
  const SerialChain chain = shipped("youbot_arm");
  const VectorX q = VectorX::Constant(5, 0.4);
  const Pose target = forwardKinematics(chain, q);
  EXPECT_LE(errorOf(chain, 0, target, q), 1e-14);
  EXPECT_LE(errorOf(chain, 2, target, q + 0.5 * VectorX::Unit(5, 4)), 1e-14) << "the free joint";
  for (int i = 0; i < 5; ++i) EXPECT_GT(errorOf(chain, 0, target, q + 1e-7 * VectorX::Unit(5, i)), 1e-9) << i;
}

}  // namespace
}  // namespace screwline
