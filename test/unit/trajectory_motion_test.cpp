// JointTrajectory, sampling, metrics and the verifier.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "screwline/trajectory/hermite.h"
#include "screwline/trajectory/metrics.h"
#include "screwline/trajectory/stop.h"
#include "screwline/trajectory/verify.h"
#include "unit/trajectory_support.h"

namespace {
std::size_t allocations = 0;
}

// Counted in the whole executable, Eigen's malloc and operator new alike: sample() may not show up here.
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

namespace screwline {
namespace {

using trajectory_test::limitsOf;
using trajectory_test::planned;
using trajectory_test::request;
using trajectory_test::vector;

JointTrajectory sinusoids() {
  return JointTrajectory::sinusoidal({vector({0.0, 0.5}), vector({1.0, -0.7}), vector({1.1, -2.3}), vector({0.3, 1.0})},
                                     7.0);
}

TEST(JointTrajectory, SamplingNeverAllocates) {
  const VectorX a = VectorX::Zero(6), b = VectorX::LinSpaced(6, 0.1, 1.0), c = VectorX::LinSpaced(6, -1.0, 0.3);
  const JointTrajectory motions[] = {planned("polynomial_345", {a, b}),
                                     planned("cycloidal", {a, b}),
                                     planned("trapezoidal", {a, b}),
                                     planned("multipoint_quintic", {a, b, c}),
                                     planned("bspline_interpolating", {a, b, c, a}),
                                     sinusoids()};
  for (const JointTrajectory& motion : motions) {
    TrajectoryPoint point(motion.joints());
    const std::size_t before = allocations;
    for (int i = -10; i <= 110; ++i) motion.sample(motion.duration() * i / 100.0, point);
    EXPECT_EQ(allocations, before);
    EXPECT_TRUE(point.position.allFinite());
  }
  const std::size_t before = allocations;
  motions[0].sample(0.0, *std::make_unique<TrajectoryPoint>());
  EXPECT_GT(allocations, before) << "the counter itself must count";
}

TEST(JointTrajectory, EndsAreHeldOutsideWithZeroDerivatives) {
  for (const JointTrajectory& motion :
       {planned("rectangular", {vector({0.0, 1.0}), vector({1.0, 3.0})}), sinusoids()}) {
    TrajectoryPoint end(2), after(2);
    motion.sample(motion.duration(), end);
    EXPECT_GT(end.velocity.norm(), 0.0) << "at the end from inside";
    motion.sample(motion.duration() + 1e-9, after);
    EXPECT_EQ(after.position, end.position);
    EXPECT_TRUE(after.velocity.isZero(0.0) && after.acceleration.isZero(0.0) && after.jerk.isZero(0.0));
    motion.sample(0.0, end);
    motion.sample(-1.0, after);
    EXPECT_EQ(after.position, end.position);
    EXPECT_TRUE(after.velocity.isZero(0.0));
  }
}

TEST(JointTrajectory, OneMillisecondAndLateIntervalsAreWellConditioned) {
  PlanRequest r = request("multipoint_quintic", {vector({0.0}), vector({1.0}), vector({2.0})}, Limits::unlimited(1));
  r.waypoints[1].time = 1e-3;
  r.duration = 7.0;
  const PlanResult result = plan(r);
  EXPECT_LT(std::abs(result.via_joint_errors(0, 0)), 1e-12);
  TrajectoryPoint point(1);
  const PiecewisePolynomial late = quinticsThrough({0.0, 5.0, 7.0}, Eigen::RowVector3d(0.0, 0.0, 1.0),
                                                   Eigen::RowVector3d::Zero(), Eigen::RowVector3d::Zero());
  JointTrajectory::piecewise(late).sample(5.0, point);
  EXPECT_EQ(point.position[0], 0.0);
  JointTrajectory::piecewise(late).sample(7.0, point);
  EXPECT_NEAR(point.position[0], 1.0, 1e-15);
  JointTrajectory::piecewise(late).sample(6.0, point);
  EXPECT_NEAR(point.position[0], 0.5, 1e-15);
  EXPECT_NEAR(point.velocity[0], 1.875 / 2.0, 1e-14);
}

TEST(JointTrajectory, ABreakpointAnswersWithTheLaterPiece) {
  const JointTrajectory motion = planned("trapezoidal", {vector({0.0}), vector({1.0})}, 3.0);
  TrajectoryPoint point(1);
  motion.sample(motion.corners()[0], point);
  EXPECT_EQ(point.acceleration[0], 0.0);
  motion.sample(3.0, point);
  EXPECT_NEAR(point.acceleration[0], -0.5, 1e-12);
}

TEST(JointTrajectory, ReversedRunsBackwards) {
  const JointTrajectory motion = planned("multipoint_quintic", {vector({0.0}), vector({1.0}), vector({0.4})});
  const JointTrajectory back = JointTrajectory::piecewise(reversed(*motion.pieces()));
  TrajectoryPoint a(1), b(1);
  for (int i = 0; i <= 40; ++i) {
    const double t = motion.duration() * (i + 0.37) / 41.0;
    motion.sample(t, a);
    back.sample(motion.duration() - t, b);
    EXPECT_NEAR(a.position[0], b.position[0], 1e-12);
    EXPECT_NEAR(a.velocity[0], -b.velocity[0], 1e-11);
    EXPECT_NEAR(a.acceleration[0], b.acceleration[0], 1e-9);
    EXPECT_NEAR(a.jerk[0], -b.jerk[0], 1e-7);
  }
}

TEST(Sampling, FirstAtZeroLastExactlyAtTheDuration) {
  const JointTrajectory motion = planned("cubic", {vector({0.0}), vector({1.0})}, 2.005);
  const auto times = sampleTimes(motion, 0.01);
  EXPECT_EQ(times.front(), 0.0);
  EXPECT_EQ(times.back(), 2.005);
  EXPECT_EQ(times.size(), 202u);
  const JointTrajectory whole = planned("cubic", {vector({0.0}), vector({1.0})}, 3.0);
  for (double period : {0.1, 0.01, 0.001, 1.0 / 3.0}) {
    const auto exact = sampleTimes(whole, period);
    EXPECT_EQ(exact.size(), static_cast<std::size_t>(std::lround(3.0 / period)) + 1) << period;
    EXPECT_EQ(exact.back(), 3.0);
  }
}

TEST(Sampling, CornersAreAddedInOrder) {
  const JointTrajectory motion = planned("trapezoidal", {vector({0.0}), vector({1.0})}, 3.0);
  const auto times = sampleTimes(motion, 0.3, true);
  for (double corner : motion.corners()) EXPECT_EQ(std::count(times.begin(), times.end(), corner), 1);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  EXPECT_EQ(times.back(), 3.0);
}

TEST(Sampling, AbsurdCountsAndPeriodsAreRefused) {
  const JointTrajectory motion = planned("cubic", {vector({0.0}), vector({1.0})}, 100.0);
  EXPECT_THROW(sampleTimes(motion, 1e-5), InputError);
  EXPECT_THROW(sampleTimes(motion, 0.0), InputError);
  EXPECT_THROW(sampleTimes(motion, std::nan("")), InputError);
  EXPECT_EQ(sampleTimes(planned("cubic", {vector({0.0}), vector({0.0})}), 0.01).size(), 1u);
}

TEST(Metrics, ClosedFormOfTheThreeFourFive) {
  const JointTrajectory motion = planned("polynomial_345", {vector({0.0, 0.0}), vector({-2.0, 0.0})}, 10.0);
  const JointMetrics m = jointMetrics(motion, limitsOf(2, 1.0, 4.0, 40.0), vector({-2.0, 0.25}));
  EXPECT_NEAR(m.peak_velocity[0], 1.875 * 0.2, 1e-12);
  EXPECT_NEAR(m.peak_jerk[0], 60.0 * 2.0 / 1000.0, 1e-12);
  EXPECT_NEAR(m.jerk_integral[0], 720.0 * 4.0 / 1e5, 1e-12);
  EXPECT_NEAR(m.energy, 120.0 / 7.0 * 4.0 / 1e3, 1e-12);  // Integral of (s345'')^2 is 120/7.
  EXPECT_NEAR(m.rms_acceleration[0], std::sqrt(m.energy / 10.0), 1e-12);
  EXPECT_NEAR(m.travel[0], 2.0, 1e-12);
  EXPECT_NEAR(m.limit_ratio[0], 0.375, 1e-12);
  EXPECT_EQ(m.limit_ratio[1], 0.0);
  EXPECT_EQ(m.peak_jerk[1], 0.0);
  EXPECT_NEAR(m.goal_error, 0.25, 1e-12);
}

TEST(Metrics, StepsMakeTheOrderAboveInfiniteOnlyWhereAJointMoves) {
  const JointMetrics cubic = jointMetrics(planned("cubic", {vector({0.0, 1.0}), vector({1.0, 1.0})}, 9.0),
                                          limitsOf(2, 1, 4, 40), vector({1.0, 1.0}));
  EXPECT_TRUE(std::isinf(cubic.peak_jerk[0]) && std::isinf(cubic.jerk_integral[0]));
  EXPECT_NEAR(cubic.acceleration_step[0], 6.0 / 81.0, 1e-12);
  EXPECT_EQ(cubic.peak_jerk[1], 0.0);
  EXPECT_TRUE(std::isfinite(cubic.limit_ratio[0]));
  const JointMetrics line =
      jointMetrics(planned("rectangular", {vector({0.0}), vector({1.0})}), limitsOf(1, 1, 4, 40), vector({1.0}));
  EXPECT_TRUE(std::isinf(line.peak_acceleration[0]) && std::isinf(line.rms_acceleration[0]) && std::isinf(line.energy));
  EXPECT_NEAR(line.limit_ratio[0], 1.0, 1e-12);
}

/// A planar arm of two unit links, to second order.
ToolMotion planarTool(const TrajectoryPoint& s) {
  ToolMotion m{Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
  double angle = 0.0, rate = 0.0, acceleration = 0.0;
  for (int i = 0; i < 2; ++i) {
    angle += s.position[i];
    rate += s.velocity[i];
    acceleration += s.acceleration[i];
    const Vector3 along(std::cos(angle), std::sin(angle), 0.0), across(-std::sin(angle), std::cos(angle), 0.0);
    m.position += along;
    m.velocity += rate * across;
    m.acceleration += acceleration * across - rate * rate * along;
  }
  return m;
}

TEST(Metrics, ToolOnACircleHasItsLengthAndCurvature) {
  const JointTrajectory motion = planned("polynomial_345", {vector({0.0, 0.0}), vector({1.5, 0.0})});
  const ToolMetrics m = toolMetrics(motion, planarTool);
  EXPECT_NEAR(m.path_length, 3.0, 1e-8);
  EXPECT_LE(std::abs(m.path_length - 3.0), m.path_length_error + 1e-12);
  EXPECT_NEAR(m.max_curvature, 0.5, 1e-9);
  EXPECT_NEAR(m.peak_speed, 2.0 * motion.extrema(0).velocity, 1e-9);
}

TEST(Metrics, ToolFiguresAgreeWithDenseSampling) {
  const JointTrajectory motion = planned("trapezoidal", {vector({0.0, 0.3}), vector({1.5, 2.0})});
  const ToolMetrics m = toolMetrics(motion, planarTool);
  double length = 0.0, speed = 0.0, curvature = 0.0;
  TrajectoryPoint point(2);
  constexpr int kSteps = 200000;
  for (int i = 0; i < kSteps; ++i) {
    motion.sample(motion.duration() * (i + 0.5) / kSteps, point);
    const ToolMotion tool = planarTool(point);
    const double v = tool.velocity.norm();
    length += v * motion.duration() / kSteps;
    speed = std::max(speed, v);
    if (v > 1e-6) curvature = std::max(curvature, tool.velocity.cross(tool.acceleration).norm() / (v * v * v));
  }
  EXPECT_NEAR(m.path_length, length, 1e-7);
  EXPECT_GE(m.peak_speed, speed);
  EXPECT_NEAR(m.peak_speed, speed, 1e-5);
  EXPECT_NEAR(m.max_curvature, curvature, 1e-3 * curvature);
  EXPECT_EQ(toolMetrics(planned("cubic", {vector({0.0, 0.0}), vector({0.0, 0.0})}), planarTool).path_length, 0.0);
}

class BrokenTrajectory : public ::testing::Test {
 protected:
  BrokenTrajectory()
      : motion_(*planned("multipoint_quintic", {vector({0.0}), vector({1.0}), vector({0.4})}).pieces()) {}

  std::string verdict(const Limits& limits = limitsOf(1, 1.0, 4.0, 40.0)) const {
    return verifyTrajectory(JointTrajectory::piecewise(motion_), limits,
                            {{0.0, vector({0.0})}, {motion_.duration(), vector({0.4})}})
        .value_or("");
  }

  PiecewisePolynomial motion_;
};

TEST_F(BrokenTrajectory, SoundOnePasses) {
  EXPECT_EQ(verdict(), "");
}

TEST_F(BrokenTrajectory, StepInPosition) {
  motion_.at(1, 0, 0) += 1e-3;
  EXPECT_NE(verdict().find("derivative 0 steps"), std::string::npos) << verdict();
}

TEST_F(BrokenTrajectory, StepInAcceleration) {
  motion_.at(1, 2, 0) += 1e-4;
  motion_.at(1, 3, 0) -= 1e-4;
  EXPECT_NE(verdict().find("steps"), std::string::npos) << verdict();
}

TEST_F(BrokenTrajectory, NotAtRestAtTheEnd) {
  motion_.at(0, 1, 0) += 1e-4;
  motion_.at(0, 2, 0) -= 1e-4;
  EXPECT_NE(verdict().find("derivative 1 steps"), std::string::npos) << verdict();
}

TEST_F(BrokenTrajectory, LimitBetweenAnyTwoSamples) {
  EXPECT_NE(verdict(limitsOf(1, 0.999, 4.0, 40.0)).find("velocity"), std::string::npos)
      << verdict(limitsOf(1, 0.999, 4.0, 40.0));
  for (double& t : motion_.breaks) t *= 0.999;
  EXPECT_NE(verdict().find("its limit is"), std::string::npos) << verdict();
}

TEST_F(BrokenTrajectory, NotFinite) {
  motion_.at(1, 4, 0) = std::nan("");
  EXPECT_NE(verdict(), "");
}

TEST_F(BrokenTrajectory, MissesItsGoal) {
  EXPECT_NE(verifyTrajectory(JointTrajectory::piecewise(motion_), limitsOf(1, 1, 4, 40),
                             {{motion_.duration(), vector({0.5})}})
                .value_or("")
                .find("misses its waypoint"),
            std::string::npos);
}

TEST_F(BrokenTrajectory, PositionBound) {
  Limits limits = limitsOf(1, 1.0, 4.0, 40.0);
  limits.lower = vector({0.0});
  limits.upper = vector({0.99});
  EXPECT_NE(verdict(limits).find("upper limit"), std::string::npos) << verdict(limits);
}

TEST_F(BrokenTrajectory, TimeScalingThatSteps) {
  PiecewisePolynomial s = TimeLaw::polynomial345().pieces();
  s.at(0, 1, 0) = 0.01;
  s.at(0, 2, 0) = -0.01;
  const JointTrajectory motion = JointTrajectory::scaled(vector({0.0}), vector({1.0}), TimeLaw(s), 10.0);
  EXPECT_TRUE(verifyTrajectory(motion, limitsOf(1, 1, 4, 40), {}).has_value());
}

}  // namespace
}  // namespace screwline
