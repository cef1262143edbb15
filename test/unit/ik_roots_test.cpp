#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "screwline/ik/closed_form/roots.h"
#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261128;

/// (1 - cos(x - r)) (2 + cos(x - u)): zero at r alone, twice. Also where r or u is a special angle, so that the
/// polynomial's root is at zero and its coefficients there are what rounding has left.
TEST(Roots, ADoubleRootIsFoundWhereverItLies) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> uniform(-kPi, kPi);
  std::uniform_int_distribution<int> eighth(-4, 4);
  for (int i = 0; i < 20000; ++i) {
    const double r = i % 2 == 0 ? uniform(random) : 0.25 * kPi * eighth(random);
    const double u = i % 3 == 0 ? uniform(random) : 0.25 * kPi * eighth(random);
    const auto rounded = [&](double value) { return value + 1e-16 * uniform(random); };
    const double k = rounded(2.0 - 0.5 * std::cos(r - u));
    const double a = rounded(std::cos(u) - 2.0 * std::cos(r));
    const double b = rounded(std::sin(u) - 2.0 * std::sin(r));
    const double c = rounded(-0.5 * std::cos(r + u));
    const double d = rounded(-0.5 * std::sin(r + u));
    const RealRoots roots = solveSecondHarmonic(k, a, b, c, d, 1.0);
    ASSERT_GE(roots.count, 1) << "seed " << kSeed << ", r " << r << ", u " << u;
    for (const RealRoot& root : roots)
      EXPECT_LE(std::abs(std::remainder(root.turn.angle() - r, kTwoPi)), 1e-6) << "r " << r << ", u " << u;
  }
}

TEST(Roots, ADoubleRootAtZeroIsFoundThoughItsTermsAreRounding) {
  for (double rounding : {0.0, 1e-17, -1e-17, 1e-16, -1e-16}) {
    const double square[3] = {rounding, rounding, 1.0};
    ASSERT_GE(solvePolynomial(square, 2, 1.0).count, 1) << rounding;
    const double fourth[5] = {rounding, rounding, 1.0, 0.3, 0.5};
    ASSERT_GE(solvePolynomial(fourth, 4, 1.0).count, 1) << rounding;
  }
  const double none[3] = {1e-6, 0.0, 1.0};
  EXPECT_EQ(solvePolynomial(none, 2, 1.0).count, 0);
}

}  // namespace
}  // namespace screwline
