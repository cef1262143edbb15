#include "screwline/model/modified_dh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "property/model_random.h"
#include "screwline/spatial/screw.h"

namespace screwline {
namespace {

Pose byTable(const ModifiedDh& dh, const std::vector<Axis>& axes, const VectorX& q) {
  Pose X = dh.base_transform;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    X = X * dh.link(static_cast<int>(i) + 1, axes[i].prismatic, axes[i].multiplier * q[axes[i].source]);
  }
  return X * dh.tool_transform;
}

Pose byExponentials(const std::vector<Axis>& axes, const Pose& home, const VectorX& q) {
  Pose X;
  for (const Axis& axis : axes) {
    const Vector6 S = axis.prismatic ? prismaticScrew(axis.direction) : revoluteScrew(axis.direction, axis.point);
    X = X * screwExponential(S, axis.multiplier * q[axis.source]);
  }
  return X * home;
}

double difference(const Pose& a, const Pose& b) {
  return std::max((a.p - b.p).cwiseAbs().maxCoeff(), (a.R - b.R).cwiseAbs().maxCoeff());
}

/// Largest difference of table and exponentials, over the size of the numbers in the table.
double worstOf(RandomModel& random, const std::vector<Axis>& axes, const Pose& home) {
  const ModifiedDh dh = modifiedDhOf(axes, home);
  double scale = 1.0;
  for (const ModifiedDhRow& row : dh.rows) scale = std::max({scale, std::abs(row.a), std::abs(row.d)});
  double worst = 0.0;
  for (int k = 0; k < 3; ++k) {
    const VectorX q = random.configuration(static_cast<int>(axes.size()));
    worst = std::max(worst, difference(byTable(dh, axes, q), byExponentials(axes, home, q)) / scale);
  }
  return worst;
}

TEST(ModifiedDhLaw, ProductIsTheChain) {
  for (unsigned seed = 1; seed <= 3000; ++seed) {
    RandomModel random(seed);
    const std::vector<Axis> axes = random.axes(random.integer(1, 7));
    EXPECT_LT(worstOf(random, axes, random.pose()), 1e-12) << "seed " << seed;
  }
}

TEST(ModifiedDhLaw, ProductIsTheLongChain) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    RandomModel random(seed);
    const std::vector<Axis> axes = random.axes(random.integer(8, 20));
    EXPECT_LT(worstOf(random, axes, random.pose()), 1e-12) << "seed " << seed;
  }
}

TEST(ModifiedDhLaw, ProductIsTheLongestChain) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    RandomModel random(seed);
    const std::vector<Axis> axes = random.axes(64);
    EXPECT_LT(worstOf(random, axes, random.pose()), 1e-12) << "seed " << seed;
  }
}

TEST(ModifiedDhLaw, MimicAxesToo) {
  for (unsigned seed = 1; seed <= 500; ++seed) {
    RandomModel random(seed);
    const SerialChain chain = random.chain(random.integer(2, 9), true);
    EXPECT_LT(worstOf(random, chain.axes(), chain.home()), 1e-12) << "seed " << seed;
  }
}

TEST(ModifiedDhLaw, CheckerSeesOneWrongNumber) {
  RandomModel random(7);
  const std::vector<Axis> axes = random.axes(6);
  const Pose home = random.pose();
  ModifiedDh dh = modifiedDhOf(axes, home);
  const VectorX q = random.configuration(6);
  dh.rows[5].d += 1e-9;
  EXPECT_GT(difference(byTable(dh, axes, q), byExponentials(axes, home, q)), 1e-10);
}

TEST(ModifiedDhLaw, HomeIsKeptForNearlyParallelAxes) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    RandomModel random(seed);
    std::vector<Axis> axes = random.axes(6);
    const double tilt = std::pow(10.0, random.uniform(-12.0, -3.0));
    axes[3].direction = rotationAbout(anyPerpendicular(axes[2].direction), tilt) * axes[2].direction;
    const Pose home = random.pose();
    const ModifiedDh dh = modifiedDhOf(axes, home);
    double scale = 1.0;
    for (const ModifiedDhRow& row : dh.rows) scale = std::max({scale, std::abs(row.a), std::abs(row.d)});
    EXPECT_LT(difference(homeOf(dh), home), 1e-14 * scale) << "seed " << seed << ", tilt " << tilt;
  }
}

TEST(ModifiedDhLaw, BoundForNearlyParallelAxes) {
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    RandomModel random(seed);
    std::vector<Axis> axes = random.axes(6);
    const auto k = static_cast<std::size_t>(random.integer(1, 5));
    axes[k - 1].prismatic = axes[k].prismatic = false;
    const double tilt = std::pow(10.0, random.uniform(-15.0, -2.0));
    axes[k].direction = rotationAbout(anyPerpendicular(axes[k - 1].direction), tilt) * axes[k - 1].direction;
    const Pose home = random.pose();
    const ModifiedDh dh = modifiedDhOf(axes, home);
    const VectorX q = random.configuration(6);
    const double off = difference(byTable(dh, axes, q), byExponentials(axes, home, q));
    const double bound = tilt < kDhParallelTolerance ? 20.0 * tilt + 1e-12 : 1e-14 / tilt + 1e-12;
    double other = 1.0;  // A second small angle may have come about by chance.
    for (std::size_t i = 1; i < axes.size(); ++i) {
      if (i != k) other = std::min(other, axes[i].direction.cross(axes[i - 1].direction).norm() + 1e-9);
    }
    if (other < 1e-2) continue;
    EXPECT_LT(off, bound) << "seed " << seed << ", tilt " << tilt;
  }
}

TEST(ModifiedDhLaw, AxesOfTheTableAreTheAxes) {
  for (unsigned seed = 1; seed <= 500; ++seed) {
    RandomModel random(seed);
    const std::vector<Axis> axes = random.axes(random.integer(1, 8));
    const Pose home = random.pose();
    const ModifiedDh dh = modifiedDhOf(axes, home);
    std::vector<bool> prismatic;
    for (const Axis& axis : axes) prismatic.push_back(axis.prismatic);
    const std::vector<Axis> again = axesOf(dh, prismatic);
    ASSERT_EQ(again.size(), axes.size());
    for (std::size_t i = 0; i < axes.size(); ++i) {
      EXPECT_LT((again[i].direction - axes[i].direction).norm(), 1e-12) << "seed " << seed << ", axis " << i;
      EXPECT_EQ(again[i].prismatic, axes[i].prismatic);
      if (axes[i].prismatic) continue;
      const double far = std::max(1.0, again[i].point.norm());
      EXPECT_LT((again[i].point - axes[i].point).cross(axes[i].direction).norm(), 1e-12 * far)
          << "seed " << seed << ", axis " << i;
    }
  }
}

TEST(ModifiedDhLaw, AnglesAreInTheirRangeAndLinkLengthsAreNotNegativeWhereAxesAreApart) {
  for (unsigned seed = 1; seed <= 500; ++seed) {
    RandomModel random(seed);
    const std::vector<Axis> axes = random.axes(random.integer(1, 8));
    const ModifiedDh dh = modifiedDhOf(axes, random.pose());
    for (std::size_t i = 0; i < dh.rows.size(); ++i) {
      EXPECT_GT(dh.rows[i].alpha, -kPi);
      EXPECT_LE(dh.rows[i].alpha, kPi);
      EXPECT_GT(dh.rows[i].theta, -kPi);
      EXPECT_LE(dh.rows[i].theta, kPi);
      EXPECT_TRUE(i == 0 || dh.rows[i].a >= -1e-8) << "seed " << seed;
    }
  }
}

TEST(ModifiedDhLaw, TheSameForTheSameInput) {
  RandomModel random(3);
  const std::vector<Axis> axes = random.axes(7);
  const Pose home = random.pose();
  const ModifiedDh a = modifiedDhOf(axes, home);
  const ModifiedDh b = modifiedDhOf(axes, home);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    EXPECT_EQ(a.rows[i].a, b.rows[i].a);
    EXPECT_EQ(a.rows[i].alpha, b.rows[i].alpha);
    EXPECT_EQ(a.rows[i].d, b.rows[i].d);
    EXPECT_EQ(a.rows[i].theta, b.rows[i].theta);
  }
}

}  // namespace
}  // namespace screwline
