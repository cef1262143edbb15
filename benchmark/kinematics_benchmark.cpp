// Forward kinematics, Jacobian and closed-form inverse kinematics of every shipped robot, KDL beside them on the same
// configurations.
#include <benchmark/benchmark.h>

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#include <kdl/chainjnttojacsolver.hpp>

#include "kdl_unit.h"
#include "robots.h"
#include "screwline/ik/closed_form/plan.h"
#include "screwline/ik/inverse_kinematics.h"
#include "screwline/kinematics/jacobian.h"

namespace screwline {
namespace benchmark_support {
namespace {

void forward(benchmark::State& state, const std::string& name) {
  Robot robot(name);
  for (auto _ : state) benchmark::DoNotOptimize(forwardKinematics(robot.chain, robot.next()));
}

void forwardAndJacobian(benchmark::State& state, const std::string& name) {
  Robot robot(name);
  Matrix6X J(6, robot.chain.size());
  for (auto _ : state) {
    benchmark::DoNotOptimize(geometricJacobian(robot.chain, robot.next(), J));
    benchmark::DoNotOptimize(J.data());
    benchmark::ClobberMemory();
  }
}

void forwardAndJacobianKdl(benchmark::State& state, const std::string& name) {
  Robot robot(name);
  KDL::ChainFkSolverPos_recursive forward_solver(robot.kdl);
  KDL::ChainJntToJacSolver jacobian_solver(robot.kdl);
  KDL::JntArray q(static_cast<unsigned>(robot.chain.size()));
  KDL::Jacobian J(static_cast<unsigned>(robot.chain.size()));
  KDL::Frame frame;
  for (auto _ : state) {
    q.data = robot.next();
    forward_solver.JntToCart(q, frame);
    jacobian_solver.JntToJac(q, J);
    benchmark::DoNotOptimize(frame);
    benchmark::DoNotOptimize(J.data.data());
    benchmark::ClobberMemory();
  }
}

std::vector<Pose> targetsOf(Robot& robot) {
  std::vector<Pose> targets;
  for (const VectorX& q : robot.configurations) targets.push_back(forwardKinematics(robot.chain, q));
  return targets;
}

/// All solutions, as the solver's core gives them (turns, limits and verification are the caller's).
void closedForm(benchmark::State& state, const std::string& name) {
  Robot robot(name);
  const std::optional<ClosedFormPlan> plan = ClosedFormPlan::compile(robot.chain, robot.task);
  if (!plan) {
    state.SkipWithError("no closed form");
    return;
  }
  const std::vector<Pose> targets = targetsOf(robot);
  const VectorX preferred = VectorX::Zero(robot.chain.size());
  PlanSolutions solutions;
  std::size_t i = 0;
  double count = 0.0;
  for (auto _ : state) {
    plan->solve(targets[i++ % targets.size()], preferred.data(), solutions);
    benchmark::DoNotOptimize(solutions);
    count += solutions.count;
  }
  state.counters["solutions"] = benchmark::Counter(count, benchmark::Counter::kAvgIterations);
}

/// All solutions, verified, named, turned, within limits: what a service call costs beside the transport.
void verified(benchmark::State& state, const std::string& name) {
  Robot robot(name);
  const InverseKinematics ik(robot.chain, robot.task);
  const std::vector<Pose> targets = targetsOf(robot);
  IkRequest request;
  request.ignore_limits = true;
  std::size_t i = 0;
  for (auto _ : state) {
    request.target = targets[i++ % targets.size()];
    benchmark::DoNotOptimize(ik.solve(request));
  }
}

/// One solution by KDL's Newton-Raphson with joint limits, from zero: for arms of six joints only, as it knows no task
/// rows.
void newtonKdl(benchmark::State& state, const std::string& name) {
  Robot robot(name);
  KDL::ChainFkSolverPos_recursive forward_solver(robot.kdl);
  KDL::ChainIkSolverVel_pinv velocity_solver(robot.kdl);
  const auto n = static_cast<unsigned>(robot.chain.size());
  KDL::JntArray lower(n);
  KDL::JntArray upper(n);
  lower.data = robot.chain.lower().cwiseMax(-10.0);
  upper.data = robot.chain.upper().cwiseMin(10.0);
  KDL::ChainIkSolverPos_NR_JL solver(robot.kdl, lower, upper, forward_solver, velocity_solver, 100, 1e-9);
  KDL::JntArray q(n);
  KDL::JntArray start(n);
  KDL::JntArray found(n);
  KDL::Frame frame;
  double solved = 0.0;
  for (auto _ : state) {
    q.data = robot.next();
    forward_solver.JntToCart(q, frame);
    solved += solver.CartToJnt(start, frame, found) >= 0 ? 1.0 : 0.0;
    benchmark::DoNotOptimize(found.data.data());
  }
  state.counters["solved"] = benchmark::Counter(solved, benchmark::Counter::kAvgIterations);
}

void registerAll() {
  for (const std::string& name : robotNames()) {
    benchmark::RegisterBenchmark(("forward/" + name).c_str(), forward, name);
    benchmark::RegisterBenchmark(("forward_kdl/" + name).c_str(), forwardKdl, name);
    benchmark::RegisterBenchmark(("forward_and_jacobian/" + name).c_str(), forwardAndJacobian, name);
    benchmark::RegisterBenchmark(("forward_and_jacobian_kdl/" + name).c_str(), forwardAndJacobianKdl, name);
    benchmark::RegisterBenchmark(("inverse_closed_form/" + name).c_str(), closedForm, name);
    benchmark::RegisterBenchmark(("inverse_verified/" + name).c_str(), verified, name);
  }
  benchmark::RegisterBenchmark("inverse_newton_kdl/rrprrr", newtonKdl, std::string("rrprrr"));
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
