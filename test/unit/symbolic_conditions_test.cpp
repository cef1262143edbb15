#include <algorithm>
#include <cmath>
#include <mutex>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "../../src/symbolic/ginac_bridge.h"
#include "../../src/symbolic/irreducible.h"
#include "golden.h"
#include "screwline/symbolic/conditions.h"
#include "shipped_robots.h"

namespace screwline {
namespace {

/// The exact factors give the same conditions as the fitted ones, in whatever order.
TEST(SymbolicFactors, AreThoseOfTheNumericFit) {
  for (const std::string& name : golden::names()) {
    const golden::File& file = *golden::load(name);
    std::vector<std::string> fitted;
    for (const SingularityFactor& factor : factorsOf(file.table, file.task))
      fitted.push_back(factor.name + ": " + factor.expression);
    std::vector<std::string> exact;
    for (const SingularityFactor& factor :
         derivedFactorsOf(file.table, file.task, {}).value_or(factorsOf(file.table, file.task)))
      exact.push_back(factor.name + ": " + factor.expression);
    std::sort(fitted.begin(), fitted.end());
    std::sort(exact.begin(), exact.end());
    EXPECT_EQ(exact, fitted) << name;
  }
}

/// Conditions that the numeric fit does not find: it knows one joint at a time, or the whole determinant.
TEST(SymbolicFactors, AreFoundWhereNumbersShowNone) {
  const std::vector<std::pair<std::string, std::string>> found = {
      {"youbot_arm", "sin(arm_joint_3) = 0"}, {"iiwa14", "sin(joint_a4) = 0"}, {"jaco2_6dof", "joint_5"}};
  for (const auto& [name, expression] : found) {
    const test::ShippedRobot shipped = test::shippedRobot(SCREWLINE_SOURCE_DIR, name);
    ASSERT_EQ(factorsOf(shipped.chain, shipped.task).front().name, "determinant") << name;
    const auto factors = derivedFactorsOf(shipped.chain, shipped.task, {});
    ASSERT_TRUE(factors) << name;
    EXPECT_NE(factors->front().expression.find(expression), std::string::npos) << factors->front().expression;
    const TaskDeterminant determinant(shipped.chain, shipped.task);
    EXPECT_EQ(factors->size(), determinant.isSquare() ? 1u : 2u);
    if (factors->front().joints.size() > 1) continue;
    VectorX q = VectorX::LinSpaced(shipped.chain.size(), 0.3, 1.1);
    const double regular = determinant(q);
    q[factors->front().joints.front()] = factors->front().roots.front();
    EXPECT_LT(std::abs(determinant(q)), 1e-12 * std::abs(regular)) << name;
  }
}

TEST(SymbolicFactors, AreNoneWhereThereIsNothingToName) {
  for (const char* name : {"panda", "gen3_7dof", "six_r_16"}) {
    const test::ShippedRobot shipped = test::shippedRobot(SCREWLINE_SOURCE_DIR, name);
    EXPECT_FALSE(derivedFactorsOf(shipped.chain, shipped.task, {})) << name;
  }
}

TrigPolynomial::Terms randomTerms(std::mt19937& random, std::size_t count) {
  TrigPolynomial::Terms terms;
  while (terms.size() < count) {
    TrigKey key{};
    for (std::size_t i = 0; i < 4; ++i) key[i] = static_cast<std::int8_t>(random() % 3);
    terms[key] = Rational(static_cast<int>(random() % 19) - 9, 1 + static_cast<int>(random() % 3));
    if (terms[key].isZero()) terms.erase(key);
  }
  return terms;
}

TrigPolynomial::Terms product(const TrigPolynomial::Terms& a, const TrigPolynomial::Terms& b) {
  TrigPolynomial::Terms result;
  for (const auto& [key_a, number_a] : a) {
    for (const auto& [key_b, number_b] : b) {
      TrigKey key = key_a;
      for (std::size_t i = 0; i < key.size(); ++i) key[i] = static_cast<std::int8_t>(key[i] + key_b[i]);
      result[key] = result[key] + number_a * number_b;
      if (result[key].isZero()) result.erase(key);
    }
  }
  return result;
}

bool dependsOnAVariable(const TrigPolynomial::Terms& terms) {
  return std::any_of(terms.begin(), terms.end(),
                     [](const auto& term) { return term.first[1] + term.first[2] + term.first[3] > 0; });
}

/// What is a product is never taken for irreducible; what GiNaC cannot factor nearly always is.
TEST(SymbolicFactors, AreProvedToBeWholeOnALine) {
  const TrigRing ring({}, {}, ProgressWatch());
  const std::vector<bool> variable = {false, true, true, true};  // The first is a length.
  const GinacBridge bridge(4);
  std::mt19937 random(7);
  int irreducible = 0;
  int proved = 0;
  for (int i = 0; i < 40; ++i) {
    const TrigPolynomial::Terms a = randomTerms(random, 4);
    const TrigPolynomial::Terms b = randomTerms(random, 3);
    if (!dependsOnAVariable(a) || !dependsOnAVariable(b)) continue;
    const std::lock_guard<std::timed_mutex> lock(ginacMutex());
    EXPECT_FALSE(isProvedIrreducible(ring, product(a, b), variable)) << "seed 7, product " << i;
    const auto factors = ginacFactors(bridge.expression(a));
    const bool whole = factors.size() == 1 && factors.front().second == 1;
    irreducible += whole ? 1 : 0;
    proved += isProvedIrreducible(ring, a, variable) ? 1 : 0;
  }
  EXPECT_GT(irreducible, 10);
  EXPECT_GE(10 * proved, 9 * irreducible) << proved << " of " << irreducible;
}

TEST(SymbolicFactors, StopWhereTimeIsUp) {
  const test::ShippedRobot shipped = test::shippedRobot(SCREWLINE_SOURCE_DIR, "ur5");
  Progress progress;
  progress.time_limit = 0.0;
  EXPECT_THROW(derivedFactorsOf(shipped.chain, shipped.task, progress), DerivationStopped);
}

}  // namespace
}  // namespace screwline
