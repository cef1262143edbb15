// Sampling and planning of six joints; KDL's forward kinematics of six joints is the yardstick in the same run.
#include <benchmark/benchmark.h>

#include <kdl/chainfksolverpos_recursive.hpp>
#include <random>

#include "robots.h"
#include "screwline/trajectory/plan.h"

namespace screwline {
namespace benchmark_support {
namespace {

constexpr int kJoints = 6;

PlanRequest requestFor(const std::string& profile, int waypoint_count) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> angle(-3.0, 3.0);
  PlanRequest request;
  request.profile = profile;
  request.limits.velocity = VectorX::Constant(kJoints, 2.0);
  request.limits.acceleration = VectorX::Constant(kJoints, 8.0);
  request.limits.jerk = VectorX::Constant(kJoints, 80.0);
  for (int i = 0; i < waypoint_count; ++i) {
    PathPoint waypoint;
    waypoint.position = VectorX::NullaryExpr(kJoints, [&] { return angle(random); });
    request.waypoints.push_back(waypoint);
  }
  return request;
}

void sample(benchmark::State& state, const std::string& profile, int waypoint_count) {
  const JointTrajectory trajectory = plan(requestFor(profile, waypoint_count)).trajectory;
  TrajectoryPoint point(kJoints);
  double t = 0.0;
  for (auto _ : state) {
    t += 0.00137;
    if (t > trajectory.duration()) t -= trajectory.duration();
    trajectory.sample(t, point);
    benchmark::DoNotOptimize(point.position.data());
    benchmark::ClobberMemory();
  }
}

void planMotion(benchmark::State& state, const std::string& profile, int waypoint_count) {
  const PlanRequest request = requestFor(profile, waypoint_count);
  for (auto _ : state) benchmark::DoNotOptimize(plan(request));
}

void forwardKdl(benchmark::State& state) {
  Robot robot("rrprrr");
  KDL::ChainFkSolverPos_recursive solver(robot.kdl);
  KDL::JntArray q(kJoints);
  KDL::Frame frame;
  for (auto _ : state) {
    q.data = robot.next();
    solver.JntToCart(q, frame);
    benchmark::DoNotOptimize(frame);
  }
}

void registerAll() {
  benchmark::RegisterBenchmark("forward_kdl/rrprrr", forwardKdl);
  for (const char* profile : {"polynomial_345", "cycloidal"}) {
    benchmark::RegisterBenchmark((std::string("sample/") + profile).c_str(), sample, std::string(profile), 2);
    benchmark::RegisterBenchmark((std::string("plan/") + profile).c_str(), planMotion, std::string(profile), 2);
  }
  for (const char* profile : {"multipoint_cubic", "multipoint_quintic", "bspline"}) {
    benchmark::RegisterBenchmark((std::string("sample/") + profile).c_str(), sample, std::string(profile), 8);
    benchmark::RegisterBenchmark((std::string("plan/") + profile).c_str(), planMotion, std::string(profile), 8);
  }
}

}  // namespace
}  // namespace benchmark_support
}  // namespace screwline

int main(int argc, char** argv) {
  screwline::benchmark_support::registerAll();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
