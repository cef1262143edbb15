#include "screwline/model/limits.h"

#include <gtest/gtest.h>

#include <limits>

#include "screwline/exception.h"
#include "screwline/model/dh_reader.h"

namespace screwline {
namespace {

SerialChain arm() {
  return readDhYaml(
      "name: arm\njoints:\n"
      "  - {name: j1, type: continuous, alpha: 0, a: 0, d: 0, theta: 0, velocity: 2}\n"
      "  - {name: j2, type: prismatic, alpha: 0, a: 1, d: 0, theta: 0, lower: 0, upper: 1}\n"
      "tool: {xyz: [0.5, 0, 0]}\n");
}

TEST(RateLimits, ReplaceWhatWasAssumed) {
  const SerialChain chain = withRateLimits(arm(), {{"j1", {{}, 9.0, {}}}});
  const JointLimits limits = chain.joint(0).limits;
  EXPECT_EQ(limits.velocity, 2.0);
  EXPECT_EQ(limits.acceleration, 9.0);
  EXPECT_EQ(limits.jerk, 9.0 / kAssumedJerkTime) << "still assumed, from the acceleration given";
  EXPECT_FALSE(limits.velocity_assumed);
  EXPECT_FALSE(limits.acceleration_assumed);
  EXPECT_TRUE(limits.jerk_assumed);
  EXPECT_EQ(chain.joint(1).limits.acceleration, arm().joint(1).limits.acceleration);
}

TEST(RateLimits, AssumedOnesFollowTheVelocity) {
  const JointLimits limits = withRateLimits(arm(), {{"j2", {0.5, {}, {}}}}).joint(1).limits;
  EXPECT_EQ(limits.velocity, 0.5);
  EXPECT_FALSE(limits.velocity_assumed);
  EXPECT_EQ(limits.acceleration, 0.5 / kAssumedAccelerationTime);
  EXPECT_TRUE(limits.acceleration_assumed);
}

TEST(RateLimits, KeepTheRestOfTheChain) {
  const SerialChain before = arm();
  const SerialChain chain = withRateLimits(before, {{"j1", {1.0, 2.0, 3.0}}, {"gripper", {-1.0, {}, {}}}});
  EXPECT_EQ(chain.jointNames(), before.jointNames());
  EXPECT_EQ(chain.tipLink(), before.tipLink());
  EXPECT_EQ(chain.links().size(), before.links().size());
  EXPECT_EQ(chain.modifiedDh().rows[1].a, 1.0);
  EXPECT_TRUE(isApprox(chain.home(), before.home(), 0.0));
  EXPECT_EQ(chain.joint(0).limits.jerk, 3.0);
}

TEST(RateLimits, BadOnesAreRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, nan, infinite, 2e6}) {
    for (const RateLimits& limits : {RateLimits{bad, {}, {}}, RateLimits{{}, bad, {}}, RateLimits{{}, {}, bad}}) {
      const std::string what = limits.velocity ? "velocity" : limits.acceleration ? "acceleration" : "jerk";
      try {
        withRateLimits(arm(), {{"j2", limits}});
        ADD_FAILURE() << what << " " << bad;
      } catch (const ModelError& error) {
        EXPECT_NE(std::string(error.what()).find("joint 'j2': " + what + " limit is "), std::string::npos)
            << error.what();
      }
    }
  }
}

TEST(RateLimits, AssumedRatesFillInWhatIsInfinite) {
  JointLimits limits;
  limits.acceleration = 3.0;
  limits = withAssumedRates(limits);
  EXPECT_EQ(limits.velocity, kAssumedVelocity);
  EXPECT_TRUE(limits.velocity_assumed);
  EXPECT_EQ(limits.acceleration, 3.0);
  EXPECT_FALSE(limits.acceleration_assumed);
  EXPECT_EQ(limits.jerk, 3.0 / kAssumedJerkTime);
  EXPECT_TRUE(limits.jerk_assumed);
}

}  // namespace
}  // namespace screwline
