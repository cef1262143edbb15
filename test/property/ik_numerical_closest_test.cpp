#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "ik_arms.h"
#include "screwline/ik/numerical/numerical_solver.h"

namespace screwline {
namespace {

using test::ArmMaker;

const Task kPlane = Task::fromRows({0, 1});
const Task kSpace = Task::fromRows({0, 1, 2});

/// The chain with the same limits for all joints.
SerialChain limited(const SerialChain& chain, double lower, double upper) {
  ChainDescription description;
  description.name = chain.name();
  description.base_link = chain.baseLink();
  description.tip_link = chain.tipLink();
  description.joints = chain.joints();
  for (Joint& joint : description.joints) {
    joint.type = JointType::kRevolute;
    joint.limits.lower = lower;
    joint.limits.upper = upper;
  }
  description.axes = chain.axes();
  description.home = chain.home();
  description.links = chain.links();
  return SerialChain(description);
}

SerialChain planar(const std::vector<double>& links) {
  std::vector<Axis> axes;
  double x = 0.0;
  for (double link : links) {
    axes.push_back(ArmMaker::turn(Vector3::UnitZ(), {x, 0.0, 0.0}));
    x += link;
  }
  return ArmMaker::chain(axes, {Matrix3::Identity(), {x, 0.0, 0.0}}, Pose());
}

Pose at(const Vector3& p) {
  return {Matrix3::Identity(), p};
}

/// Distance from radius r to the annulus between `inner` and `outer`.
double toAnnulus(double r, double inner, double outer) {
  return std::max({0.0, r - outer, inner - r});
}

const std::vector<double> kBeyond = {1e6, 1e3, 10.0, 2.0, 0.1, 1e-3, 1e-6, 1e-9, 1e-12};

TEST(IkNumericalClosest, PlanarTwoAndThreeLinks) {
  for (const std::vector<double>& links : {std::vector<double>{0.7, 0.5}, std::vector<double>{0.5, 0.5},
                                           std::vector<double>{1.5, 0.4, 0.3}, std::vector<double>{0.5, 0.4, 0.3}}) {
    const SerialChain chain = planar(links);
    double outer = 0.0;
    for (double link : links) outer += link;
    const double inner = std::max(0.0, 2.0 * links[0] - outer);
    std::vector<double> radii;
    for (double beyond : kBeyond) radii.push_back(outer + beyond);
    for (double inside : {0.9, 0.5, 1e-3, 1e-7, 0.0}) radii.push_back(inner * inside);
    for (double r : radii) {
      for (double angle : {0.0, 0.7, -2.9, kPi}) {
        const Pose target = at({r * std::cos(angle), r * std::sin(angle), 0.0});
        SearchOptions options;
        options.restarts = 16;
        options.timeout = 10.0;
        const DescentResult closest = closestReachable(chain, kPlane, target, {VectorX::Zero(chain.size())}, options);
        EXPECT_NEAR(closest.error.position, toAnnulus(r, inner, outer), 1e-9 + 1e-15 * r)
            << links.size() << " links, r " << r << ", angle " << angle;
      }
    }
  }
}

TEST(IkNumericalClosest, ArticulatedArm) {
  const double a = 0.6;
  const double b = 0.45;
  const SerialChain chain =
      ArmMaker::chain({ArmMaker::turn(Vector3::UnitZ(), {0, 0, 0}), ArmMaker::turn(Vector3::UnitY(), {0, 0, 0.3}),
                       ArmMaker::turn(Vector3::UnitY(), {a, 0, 0.3})},
                      {Matrix3::Identity(), {a + b, 0, 0.3}}, Pose());
  ArmMaker random(11);
  std::vector<double> radii = {0.0, 1e-9, 1e-3, 0.1, a - b - 1e-6, a - b};
  for (double beyond : kBeyond) radii.push_back(a + b + beyond);
  for (double r : radii) {
    for (int k = 0; k < 4; ++k) {
      // Also on the first axis, where everything is singular.
      const Vector3 direction = k == 0 ? Vector3::UnitZ() : random.direction();
      SearchOptions options;
      options.restarts = 24;
      options.timeout = 10.0;
      const Pose target = at(Vector3(0, 0, 0.3) + r * direction);
      const DescentResult closest = closestReachable(chain, kSpace, target, {VectorX::Zero(3)}, options);
      EXPECT_NEAR(closest.error.position, toAnnulus(r, a - b, a + b), 1e-9 + 1e-15 * r) << "r " << r << ", " << k;
    }
  }
}

/// Least weighted error over a grid of the joint space.
double gridMinimum(const SerialChain& chain, const Task& task, const Pose& target, double weight, int points) {
  const VectorX lower = chain.lower();
  const VectorX step = (chain.upper() - lower) / (points - 1);
  int total = 1;
  for (int i = 0; i < chain.size(); ++i) total *= points;
  double least = std::numeric_limits<double>::infinity();
  VectorX q(chain.size());
  for (int index = 0; index < total; ++index) {
    for (int i = 0, rest = index; i < chain.size(); ++i, rest /= points) q[i] = lower[i] + (rest % points) * step[i];
    least = std::min(least, taskError(task, target, forwardKinematics(chain, q)).weighted(weight));
  }
  return least;
}

TEST(IkNumericalClosest, NoGridPointIsNearerWithinLimits) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    ArmMaker random(seed);
    std::vector<Axis> axes;
    for (int i = 0; i < 3; ++i) axes.push_back(ArmMaker::turn(random.direction(), random.vector(0.5)));
    const SerialChain chain =
        limited(ArmMaker::chain(axes, random.pose(), Pose()), random.uniform(-3.0, -0.3), random.uniform(0.0, 2.0));
    // Positions, orientations, whole poses with some weight: mostly out of reach.
    const Task task = seed % 3 == 0 ? Task() : seed % 3 == 1 ? kSpace : Task::fromRows({3, 4, 5});
    const Pose target = random.pose();
    SearchOptions options;
    options.descent.rotation_weight = random.uniform(0.2, 2.0);
    options.timeout = 10.0;
    options.restarts = 48;
    const DescentResult closest = closestReachable(chain, task, target, {VectorX::Zero(3)}, options);
    const double weight = options.descent.rotation_weight;
    EXPECT_LE(closest.error.weighted(weight), gridMinimum(chain, task, target, weight, 45) + 1e-9) << "seed " << seed;
    EXPECT_TRUE((closest.q.array() >= chain.lower().array()).all() &&
                (closest.q.array() <= chain.upper().array()).all())
        << "seed " << seed;
  }
}

TEST(IkNumericalClosest, IsALocalMinimumForLongerChains) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    ArmMaker random(seed);
    std::vector<Axis> axes;
    for (int i = 0; i < 6; ++i) {
      const bool slides = random.index(5) == 0;
      axes.push_back(slides ? ArmMaker::slide(random.direction())
                            : ArmMaker::turn(random.direction(), random.vector(0.5)));
    }
    const SerialChain chain = limited(ArmMaker::chain(axes, random.pose(), Pose()), -1.2, 1.2);
    Pose target = random.pose();
    target.p += random.vector(6.0);
    const Task task;
    SearchOptions options;
    options.restarts = 24;
    options.timeout = 10.0;
    const DescentResult closest = closestReachable(chain, task, target, {VectorX::Zero(6)}, options);
    for (int k = 0; k < 200; ++k) {
      const double size = std::pow(10.0, random.uniform(-5.0, -1.0));
      VectorX moved = closest.q;
      for (int i = 0; i < 6; ++i) moved[i] += random.uniform(-size, size);
      const TaskError error = taskError(task, target, forwardKinematics(chain, chain.clamped(moved)));
      EXPECT_GE(error.weighted(1.0), closest.error.weighted(1.0) - 1e-12) << "seed " << seed << ", size " << size;
    }
  }
}

}  // namespace
}  // namespace screwline
