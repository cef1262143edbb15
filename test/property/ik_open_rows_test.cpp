// Tasks that leave some of x y z open, one of rx ry rz, or the tool's turn, of as many rows as the chain has joints or
// one less.
#include <gtest/gtest.h>

#include <cstdio>

#include "ik_arms.h"
#include "ik_gate.h"
#include "property/model_random.h"
#include "screwline/ik/numerical/numerical_solver.h"
#include "shipped_robots.h"

namespace screwline {
namespace {

using test::ArmMaker;
using test::GateVerdict;
using test::IkGate;
using test::jointDifference;

enum class Open { kPositions, kBaseTurn, kPositionsAndToolTurn };

/// Rows for a chain of that many joints; none where there is no such task.
std::vector<int> rowsFor(Open open, int joints, RandomModel& random) {
  const int axis = random.integer(0, 2);
  std::vector<int> rows;
  if (open == Open::kPositions) {
    rows = {3, 4, 5};
  } else {
    for (int i = 0; i < 3; ++i) {
      if (i != axis) rows.push_back((open == Open::kBaseTurn ? 3 : Task::kFirstToolRow) + i);
    }
  }
  const int positions = joints - static_cast<int>(rows.size());
  // A turn about a base axis leaves the position along it alone.
  if (positions < 0 || positions > (open == Open::kBaseTurn ? 1 : 2)) return {};
  for (int i = 0; i < positions; ++i) rows.push_back((axis + i) % 3);
  return rows;
}

/// Axes of no special relation, some at right angles to the base's or through one point; one may be a slide.
SerialChain armOf(int joints, unsigned seed, RandomModel& random) {
  ArmMaker maker(seed);
  const Vector3 center = maker.vector(0.5);
  std::vector<Axis> axes;
  for (int i = 0; i < joints; ++i) {
    const Vector3 direction = random.chance(0.3) ? Vector3(Vector3::Unit(random.integer(0, 2))) : maker.direction();
    axes.push_back(ArmMaker::turn(direction, random.chance(0.3) ? center : maker.vector(0.5)));
  }
  if (random.chance(0.2)) axes[static_cast<std::size_t>(random.integer(0, joints - 1))].prismatic = true;
  return ArmMaker::chain(axes, maker.pose(), maker.pose());
}

VectorX configurationOf(const SerialChain& chain, double special, RandomModel& random) {
  VectorX q(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    const double turn = random.chance(special) ? 0.5 * kPi * random.integer(-2, 2) : random.uniform(-kPi, kPi);
    q[i] = chain.joint(i).isRevolute() ? turn : random.uniform(-0.8, 0.8);
  }
  return q;
}

bool isRegular(const SerialChain& chain, const Task& task, const VectorX& q, double least) {
  return singularValues(taskJacobian(chain, q, task)).minCoeff() > least;
}

struct Tally {
  int arms = 0;
  int exact = 0;
  int poses = 0;
  int complete = 0;
  int searched = 0;
  int missed = 0;
};

/// What a search from many starts finds is in a complete list.
void expectNothingElse(const InverseKinematics& ik, const VectorX& q, Tally& tally) {
  const IkResult result = ik.solve(IkGate(ik, q, true).request());
  SearchOptions options;
  options.restarts = 60;
  options.timeout = 20.0;
  options.descent.honour_limits = false;
  const Pose target = forwardKinematics(ik.chain(), q);
  for (const VectorX& found : search(ik.chain(), ik.task(), target, {q}, options).solutions) {
    ++tally.searched;
    const bool known = std::any_of(result.solutions.begin(), result.solutions.end(), [&](const IkAnswer& answer) {
      return jointDifference(ik.chain(), answer.position, found) <= 1e-5;
    });
    if (known || !result.complete) continue;
    ++tally.missed;
    ADD_FAILURE() << ik.method() << " misses " << found.transpose() << " of the pose of " << q.transpose();
  }
}

void expectLaws(Open open, unsigned seed, Tally& tally) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  RandomModel random(seed);
  const int joints = random.integer(2, 5);
  const std::vector<int> rows = rowsFor(open, joints, random);
  if (rows.empty()) return;
  const SerialChain chain = armOf(joints, seed, random);
  const Task task = Task::fromRows(rows);
  if (!isRegular(chain, task, configurationOf(chain, 0.0, random), 1e-6)) return;
  const InverseKinematics ik(chain, task);
  ++tally.arms;
  tally.exact += ik.complete() ? 1 : 0;
  for (double special : {0.0, 0.4}) {
    const VectorX q = configurationOf(chain, special, random);
    const VectorX push = VectorX::LinSpaced(joints, -9e-4, 7e-4);
    const GateVerdict verdict = IkGate(ik, q, true).judge(push);
    EXPECT_TRUE(verdict.isLawful()) << ik.method() << "\n  " << verdict.message << "\n  q = " << q.transpose();
    ++tally.poses;
    tally.complete += verdict.complete ? 1 : 0;
    if (special == 0.0 && isRegular(chain, task, q, 1e-3)) expectNothingElse(ik, q, tally);
  }
}

Tally run(Open open, const char* name, unsigned first) {
  Tally tally;
  const unsigned count = test::wished("SCREWLINE_ARMS", 120);
  for (unsigned seed = first; seed < first + count; ++seed) expectLaws(open, seed, tally);
  std::printf(
      "%s, from seed %u: %d of %d arms exact; %d of %d poses complete; a search found %d solutions, %d missed\n", name,
      first, tally.exact, tally.arms, tally.complete, tally.poses, tally.searched, tally.missed);
  EXPECT_GT(tally.arms, static_cast<int>(count) / 5);
  EXPECT_GE(100 * tally.exact, 97 * tally.arms);
  EXPECT_GE(10 * tally.complete, 9 * tally.poses);
  return tally;
}

TEST(IkOpenRows, PositionsLeftOpen) {
  run(Open::kPositions, "a whole orientation, positions open", 1000);
}

TEST(IkOpenRows, ATurnAboutABaseAxisLeftOpen) {
  run(Open::kBaseTurn, "two rows of orientation", 2000);
}

TEST(IkOpenRows, PositionsAndTheToolsTurnLeftOpen) {
  run(Open::kPositionsAndToolTurn, "a direction, positions open", 3000);
}

/// Rows for one joint more than rows: any height, or the direction of an axis of the tool.
Task sparingTask(bool direction, int joints, RandomModel& random) {
  const int axis = random.integer(0, 2);
  std::vector<int> rows;
  for (int i = 0; i < 3; ++i) {
    if (!direction || i != axis) rows.push_back((direction ? Task::kFirstToolRow : 3) + i);
  }
  for (int i = 0; static_cast<int>(rows.size()) < joints - 1; ++i) rows.push_back((axis + i) % 3);
  return Task::fromRows(rows);
}

/// The laws, and that what a search finds lies on the curves that are told.
void expectSelfMotions(const SerialChain& chain, const Task& task, const VectorX& q, Tally& tally) {
  const InverseKinematics ik(chain, task);
  ++tally.arms;
  tally.exact += ik.complete() ? 1 : 0;
  const VectorX push = VectorX::LinSpaced(chain.size(), -9e-4, 7e-4);
  const bool ignore_limits = tally.arms % 2 == 0;
  const IkGate gate(ik, q, ignore_limits);
  const GateVerdict verdict = IkGate(ik, q, ignore_limits).judge(push);
  EXPECT_TRUE(verdict.isLawful()) << ik.method() << "\n  " << verdict.message << "\n  q = " << q.transpose();
  ++tally.poses;
  tally.complete += verdict.complete ? 1 : 0;
  if (!verdict.complete || !ignore_limits) return;
  const IkResult result = ik.solve(gate.request());
  SearchOptions options;
  options.restarts = 6;
  options.timeout = 20.0;
  options.descent.honour_limits = false;
  for (const VectorX& found : search(chain, task, forwardKinematics(chain, q), {q}, options).solutions) {
    ++tally.searched;
    if (gate.isKnown(found, result, 1e-5)) continue;
    ++tally.missed;
    ADD_FAILURE() << ik.method() << " misses " << found.transpose() << " of the pose of " << q.transpose();
  }
}

void expectMostComplete(const std::string& name, const Tally& tally) {
  std::printf("%-13s %3d of %3d exact, %3d of %3d poses complete; of %4d searched solutions %d missed\n", name.c_str(),
              tally.exact, tally.arms, tally.complete, tally.poses, tally.searched, tally.missed);
  EXPECT_GE(100 * tally.exact, 97 * tally.arms);
  EXPECT_GE(10 * tally.complete, 9 * tally.poses);
}

TEST(IkOpenRows, OneJointToSpareOfRandomArms) {
  Tally tally;
  const unsigned count = test::wished("SCREWLINE_ARMS", 40);
  for (unsigned seed = 4000; seed < 4000 + count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomModel random(seed);
    const int joints = random.integer(5, 6);
    const SerialChain chain = armOf(joints, seed, random);
    const Task task = sparingTask(random.chance(0.5), joints, random);
    if (!isRegular(chain, task, configurationOf(chain, 0.0, random), 1e-6)) continue;
    expectSelfMotions(chain, task, configurationOf(chain, random.chance(0.5) ? 0.4 : 0.0, random), tally);
  }
  expectMostComplete("random arms", tally);
}

TEST(IkOpenRows, OneJointToSpareOfArmsOfMakers) {
  for (const char* name : {"puma560", "ur5", "kr6_r900", "stanford_arm", "jaco2_6dof"}) {
    const SerialChain chain = test::shippedRobot(SCREWLINE_SOURCE_DIR, name).chain;
    RandomModel random(5);
    Tally tally;
    for (int k = 0; k < 6; ++k) {
      const Task task = sparingTask(k % 2 == 0, 6, random);
      expectSelfMotions(chain, task, chain.clamped(configurationOf(chain, 0.2, random)), tally);
    }
    expectMostComplete(name, tally);
  }
}

/// What a turn about the base's x moves is no free row.
TEST(IkOpenRows, PositionsThatTheTurnMovesAreSearched) {
  RandomModel random(7);
  const SerialChain chain = armOf(4, 7, random);
  EXPECT_FALSE(InverseKinematics(chain, Task::fromRows({1, 2, 4, 5})).complete());
}

TEST(IkOpenRows, CheckerSeesAListWithoutASolution) {
  RandomModel random(3);
  const SerialChain chain = armOf(4, 3, random);
  const InverseKinematics ik(chain, Task::fromRows({0, 3, 4, 5}));
  const VectorX q = configurationOf(chain, 0.0, random);
  const IkGate gate(ik, q, true);
  IkResult result = ik.solve(gate.request());
  ASSERT_TRUE(result.complete);
  EXPECT_TRUE(gate.isKnown(q, result, 1e-6));
  result.solutions.erase(
      std::remove_if(result.solutions.begin(), result.solutions.end(),
                     [&](const IkAnswer& a) { return jointDifference(chain, a.position, q) < 1e-6; }),
      result.solutions.end());
  EXPECT_FALSE(gate.isKnown(q, result, 1e-6));
}

}  // namespace
}  // namespace screwline
