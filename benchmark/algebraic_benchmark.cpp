// All solutions of a pose by elimination, for arms without a closed form; KDL's forward kinematics of the first arm in
// the same run as unit.
#include <benchmark/benchmark.h>

#include <kdl/chainfksolverpos_recursive.hpp>

#include "../test/algebraic_arms.h"
#include "screwline/ik/algebraic/algebraic_solver.h"
#include "screwline/kinematics/forward.h"

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261124;
constexpr std::size_t kPoses = 1024;

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
