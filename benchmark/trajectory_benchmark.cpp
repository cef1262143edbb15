// Sampling and planning of six joints; KDL's forward kinematics of six joints is the yardstick in the same run.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "kdl_unit.h"
#include "robots.h"
#include "screwline/trajectory/plan.h"
#include "screwline/trajectory/state_to_state.h"

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
  // Prepared, so that the loop waits for no sum of its own.
  constexpr std::size_t kInstants = 1024;
  std::vector<double> instants;
  for (std::size_t i = 0; i < kInstants; ++i) instants.push_back(std::fmod(0.00137 * double(i), trajectory.duration()));
  std::size_t next = 0;
  for (auto _ : state) {
    trajectory.sample(instants[next++ % kInstants], point);
    benchmark::DoNotOptimize(point.position.data());
    benchmark::ClobberMemory();
  }
}

void planMotion(benchmark::State& state, const std::string& profile, int waypoint_count) {
  const PlanRequest request = requestFor(profile, waypoint_count);
  for (auto _ : state) benchmark::DoNotOptimize(plan(request));
}

/// 1,000 questions of seven joints, both ends moving: state to state, with a percentile over the questions.
void stateToState(benchmark::State& state) {
  constexpr std::size_t kCount = 1000;
  std::mt19937 random(kSeed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<StateToState> questions(kCount);
  for (auto& question : questions) {
    question.joints = 7;
    for (std::size_t j = 0; j < 7; ++j) {
      const double v = between(0.5, 3.0), a = between(1.0, 15.0), jerk = between(20.0, 300.0);
      AxisLimits& limits = question.limits[j] = AxisLimits::symmetric(v, a, jerk);
      const auto draw = [&](EndState& end, bool starting) {
        do {
          end = {between(-3.0, 3.0), between(-v, v), between(-a, a)};
        } while (checkState(end, limits, starting).fault != StateFault::kNone);
      };
      draw(question.from[j], true);
      draw(question.to[j], false);
    }
  }
  const auto motion = std::make_unique<StateToStateMotion>();
  std::vector<double> least(kCount, 1e9);
  std::size_t k = 0;
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    moveStateToState(questions[k], *motion);
    const std::chrono::duration<double, std::nano> passed = std::chrono::steady_clock::now() - begin;
    benchmark::DoNotOptimize(motion->duration);
    least[k] = std::min(least[k], passed.count());
    k = (k + 1) % kCount;
  }
  std::sort(least.begin(), least.end());
  state.counters["p50_ns"] = least[kCount / 2];
  state.counters["p99_ns"] = least[kCount * 99 / 100];
}

void registerAll() {
  benchmark::RegisterBenchmark("forward_kdl/rrprrr", forwardKdl, "rrprrr");
  benchmark::RegisterBenchmark("state_to_state/7_joints", stateToState);
  for (const char* profile : {"polynomial_345", "cycloidal", "double_s", "time_optimal"}) {
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
