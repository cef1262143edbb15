// Robots whose descriptions round right angles.

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "screwline/kinematics/task_selection.h"
#include "screwline/model/urdf_reader.h"
#include "screwline/symbolic/derivation.h"

namespace screwline {
namespace {

/// A shoulder, an elbow and a wrist whose axes meet, turned by rpy; right angles are written as `right`.
std::string urdf(const std::string& right) {
  struct Step {
    const char* xyz;
    std::string rpy;
  };
  const std::vector<Step> steps = {{"0 0 0.4", "0 0 0"},         {"0.1 0 0", "-" + right + " 0 0"},
                                   {"0.5 0 0", "0 0 -" + right}, {"0 0.3 0", "-" + right + " 0 0"},
                                   {"0 0 0", right + " 0 0"},    {"0 0 0", "-" + right + " 0 0"}};
  std::string text = "<robot name=\"arm\"><link name=\"l0\"/>";
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    text += "<link name=\"l" + number + "\"/><joint name=\"j" + number + "\" type=\"continuous\"><parent link=\"l" +
            std::to_string(i) + "\"/><child link=\"l" + number + "\"/><origin xyz=\"" + steps[i].xyz + "\" rpy=\"" +
            steps[i].rpy + "\"/><axis xyz=\"0 0 1\"/></joint>";
  }
  return text + "</robot>";
}

Derivation derivedFrom(const std::string& document, double right_angles) {
  const SerialChain chain = readUrdf(document);
  DerivationOptions options;
  options.format = DocumentFormat::kText;
  options.quantities = {"fk", "determinant"};
  options.right_angles = right_angles;
  return deriveDocument(chain, deriveTask(chain), options);
}

TEST(RightAngles, RoundedOnesGiveTheSameFormulas) {
  const Derivation exact = derivedFrom(urdf("1.5707963267948966"), kRightAngleTolerance);
  EXPECT_EQ(exact.right_angle_turn, 0.0);
  EXPECT_GE(exact.factors.size(), 4u);
  for (const char* rounded : {"1.5708", "1.57080", "1.570796"}) {
    SCOPED_TRACE(rounded);
    const Derivation squared = derivedFrom(urdf(rounded), kRightAngleTolerance);
    EXPECT_GT(squared.right_angle_turn, 1e-8);
    EXPECT_LT(squared.right_angle_turn, kRightAngleTolerance);
    EXPECT_EQ(squared.factors, exact.factors);
    EXPECT_LE(squared.worst_deviation, 1e-12);
    EXPECT_NE(squared.document.find("rounded right angles"), std::string::npos);
  }
}

TEST(RightAngles, TheErrorIsWhatThePosesDifferBy) {
  const std::optional<SquaredChain> squared = withRightAngles(readUrdf(urdf("1.5708")));
  ASSERT_TRUE(squared);
  EXPECT_GT(squared->position_error, 1e-7);
  EXPECT_LT(squared->position_error, 1e-4);
  EXPECT_GT(squared->rotation_error, 1e-7);
  EXPECT_LT(squared->rotation_error, 1e-4);
}

TEST(RightAngles, ACalibratedArmStaysAsItIs) {
  EXPECT_FALSE(withRightAngles(readUrdf(urdf("1.5720"))));
  EXPECT_FALSE(withRightAngles(readUrdf(urdf("1.5707963267948966"))));
  EXPECT_FALSE(withRightAngles(readUrdf(urdf("1.5708")), 0.0));
}

}  // namespace
}  // namespace screwline
