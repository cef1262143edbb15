#ifndef SCREWLINE_BENCHMARK_KDL_UNIT_H
#define SCREWLINE_BENCHMARK_KDL_UNIT_H

#include <benchmark/benchmark.h>

#include <kdl/chainfksolverpos_recursive.hpp>
#include <string>

#include "robots.h"

namespace screwline {
namespace benchmark_support {

/// KDL's forward kinematics of a robot: of six joints, the unit of what is measured beside it.
inline void forwardKdl(benchmark::State& state, const std::string& name) {
  Robot robot(name);
  KDL::ChainFkSolverPos_recursive solver(robot.kdl);
  KDL::JntArray q(static_cast<unsigned>(robot.chain.size()));
  KDL::Frame frame;
  for (auto _ : state) {
    q.data = robot.next();
    solver.JntToCart(q, frame);
    benchmark::DoNotOptimize(frame);
  }
}

}  // namespace benchmark_support
}  // namespace screwline

#endif  // SCREWLINE_BENCHMARK_KDL_UNIT_H
