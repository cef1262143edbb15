#ifndef SCREWLINE_TEST_PROPERTY_TRAJECTORY_RANDOM_H
#define SCREWLINE_TEST_PROPERTY_TRAJECTORY_RANDOM_H

#include <random>
#include <string>
#include <vector>

#include "unit/trajectory_support.h"

namespace screwline {
namespace trajectory_test {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double lower, double upper) { return std::uniform_real_distribution<double>(lower, upper)(engine_); }
  int integer(int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(engine_); }
  VectorX vector(int n, double lower, double upper) {
    return VectorX::NullaryExpr(n, [&](Eigen::Index) { return uniform(lower, upper); });
  }

 private:
  std::mt19937 engine_;
};

inline Limits randomLimits(Random& random, int joints) {
  Limits limits{
      random.vector(joints, 0.3, 3.0), random.vector(joints, 1.0, 20.0), random.vector(joints, 10.0, 400.0), {}, {}};
  return limits;
}

inline PlanRequest randomRequest(Random& random, const std::string& profile) {
  const int joints = random.integer(1, 7);
  const bool two = profile.find("point") == std::string::npos && profile.find("bspline") == std::string::npos;
  const int count = profile.rfind("via", 0) == 0 ? 3 : two ? 2 : random.integer(2, 9);
  std::vector<VectorX> way;
  for (int k = 0; k < count; ++k) {
    way.push_back(k > 0 && random.integer(0, 9) == 0 ? way.back() : random.vector(joints, -3.0, 3.0));
  }
  if (profile == "via_scalar" && way[0][0] == way[2][0]) way[2][0] += 0.5;
  PlanRequest r = request(profile, way, randomLimits(random, joints));
  if (profile == "sinusoidal") {
    r.waypoints.resize(1);
    r.duration = random.uniform(0.1, 30.0);
    r.limits = Limits::unlimited(joints);
    r.parameters = {{"amplitude_0", random.uniform(-2.0, 2.0)},
                    {"omega_0", random.uniform(-5.0, 5.0)},
                    {"phase_0", random.uniform(-9.0, 9.0)}};
  }
  return r;
}

}  // namespace trajectory_test
}  // namespace screwline

#endif  // SCREWLINE_TEST_PROPERTY_TRAJECTORY_RANDOM_H
