// Derived formulas of random chains against the numeric core.

#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "screwline/kinematics/forward.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/task_selection.h"
#include "screwline/symbolic/derivation.h"

namespace screwline {
namespace {

constexpr double kAgreement = 1e-12;

/// Twists that are multiples of `step`; any where it is 0.
SerialChain randomChain(std::mt19937& random, int joints, double step) {
  std::uniform_real_distribution<double> length(0.1, 1.0);
  std::uniform_real_distribution<double> turn(-kPi, kPi);
  std::uniform_int_distribution<int> choice(0, 3);
  ModifiedDh dh;
  std::vector<bool> prismatic;
  for (int i = 0; i < joints; ++i) {
    ModifiedDhRow row;
    const double angle = turn(random);
    row.alpha = step > 0.0 ? step * std::round(angle / step) : angle;
    row.a = choice(random) == 0 ? 0.0 : length(random);
    row.d = choice(random) < 2 ? 0.0 : length(random);
    dh.rows.push_back(row);
    prismatic.push_back(choice(random) == 0);
  }
  dh.tool_transform.p = Vector3(length(random), 0.0, choice(random) == 0 ? length(random) : 0.0);
  ChainDescription description;
  description.name = "random";
  description.base_link = "base";
  description.tip_link = "tip";
  description.axes = axesOf(dh, prismatic);
  description.home = homeOf(dh);
  for (int i = 0; i < joints; ++i) {
    description.axes[static_cast<std::size_t>(i)].source = i;
    Joint joint;
    joint.name = "q" + std::to_string(i + 1);
    joint.type = prismatic[static_cast<std::size_t>(i)] ? JointType::kPrismatic : JointType::kRevolute;
    description.joints.push_back(joint);
  }
  description.links = {{"base", 0, {}}, {"tip", joints, description.home}};
  return SerialChain(description);
}

void expectDerived(double step, int joints, unsigned seed) {
  SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(joints) + " joints, step " +
               std::to_string(step));
  std::mt19937 random(seed);
  const SerialChain chain = randomChain(random, joints, step);
  DerivationOptions options;
  options.check_configurations = 20;
  const Derivation derivation = deriveDocument(chain, deriveTask(chain), options);
  EXPECT_LE(derivation.worst_deviation, kAgreement);
  EXPECT_FALSE(derivation.factors.empty());
}

TEST(SymbolicLaws, RightAngledChainsAgreeWithTheNumericCore) {
  for (unsigned seed = 1; seed <= 30; ++seed) expectDerived(kPi / 2.0, 2 + static_cast<int>(seed % 3), seed);
}

TEST(SymbolicLaws, ChainsOfFifteenDegreesAgreeWithTheNumericCore) {
  for (unsigned seed = 101; seed <= 112; ++seed) expectDerived(kPi / 12.0, 3, seed);
}

TEST(SymbolicLaws, ChainsOfAnyAngleAgreeWithTheNumericCore) {
  for (unsigned seed = 201; seed <= 212; ++seed) expectDerived(0.0, 3, seed);
}

TEST(SymbolicLaws, SixRightAngledJointsAgreeWithTheNumericCore) {
  for (unsigned seed = 301; seed <= 304; ++seed) expectDerived(kPi / 2.0, 6, seed);
}

/// What is compared can differ: other lengths, another chain.
TEST(SymbolicLaws, FormulasOfAnotherChainDoNotAgree) {
  std::mt19937 random(7);
  const SerialChain chain = randomChain(random, 3, kPi / 2.0);
  const SerialChain other = randomChain(random, 3, kPi / 2.0);
  const SymbolicChain symbolic(chain);
  const VectorX q = VectorX::Constant(3, 0.4);
  Matrix6X J;
  geometricJacobian(chain, q, J);
  const MatrixX derived = symbolic.jacobian(0).evaluate(symbolic.symbols().valuesAt(q));
  EXPECT_LE((derived - J).cwiseAbs().maxCoeff(), kAgreement);
  geometricJacobian(other, q, J);
  EXPECT_GT((derived - J).cwiseAbs().maxCoeff(), 1e-3);
}

}  // namespace
}  // namespace screwline
