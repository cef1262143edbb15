// The tables of known mechanisms, and of the special cases that Craig's text names.

#include "screwline/model/modified_dh.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "screwline/spatial/rotation.h"

namespace screwline {
namespace {

Axis revolute(const Vector3& direction, const Vector3& point = Vector3::Zero()) {
  return {false, direction, point};
}

Axis prismatic(const Vector3& direction, const Vector3& point = Vector3::Zero()) {
  return {true, direction, point};
}

const Vector3 kX = Vector3::UnitX();
const Vector3 kY = Vector3::UnitY();
const Vector3 kZ = Vector3::UnitZ();

void expectRow(const ModifiedDhRow& row, double alpha, double a, double theta, double d, const std::string& where) {
  EXPECT_NEAR(row.alpha, alpha, 1e-14) << where;
  EXPECT_NEAR(row.a, a, 1e-14) << where;
  EXPECT_NEAR(row.theta, theta, 1e-14) << where;
  EXPECT_NEAR(row.d, d, 1e-14) << where;
}

TEST(ModifiedDh, PlanarArmHasOnlyLengths) {
  const ModifiedDh dh = modifiedDhOf({revolute(kZ), revolute(kZ, {0.4, 0, 0}), revolute(kZ, {0.7, 0, 0})},
                                     {Matrix3::Identity(), Vector3(0.9, 0, 0)});
  expectRow(dh.rows[0], 0, 0, 0, 0, "row 1");
  expectRow(dh.rows[1], 0, 0.4, 0, 0, "row 2");
  expectRow(dh.rows[2], 0, 0.3, 0, 0, "row 3");
  EXPECT_TRUE(isApprox(dh.base_transform, {}, 0.0));
  EXPECT_TRUE(isApprox(dh.tool_transform, {Matrix3::Identity(), Vector3(0.2, 0, 0)}, 1e-15));
}

TEST(ModifiedDh, CoincidentAxesGiveAZeroRow) {
  const ModifiedDh dh = modifiedDhOf({revolute(kZ), prismatic(kZ, {0, 0, 2}), revolute(kZ, {0, 0, 1})}, {});
  for (const ModifiedDhRow& row : dh.rows) expectRow(row, 0, 0, 0, 0, "row");
}

TEST(ModifiedDh, AntiparallelAxesHaveATwistOfPi) {
  const ModifiedDh dh = modifiedDhOf({revolute(kZ), revolute(-kZ, {0.5, 0, 3})}, {});
  expectRow(dh.rows[1], kPi, 0.5, 0, 0, "row 2");
}

TEST(ModifiedDh, SphericalWristHasItsFramesInItsCentre) {
  const Vector3 centre(0.3, -0.2, 0.8);
  const ModifiedDh dh = modifiedDhOf({revolute(kZ), revolute(kX, centre), revolute(kY, centre), revolute(kZ, centre)},
                                     {Matrix3::Identity(), centre + 0.1 * kZ});
  Pose X = dh.base_transform;
  for (int i = 1; i <= 4; ++i) {
    X = X * dh.link(i, false, 0.0);
    if (i < 2) continue;
    EXPECT_TRUE(X.p.isApprox(centre, 1e-14)) << "frame " << i;
  }
  EXPECT_TRUE(dh.tool_transform.p.isApprox(0.1 * kZ, 1e-14));
}

TEST(ModifiedDh, LastPrismaticAxisEndsAtTheTip) {
  const ModifiedDh dh = modifiedDhOf({revolute(kZ), revolute(-kY, {0, 0, 0.7}), prismatic(kX, {0.2, 0, 0.7})},
                                     {Matrix3::Identity(), Vector3(0.5, 0, 0.7)});
  expectRow(dh.rows[0], 0, 0, 0, 0.7, "row 1");
  expectRow(dh.rows[1], kPi / 2, 0, kPi / 2, 0, "row 2");
  expectRow(dh.rows[2], kPi / 2, 0, 0, 0.5, "row 3");
  EXPECT_EQ(dh.tool_transform.p, Vector3(0, 0, 0));
}

TEST(ModifiedDh, PrismaticTakesTheHeightOfParallelAxes) {
  const ModifiedDh dh =
      modifiedDhOf({revolute(kZ), prismatic(kZ), revolute(kZ, {0.4, 0, 0}), revolute(kX, {0, 0, 0.6})}, {});
  EXPECT_NEAR(dh.rows[1].d, 0.6, 1e-15);
  EXPECT_EQ(dh.rows[0].d, 0.0);
  EXPECT_EQ(dh.rows[2].d, 0.0);
}

TEST(ModifiedDh, FirstAxisAcrossTheBaseNeedsNoBaseTransform) {
  const ModifiedDh dh = modifiedDhOf({revolute(-kY, {0.2, 5, 0})}, {});
  EXPECT_TRUE(isApprox(dh.base_transform, {}, 0.0));
  expectRow(dh.rows[0], kPi / 2, 0.2, 0, 0, "row 1");
}

TEST(ModifiedDh, FirstAxisBesideTheBaseMovesIt) {
  const ModifiedDh dh = modifiedDhOf({revolute(kZ, {0.1, 0.2, 0.9})}, {});
  EXPECT_TRUE(isApprox(dh.base_transform, {Matrix3::Identity(), Vector3(0.1, 0.2, 0)}, 0.0));
  expectRow(dh.rows[0], 0, 0, 0, 0, "row 1");
}

TEST(ModifiedDh, FirstAxisAnywhereIsFrameOne) {
  const Vector3 direction = Vector3(1, 2, 3).normalized();
  const ModifiedDh dh = modifiedDhOf({revolute(direction, {1, 0, 0}), revolute(kX, {0, 0, 4})}, {});
  EXPECT_TRUE(dh.base_transform.R.col(2).isApprox(direction));
  expectRow(dh.rows[0], 0, 0, 0, 0, "row 1");
}

TEST(ModifiedDh, RoundingOfAUrdfIsNotATilt) {
  const double off = 1e-11;  // rpy="1.5707963268" and the like.
  const ModifiedDh dh =
      modifiedDhOf({revolute(kZ), revolute(rotationAbout(kX, off) * kZ, {0.4, 0, 0}), revolute(kZ, {0.7, 0, 0})}, {});
  for (const ModifiedDhRow& row : dh.rows) {
    EXPECT_LT(std::abs(row.d), 1.0) << "the common normal of axes that are all but parallel is not to be sought";
    EXPECT_LT(std::abs(row.alpha), 1e-10);
  }
}

TEST(ModifiedDh, NoAxisLeavesTheTip) {
  const Pose home{rotationAbout(kX, 0.3), Vector3(1, 2, 3)};
  EXPECT_TRUE(isApprox(homeOf(modifiedDhOf({}, home)), home, 0.0));
}

/// The golden files' mechanisms: link frames lie where theirs do. Slides whose line theirs draws elsewhere are left
/// out.
class GoldenTable : public testing::TestWithParam<std::string> {};

std::vector<std::string> goldenNames() {
  return {"seed000_prrr",
          "seed001_rrp_spherical",
          "seed003_01_rr_planar",
          "seed003_02_rrr_planar",
          "seed003_03_rrr_articulated",
          "seed003_05_rpp_cylindrical",
          "seed003_06_wrist",
          "seed003_08_prrr",
          "seed004_02_rrr_dh",
          "seed004_03_orienting_3r",
          "seed004_05_planar_3r"};
}

Pose poseOf(const YAML::Node& rows) {
  Pose X;
  for (std::size_t r = 0; r < 3; ++r) {
    const auto i = static_cast<Eigen::Index>(r);
    for (std::size_t c = 0; c < 3; ++c) X.R(i, static_cast<Eigen::Index>(c)) = rows[r][c].as<double>();
    X.p[i] = rows[r][3].as<double>();
  }
  return X;
}

/// Axes from the screw axes (w, v) at zero: the point nearest to the origin is w x v.
std::vector<Axis> axesFrom(const YAML::Node& screws) {
  std::vector<Axis> axes;
  for (const YAML::Node& screw : screws) {
    Vector3 w;
    Vector3 v;
    for (std::size_t k = 0; k < 3; ++k) {
      w[static_cast<Eigen::Index>(k)] = screw[k].as<double>();
      v[static_cast<Eigen::Index>(k)] = screw[k + 3].as<double>();
    }
    const bool slides = w.norm() < 0.5;
    axes.push_back(
        {slides, slides ? v : w, slides ? Vector3(0, 0, 0) : Vector3(w.cross(v)), static_cast<int>(axes.size()), 1.0});
  }
  return axes;
}

TEST_P(GoldenTable, ToolTransformAndRowsWithNumbersAreTheirs) {
  const YAML::Node model =
      YAML::LoadFile(std::string(SCREWLINE_TEST_DATA) + "/golden/" + GetParam() + ".yaml")["model"];
  const std::vector<Axis> axes = axesFrom(model["screw_axes_space_w_v"]);
  const Pose home = poseOf(model["home_pose"]);
  const ModifiedDh dh = modifiedDhOf(axes, home);
  EXPECT_TRUE(isApprox(homeOf(dh), home, 1e-14));
  EXPECT_TRUE(isApprox(dh.base_transform, {}, 0.0)) << "frame 0 is the base";
  EXPECT_TRUE(isApprox(dh.tool_transform, poseOf(model["modified_dh"]["tool"]), 1e-14));
  const YAML::Node rows = model["modified_dh"]["rows"];
  ASSERT_EQ(rows.size(), dh.rows.size());
  for (std::size_t i = 0; i < dh.rows.size(); ++i) {
    const std::string alpha = rows[i]["alpha_prev"].as<std::string>();
    const double value = alpha == "0" ? 0.0 : alpha == "pi/2" ? kPi / 2 : alpha == "-pi/2" ? -kPi / 2 : 2 * kPi / 3;
    EXPECT_NEAR(dh.rows[i].alpha, value, 1e-14) << "row " << i + 1;
    EXPECT_EQ(rows[i]["a_prev"].as<std::string>() == "0", dh.rows[i].a == 0.0) << "row " << i + 1;
    EXPECT_TRUE(rows[i]["d"].as<std::string>() != "0" || dh.rows[i].d == 0.0) << "row " << i + 1;
  }
}

INSTANTIATE_TEST_SUITE_P(All, GoldenTable, testing::ValuesIn(goldenNames()),
                         [](const testing::TestParamInfo<std::string>& file) { return file.param; });

TEST(ModifiedDh, ProductIsTheGoldenPoseInEveryCase) {
  int cases = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(SCREWLINE_TEST_DATA) + "/golden")) {
    const YAML::Node file = YAML::LoadFile(entry.path().string());
    const std::vector<Axis> axes = axesFrom(file["model"]["screw_axes_space_w_v"]);
    const ModifiedDh dh = modifiedDhOf(axes, poseOf(file["model"]["home_pose"]));
    for (const YAML::Node& one : file["cases"]) {
      Pose X = dh.base_transform;
      for (std::size_t i = 0; i < axes.size(); ++i) {
        X = X * dh.link(static_cast<int>(i) + 1, axes[i].prismatic, one["q"][i].as<double>());
      }
      EXPECT_TRUE(isApprox(X * dh.tool_transform, poseOf(one["pose"]), 1e-13))
          << entry.path() << " " << one["id"].as<std::string>();
      ++cases;
    }
  }
  EXPECT_GT(cases, 200);
}

}  // namespace
}  // namespace screwline
