// All solutions of a pose by elimination, for arms without a closed form: in general, and calibrated ones, whose
// geometry is special but for small errors (their mean is made by poses near the ideal arm's singularities). KDL's
// forward kinematics of the first arm in the same run as unit.
#include <benchmark/benchmark.h>

#include <kdl/chainfksolverpos_recursive.hpp>

#include "../test/algebraic_arms.h"
#include "../test/calibrated.h"
#include "screwline/ik/algebraic/algebraic_solver.h"
#include "screwline/ik/inverse_kinematics.h"
#include "screwline/kinematics/forward.h"
#include "screwline/model/urdf_reader.h"

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261124;
constexpr std::size_t kPoses = 1024;
constexpr std::size_t kNearlyIdealPoses = 200;  // All of them in each run: some take a hundred times as long as others.

std::vector<VectorX> configurationsOf(const SerialChain& chain) {
  test::ArmMaker maker(kSeed);
  std::vector<VectorX> configurations;
  for (std::size_t i = 0; i < kPoses; ++i) {
    VectorX q(6);
    for (int k = 0; k < 6; ++k) q[k] = maker.uniform(-kPi, kPi) * (chain.joint(k).isRevolute() ? 1.0 : 0.3);
    configurations.push_back(q);
  }
  return configurations;
}

void algebraic(benchmark::State& state, const SerialChain& chain) {
  const std::optional<AlgebraicSolver> solver = AlgebraicSolver::compile(chain);
  std::vector<Pose> targets;
  for (const VectorX& q : configurationsOf(chain)) targets.push_back(forwardKinematics(chain, q));
  AlgebraicSolutions solutions;
  std::size_t i = 0;
  double found = 0.0;
  for (auto _ : state) {
    solver->solve(targets[i++ % kPoses], solutions);
    benchmark::DoNotOptimize(solutions);
    found += solutions.count;
  }
  state.counters["solutions"] = found / static_cast<double>(state.iterations());
}

constexpr double kError = 5e-4;  ///< [m, rad] of each axis.

/// Whole answers of a shipped robot with errors of calibration, limits ignored.
void nearlyIdeal(benchmark::State& state, const std::string& name) {
  std::mt19937 random(kSeed);
  const SerialChain chain = test::calibrated(
      readUrdfFile(std::string(SCREWLINE_SOURCE_DIR) + "/urdf/" + name + ".urdf"), kError, kError, random);
  const InverseKinematics ik(chain, Task());
  IkRequest request;
  request.ignore_limits = true;
  request.find_closest = false;
  std::vector<Pose> targets;
  for (const VectorX& q : configurationsOf(chain)) targets.push_back(forwardKinematics(chain, q));
  std::size_t i = 0;
  double found = 0.0;
  double complete = 0.0;
  for (auto _ : state) {
    request.target = targets[i++ % kNearlyIdealPoses];
    const IkResult result = ik.solve(request);
    found += static_cast<double>(result.solutions.size());
    complete += result.complete ? 1.0 : 0.0;
  }
  state.counters["solutions"] = found / static_cast<double>(state.iterations());
  state.counters["complete"] = complete / static_cast<double>(state.iterations());
}

void compile(benchmark::State& state, const SerialChain& chain) {
  for (auto _ : state) benchmark::DoNotOptimize(AlgebraicSolver::compile(chain));
}

void forwardKdl(benchmark::State& state) {
  const test::AlgebraicArm arm = test::sixteenArm();
  KDL::Chain chain;
  for (std::size_t i = 0; i < 6; ++i) {
    const test::DhRow next = i < 5 ? arm.rows[i + 1] : test::DhRow{arm.tool_a, arm.tool_alpha, 0.0};
    chain.addSegment(
        KDL::Segment(KDL::Joint(KDL::Joint::RotZ), KDL::Frame::DH(next.a, next.alpha, arm.rows[i].d, 0.0)));
  }
  KDL::ChainFkSolverPos_recursive solver(chain);
  KDL::JntArray q(6);
  KDL::Frame frame;
  const std::vector<VectorX> configurations = configurationsOf(arm.chain());
  std::size_t i = 0;
  for (auto _ : state) {
    q.data = configurations[i++ % kPoses];
    solver.JntToCart(q, frame);
    benchmark::DoNotOptimize(frame);
  }
}

void registerAll() {
  benchmark::RegisterBenchmark("forward_kdl/sixteen", forwardKdl);
  for (const test::AlgebraicArm& arm :
       {test::sixteenArm(), test::offsetWristArm(), test::bentWristArm(), test::parallelArm()}) {
    benchmark::RegisterBenchmark(("algebraic/" + arm.name).c_str(), algebraic, arm.chain());
  }
  test::ArmMaker maker(kSeed);
  benchmark::RegisterBenchmark("algebraic/general 6R", algebraic, test::generalArm(maker, -1));
  benchmark::RegisterBenchmark("algebraic/general 5R1P", algebraic, test::generalArm(maker, 2));
  benchmark::RegisterBenchmark("algebraic/general 4R2P", algebraic, test::twoSlideArm(maker));
  for (const char* name : {"puma560", "ur5", "kr6_r900"}) {
    benchmark::RegisterBenchmark((std::string("nearly ideal/") + name).c_str(), nearlyIdeal, name)
        ->Iterations(kNearlyIdealPoses);
  }
  benchmark::RegisterBenchmark("compile/sixteen", compile, test::sixteenArm().chain());
  benchmark::RegisterBenchmark("compile/general 4R2P", compile, test::twoSlideArm(maker));
}

}  // namespace
}  // namespace screwline

int main(int argc, char** argv) {
  screwline::registerAll();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
