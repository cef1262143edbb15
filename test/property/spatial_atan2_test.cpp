#include "screwline/spatial/atan2.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace screwline {
namespace {

struct Points {
  std::vector<double> x;
  std::vector<double> y;
};

/// All quadrants, axes and diagonals, magnitudes from 1e-150 to 1e150.
Points points(unsigned seed, int count) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  std::uniform_int_distribution<int> kind(0, 9);
  Points result;
  for (int i = 0; i < count; ++i) {
    const double scale = std::pow(10.0, 150.0 * coordinate(engine));
    double x = coordinate(engine);
    double y = coordinate(engine);
    const int special = kind(engine);
    if (special == 0) x = 0.0;
    if (special == 1) y = 0.0;
    if (special == 2) y = x;
    if (special == 3) y *= 1e-12;
    result.x.push_back(scale * x);
    result.y.push_back(scale * y);
  }
  return result;
}

std::vector<double> angles(const Points& p, std::size_t first, std::size_t count) {
  std::vector<double> result(count);
  atan2Many(p.y.data() + first, p.x.data() + first, result.data(), static_cast<int>(count));
  return result;
}

TEST(Atan2Many, IsWithinTwoUnitsInTheLastPlaceOfTheLibrarys) {
  const Points p = points(81, 100000);
  const std::vector<double> found = angles(p, 0, p.x.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double expected = std::atan2(p.y[i], p.x[i]);
    const double unit = std::nextafter(std::abs(expected), 10.0) - std::abs(expected);
    ASSERT_LE(std::abs(found[i] - expected), 2.5 * unit) << "seed 81: y " << p.y[i] << ", x " << p.x[i];
  }
}

TEST(Atan2Many, AnAngleDoesNotDependOnItsCompany) {
  const Points p = points(82, 60);
  const std::vector<double> all = angles(p, 0, p.x.size());
  for (std::size_t count = 1; count <= 9; ++count) {
    for (std::size_t first = 0; first + count <= all.size(); ++first) {
      const std::vector<double> some = angles(p, first, count);
      for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(some[i], all[first + i]) << "seed 82, " << count << " together";
    }
  }
}

TEST(Atan2Many, AxesAndTheOrigin) {
  const std::vector<double> y = {0.0, 1.0, 0.0, -1.0, 0.0};
  const std::vector<double> x = {1.0, 0.0, -1.0, 0.0, 0.0};
  std::vector<double> found(5);
  atan2Many(y.data(), x.data(), found.data(), 5);
  const double half = std::acos(-1.0);
  const std::vector<double> expected = {0.0, 0.5 * half, half, -0.5 * half, 0.0};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(found[i], expected[i]) << i;
}

}  // namespace
}  // namespace screwline
