// Self-motions of chains of seven joints, KDL's forward kinematics of six joints beside them as the unit.
#include <benchmark/benchmark.h>

#include "kdl_unit.h"
#include "redundant_arms.h"
#include "robots.h"
#include "screwline/ik/inverse_kinematics.h"
#include "screwline/ik/redundant/self_motion_solver.h"
#include "screwline/kinematics/forward.h"

namespace screwline {
namespace benchmark_support {
namespace {

/// A chain with its solver, and poses that it reaches within limits.
struct Case {
  explicit Case(const SerialChain& chain_in) : chain(chain_in), solver(*SelfMotionSolver::compile(chain)) {
    test::ArmMaker maker(kSeed);
    for (int i = 0; i < 256; ++i) {
      configurations.push_back(test::randomWithin(maker, chain));
      SelfMotionQuestion question;
      question.target = forwardKinematics(chain, configurations.back());
      questions.push_back(question);
    }
  }
  const SelfMotionQuestion& next() { return questions[index++ % questions.size()]; }

  SerialChain chain;
  SelfMotionSolver solver;
  std::vector<VectorX> configurations;
  std::vector<SelfMotionQuestion> questions;
  std::size_t index = 0;
};

void solveAt(benchmark::State& state, const SerialChain& chain) {
  Case arm(chain);
  const int joint = arm.solver.parameterJoint();
  RedundantSolutions solutions;
  for (auto _ : state) {
    const double value = arm.configurations[arm.index % 256][joint];
    arm.solver.oneGiven()->solveAt(arm.next().target, value, Vector7::Zero(), solutions);
    benchmark::DoNotOptimize(solutions);
  }
}

/// The plan alone, on the poses that solveAt() hands to it.
void planAlone(benchmark::State& state, const SerialChain& chain) {
  Case arm(chain);
  const ClosedFormPlan& plan = *arm.solver.oneGiven()->others().plan();
  const std::array<double, kMaxPlanJoints> preferred{};
  std::vector<Pose> targets;
  for (std::size_t i = 0; i < 256; ++i) {
    // With the last joint at zero the plan's pose is the chain's.
    VectorX q = arm.configurations[i];
    q[arm.solver.parameterJoint()] = 0.0;
    targets.push_back(forwardKinematics(chain, q));
  }
  PlanSolutions solutions;
  std::size_t i = 0;
  for (auto _ : state) {
    plan.solve(targets[i++ % 256], preferred.data(), solutions);
    benchmark::DoNotOptimize(solutions);
  }
}

void anyWithinLimits(benchmark::State& state, const SerialChain& chain) {
  Case arm(chain);
  for (auto _ : state) benchmark::DoNotOptimize(arm.solver.anyWithinLimits(arm.next()));
}

void traceAll(benchmark::State& state, const SerialChain& chain) {
  Case arm(chain);
  for (auto _ : state) benchmark::DoNotOptimize(arm.solver.trace(arm.next()));
}

void answerAll(benchmark::State& state, const SerialChain& chain) {
  Case arm(chain);
  for (auto _ : state) benchmark::DoNotOptimize(arm.solver.answer(arm.next()));
}

/// Six joints and the direction of the tool's x axis, about which the last joint does not turn: self-motions.
void answerDirection(benchmark::State& state, const std::string& robot) {
  const InverseKinematics ik(Robot(robot).chain, Task::pointing(0));
  test::ArmMaker maker(kSeed);
  std::vector<IkRequest> requests(256);
  for (IkRequest& request : requests)
    request.target = forwardKinematics(ik.chain(), test::randomWithin(maker, ik.chain()));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(ik.solve(requests[i++ % 256]));
}

void registerAll() {
  benchmark::RegisterBenchmark("forward_kdl/rrprrr", forwardKdl, "rrprrr");
  const std::vector<std::pair<std::string, SerialChain>> arms = {{"iiwa14", test::iiwa14()}, {"panda", test::panda()}};
  for (const auto& arm : arms) {
    const SerialChain& chain = arm.second;
    benchmark::RegisterBenchmark(("plan/" + arm.first).c_str(), planAlone, chain);
    benchmark::RegisterBenchmark(("solve_at/" + arm.first).c_str(), solveAt, chain);
    benchmark::RegisterBenchmark(("any_within_limits/" + arm.first).c_str(), anyWithinLimits, chain);
    benchmark::RegisterBenchmark(("trace/" + arm.first).c_str(), traceAll, chain);
    benchmark::RegisterBenchmark(("answer/" + arm.first).c_str(), answerAll, chain);
  }
  // No closed form with one joint given: elimination; and a plan for three parallel axes.
  test::RedundantArmMaker maker(kSeed);
  for (const auto& [name, kind] : {std::pair("general", test::RedundantArmMaker::kGeneral),
                                   std::pair("rail_ur", test::RedundantArmMaker::kParallelOnRail)}) {
    const SerialChain chain = maker.makeArm(kind, true);
    benchmark::RegisterBenchmark((std::string("answer/") + name).c_str(), answerAll, chain);
    benchmark::RegisterBenchmark((std::string("any_within_limits/") + name).c_str(), anyWithinLimits, chain);
  }
  for (const char* robot : {"puma560", "ur5", "jaco2_6dof"})
    benchmark::RegisterBenchmark((std::string("answer_direction/") + robot).c_str(), answerDirection, robot);
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
