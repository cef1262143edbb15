// What the singular conditions of every shipped robot lose, against the numeric core.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "../../src/symbolic/condition_points.h"
#include "../../src/symbolic/exact_conditions.h"
#include "../../src/symbolic/half_angle.h"
#include "../../src/symbolic/lost_check.h"
#include "../../src/symbolic/where_zero.h"
#include "golden.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/kinematics/task_selection.h"
#include "screwline/model/urdf_reader.h"
#include "screwline/symbolic/conditions.h"
#include "screwline/symbolic/lost_direction.h"
#include "screwline/symbolic/statics.h"

namespace screwline {
namespace {

SerialChain robot(const std::string& name) {
  return readUrdfFile(std::string(SCREWLINE_SOURCE_DIR) + "/urdf/" + name + ".urdf");
}

struct Case {
  SerialChain chain;
  Task task;
  SymbolicChain symbolic;
  std::vector<ConditionFormula> conditions;
  std::vector<ConditionLoss> losses;
  std::vector<ConditionMeeting> meetings;

  explicit Case(const SerialChain& given) : Case(given, deriveTask(given)) {}
  Case(const SerialChain& given, const Task& rows)
      : chain(given),
        task(rows),
        symbolic(chain),
        conditions(conditionsOf(symbolic, chain, task)),
        losses(lossesOf(symbolic, chain, task)),
        meetings(meetingsOf(symbolic, chain, task)) {}

  std::string text(const FormulaMatrix& column) const {
    std::string all;
    for (const Formula& entry : column.entries)
      all += (all.empty() ? "" : ", ") + write(entry, symbolic.symbols(), FormulaStyle::kText);
    return all;
  }
};

/// Of a shipped robot with its own task; derived once.
const Case& shipped(std::string_view name) {
  static std::map<std::string, std::unique_ptr<Case>> known;
  std::unique_ptr<Case>& one = known[std::string(name)];
  if (!one) one = std::make_unique<Case>(robot(std::string(name)));
  return *one;
}

TEST(SymbolicLost, DirectionsOfTheSourcesInTheBase) {
  const Case& planar = shipped("rr_planar");
  ASSERT_EQ(planar.losses.size(), 1u);
  EXPECT_EQ(planar.losses[0].ranks, std::vector<int>{1});
  EXPECT_EQ(planar.text(planar.losses[0].directions.at(0).in_base), "c1, s1, 0");

  const Case& articulated = shipped("rrr_articulated");
  ASSERT_EQ(articulated.losses.size(), 2u);
  EXPECT_EQ(articulated.text(articulated.losses[1].directions.at(0).in_base), "-s1, c1, 0");
  ASSERT_GE(articulated.meetings.size(), 1u);
  EXPECT_EQ(articulated.meetings[0].loss.ranks, std::vector<int>{1});

  const Case& spherical = shipped("rrp_spherical");
  EXPECT_EQ(spherical.losses[0].ranks, std::vector<int>{1});
  EXPECT_EQ(spherical.losses[0].directions.size(), 2u);
}

TEST(SymbolicLost, RanksOfTheRrprrr) {
  const Case& arm = shipped("rrprrr");
  ASSERT_EQ(arm.losses.size(), 2u);
  for (const ConditionLoss& loss : arm.losses) EXPECT_EQ(loss.ranks, std::vector<int>{5});
  EXPECT_EQ(arm.meetings.at(0).loss.ranks, std::vector<int>{4});
  EXPECT_TRUE(arm.losses[0].directions.at(0).isTranslation());
  EXPECT_TRUE(arm.losses[1].directions.at(0).isRotation());
}

/// At golden singular poses where one condition alone is active, the formula is the direction that is printed there.
TEST(SymbolicLost, GoldenDirections) {
  int compared = 0;
  int others = 0;
  for (const std::string& name : golden::names()) {
    const golden::File& file = *golden::load(name);
    const Case arm(file.table, file.task);
    for (std::size_t i = 0; i < arm.conditions.size(); ++i)
      EXPECT_FALSE(arm.losses[i].directions.empty()) << name << ": " << arm.conditions[i].name;
    for (const golden::Case& pose : file.cases) {
      const std::vector<double> values = arm.symbolic.symbols().valuesAt(pose.q);
      std::vector<std::size_t> active;
      for (std::size_t i = 0; i < arm.conditions.size(); ++i) {
        if (std::abs(arm.conditions[i].left_side.evaluate(values)) < 1e-12) active.push_back(i);
      }
      if (active.size() != 1 || arm.losses[active[0]].directions.size() != 1) continue;
      const LostDirection& direction = arm.losses[active[0]].directions[0];
      if (direction.in_base.rows == 0 || direction.point != arm.symbolic.size() + 1) continue;
      const Vector3 ours = direction.in_base.evaluate(values);
      Matrix6X J;
      geometricJacobian(arm.chain, pose.q, J);
      const TaskRank rank = taskRank(arm.task.select(J), jacobianNoise(J));
      if (rank.lost_directions.rows() != 1 || ours.norm() < 1e-6) continue;
      Vector6 whole = Vector6::Zero();
      (direction.isTranslation() ? whole.head<3>() : whole.tail<3>()) = ours.normalized();
      EXPECT_NEAR(std::abs(rank.lost_directions.row(0).dot(arm.task.select(whole).transpose())), 1.0, 1e-9)
          << name << ' ' << pose.id;
      const Vector6 turned(Vector6::NullaryExpr([&whole](Eigen::Index k) { return whole[(k + 1) % 3 + k / 3 * 3]; }));
      others += std::abs(rank.lost_directions.row(0).dot(arm.task.select(turned).transpose())) < 0.999 ? 1 : 0;
      ++compared;
    }
  }
  EXPECT_GT(compared, 25);
  EXPECT_GT(others, 20) << "the comparison compares nothing";
}

/// The direction's wrench at the tip in the base's axes, as a row of the task.
VectorX taskRow(const Case& arm, const LostDirection& direction, const VectorX& q, const Matrix3& R_BT) {
  const std::vector<double> values = arm.symbolic.symbols().valuesAt(q);
  const Matrix3 R = arm.symbolic.pose(0, direction.axes).R.evaluate(values);
  const int tip = arm.symbolic.size() + 1;
  const Vector3 from_tip =
      arm.symbolic.pose(0, direction.point).p.evaluate(values) - arm.symbolic.pose(0, tip).p.evaluate(values);
  const Vector3 f = R * direction.f.evaluate(values);
  Vector6 wrench;
  wrench << f, R * direction.n.evaluate(values) + from_tip.cross(f);
  return arm.task.select(wrench, R_BT);
}

/// Rows about the tool's axes: the formula is the direction that the singular value decomposition finds, and with one
/// joint off it is not.
TEST(SymbolicLost, RowsAboutTheToolsAxes) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> given = {
      {"youbot_arm", {"x", "y", "z", "ty", "tz"}},
      {"spherical_wrist", {"tx", "ty", "tz"}},
      {"planar_3r", {"x", "y", "tz"}},
      {"puma560", {"x", "y", "z", "tx", "ty", "tz"}}};
  for (const auto& [name, rows] : given) {
    SCOPED_TRACE(name);
    std::unique_ptr<Case> other;
    if (name != "youbot_arm") other = std::make_unique<Case>(robot(name), Task::parse(rows));
    const Case& arm = other ? *other : shipped(name);
    ASSERT_EQ(arm.task.names(), rows);
    int compared = 0;
    double off = 0.0;
    for (std::size_t i = 0; i < arm.conditions.size(); ++i) {
      ASSERT_FALSE(arm.losses[i].directions.empty()) << arm.conditions[i].name;
      const LostDirection& direction = arm.losses[i].directions.front();
      if (arm.conditions[i].solutions.empty() || direction.at_rest) continue;
      const ConditionSolution& solution = arm.conditions[i].solutions.front();
      for (int k = 1; k <= 5; ++k) {
        VectorX q = VectorX::LinSpaced(arm.chain.size(), 0.4, 1.1) * std::cos(1.3 * k);
        for (const double turn : {0.3, 0.0}) {
          q[solution.joint] = solution.values.front().evaluate(arm.symbolic.symbols().valuesAt(q)) + turn;
          Matrix6X J;
          const Matrix3 R_BT = geometricJacobian(arm.chain, q, J).R;
          const MatrixX J_task = taskJacobian(arm.task, J, R_BT);
          const VectorX row = taskRow(arm, direction, q, R_BT).normalized();
          if (turn > 0.0) {
            off = std::max(off, (row.transpose() * J_task).norm());
            continue;
          }
          const TaskRank rank = taskRank(J_task, jacobianNoise(J));
          ASSERT_EQ(rank.lost_directions.rows(), 1);
          EXPECT_NEAR(std::abs(rank.lost_directions.row(0).dot(row)), 1.0, 1e-9);
          ++compared;
        }
      }
    }
    EXPECT_GE(compared, 5);
    EXPECT_GT(off, 1e-3) << "the comparison compares nothing";
  }
}

/// All left sides of a meeting, in order.
std::string leftSides(const Case& arm, const ConditionMeeting& meeting) {
  std::set<std::string> sides;
  for (const std::size_t i : meeting.conditions)
    sides.insert(write(arm.conditions[i].left_side, arm.symbolic.symbols(), FormulaStyle::kText));
  for (const Formula& other : meeting.others) sides.insert(write(other, arm.symbolic.symbols(), FormulaStyle::kText));
  std::string all;
  for (const std::string& side : sides) all += (all.empty() ? "" : ", ") + side;
  return all;
}

/// Where the rank falls further: the sources' own (seeds 003-4 and 004-2), the three of a seven-joint arm with three
/// centres (shoulder, elbow, wrist), and one that needs three conditions.
TEST(SymbolicLost, DeeperSingularities) {
  const std::vector<std::tuple<std::string, std::string, int>> wanted = {{"rrr_orthogonal", "c3, s2", 1},
                                                                         {"rrp_offset", "c2, d3", 1},
                                                                         {"iiwa14", "c3, s2", 5},
                                                                         {"iiwa14", "s2, s6", 5},
                                                                         {"iiwa14", "c5, s6", 5},
                                                                         {"ur5", "a2 c2 + a3 c23, s234, s5", 4},
                                                                         {"puma560", "a3 s3 + d4 c3, s4, s5", 4}};
  for (const auto& [name, sides, rank] : wanted) {
    const Case& arm = shipped(name);
    const ConditionMeeting* found = nullptr;
    for (const ConditionMeeting& meeting : arm.meetings) {
      if (leftSides(arm, meeting) == sides) found = &meeting;
    }
    ASSERT_NE(found, nullptr) << name << ": " << sides;
    EXPECT_EQ(found->loss.ranks, std::vector<int>{rank}) << name << ": " << sides;
    EXPECT_EQ(static_cast<int>(found->loss.directions.size()), arm.task.size() - rank) << name << ": " << sides;
    EXPECT_LE(found->loss.deviation, 1e-11);
  }
}

/// A condition put into a polynomial: nothing is left of its multiples, and of others what is zero where they are.
TEST(SymbolicLost, ConditionsArePutIntoPolynomials) {
  constexpr std::size_t kMostTerms = 1000;
  const Case& arm = shipped("puma560");
  const ExactChain& exact = arm.symbolic.exact();
  const std::vector<ExactCondition> conditions = exactConditions(exact, arm.chain, arm.task);
  const TrigPolynomial x = exact.pose(0, exact.size + 1).p(0, 0);
  int with_length = 0;
  for (const ExactCondition& condition : conditions) {
    const TrigPolynomial& zero = condition.base;
    if (jointsOf(exact, zero).size() == zero.symbols().size()) continue;  // s5 has no length to put in.
    ++with_length;
    EXPECT_TRUE(whereZero({zero}, zero * x, kMostTerms).isZero()) << condition.numeric.name;
    EXPECT_EQ(whereZero({zero}, zero * x, 1), zero * x) << "beyond the bound nothing is put in";
    const TrigPolynomial plain = whereZero({zero}, x, kMostTerms);
    EXPECT_FALSE(plain == x);
    EXPECT_EQ(whereZero({zero}, x + zero, kMostTerms), plain);
    for (const VectorX& q : commonZeros(arm.chain, {&condition.numeric}, 3)) {
      std::vector<double> values = arm.symbolic.symbols().valuesAt(q);
      EXPECT_GT(std::abs(plain.evaluate(values)), 1e-3 * std::abs(x.evaluate(values)));
    }
  }
  EXPECT_EQ(with_length, 2);
}

/// A direction that is not the lost one is not taken for it.
TEST(SymbolicLost, WrongDirectionsAreRefused) {
  const Case& arm = shipped("youbot_arm");
  for (std::size_t i = 0; i < arm.conditions.size(); ++i) {
    const ExactCondition condition = exactConditions(arm.symbolic.exact(), arm.chain, arm.task).at(i);
    const std::vector<VectorX> points = commonZeros(arm.chain, {&condition.numeric}, 3);
    LostDirection direction = arm.losses[i].directions.at(0);
    const LossPoints given{arm.symbolic.exact(), arm.chain, arm.task, points};
    EXPECT_LE(lossDeviation(given, {direction}, 1), 1e-11);
    direction.in_base = {};
    std::rotate(direction.f.entries.begin(), direction.f.entries.begin() + 1, direction.f.entries.end());
    EXPECT_GT(lossDeviation(given, {direction}, 1), 1e-3) << arm.conditions[i].name;
    EXPECT_GT(lossDeviation(given, {}, 1), 1.0);
  }
}

class Robots : public testing::TestWithParam<std::string> {};

TEST_P(Robots, LoseWhatTheJacobianLoses) {
  const Case& arm = shipped(GetParam());
  EXPECT_FALSE(arm.conditions.empty());
  for (std::size_t i = 0; i < arm.conditions.size(); ++i) {
    SCOPED_TRACE(arm.conditions[i].name);
    EXPECT_FALSE(arm.losses[i].ranks.empty());
    EXPECT_FALSE(arm.losses[i].directions.empty());
    EXPECT_LE(arm.losses[i].deviation, 1e-11);
  }
  const std::size_t count = arm.conditions.size();
  EXPECT_GE(arm.meetings.size(), count * (count - 1) / 2 + (count > 2 ? 1 : 0));
  // Where three conditions meet at a flat angle their configurations are met less exactly.
  for (const ConditionMeeting& meeting : arm.meetings) EXPECT_LE(meeting.loss.deviation, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Shipped, Robots,
                         testing::Values("puma560", "stanford_arm", "kr6_r900", "ur5", "youbot_arm", "scara_600",
                                         "spherical_wrist", "orienting_3r", "rpp_cylindrical", "rrp_offset"));

/// The product of the cosines of as many joints.
TrigPolynomial cosines(int count) {
  std::vector<std::vector<int>> groups;
  for (int i = 0; i < count; ++i) groups.push_back({i});
  const auto ring = std::make_shared<const TrigRing>(std::vector<int>(), groups, ProgressWatch());
  TrigPolynomial product = TrigPolynomial::number(ring, 1);
  for (int i = 0; i < count; ++i) product = product * TrigPolynomial::cosine(ring, {{i, 1}});
  return product;
}

TEST(SymbolicLost, WhatIsLongOverHalfAnglesIsToldWithoutWritingItOut) {
  const TrigPolynomial few = cosines(5);
  const std::size_t terms = toHalfAngles(few).terms.size();
  EXPECT_EQ(terms, 32u);
  EXPECT_TRUE(isShortInHalfAngles(few, terms));
  EXPECT_FALSE(isShortInHalfAngles(few, terms - 1));
  EXPECT_FALSE(isShortInHalfAngles(cosines(40), 300));  // 2^40 terms
}

/// Virtual work: tau . qd = F . V, with the power of the tip's twist.
TEST(SymbolicStatics, DoesTheWorkOfTheTip) {
  for (const char* name : {"rr_planar", "rrp_offset", "scara", "puma560", "stanford_arm"}) {
    SCOPED_TRACE(name);
    const SerialChain chain = robot(name);
    const SymbolicChain symbolic(chain);
    const StaticsFormula statics = staticsOf(symbolic);
    ASSERT_EQ(statics.efforts.size(), static_cast<std::size_t>(chain.size()));
    for (int k = 1; k <= 20; ++k) {
      const VectorX q = VectorX::LinSpaced(chain.size(), 0.3, 1.1) * std::cos(1.7 * k);
      const VectorX rates = VectorX::LinSpaced(chain.size(), -1.0, 0.7);
      Vector6 wrench;
      wrench << 2.0, -1.0, 0.5, 0.3, 0.2, -0.4;
      std::vector<double> values = symbolic.symbols().valuesAt(q);
      const int first = *symbolic.symbols().find("fx");
      for (int i = 0; i < 6; ++i) values[static_cast<std::size_t>(first + i)] = wrench[i];
      double work = 0.0;
      for (int i = 0; i < chain.size(); ++i)
        work += rates[i] * statics.efforts[static_cast<std::size_t>(i)].evaluate(values);
      const FormulaMatrix rotation = symbolic.pose(0, statics.frame).R;
      const Matrix3 R = rotation.evaluate(values);
      Matrix6X J;
      geometricJacobian(chain, q, J);
      const Vector6 twist = J * rates;
      const double power = (R * wrench.head<3>()).dot(twist.head<3>()) + (R * wrench.tail<3>()).dot(twist.tail<3>());
      EXPECT_NEAR(work, power, 1e-12);
      EXPECT_GT(std::abs(work + power), 1e-6) << "the sign is not compared";
    }
  }
}

}  // namespace
}  // namespace screwline
