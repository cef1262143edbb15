// Closed-form inverse kinematics of every robot of urdf/ that has a plan: the plan alone, and all of
// InverseKinematics::solve(). The unit is KDL's forward kinematics of six joints, timed in the same rounds; each figure
// is the least of many rounds.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <kdl/chainfksolverpos_recursive.hpp>

#include "redundant_arms.h"
#include "robots.h"
#include "screwline/ik/closed_form/parallel_plan.h"
#include "screwline/ik/closed_form/plan.h"
#include "screwline/ik/inverse_kinematics.h"
#include "screwline/ik/redundant/redundant_solver.h"
#include "screwline/kinematics/jacobian.h"

namespace screwline {
namespace benchmark_support {
namespace {

constexpr int kRounds = 60;

/// What is timed: `run` does `count` of it.
struct Item {
  std::string name;
  int count = 0;
  std::function<void()> run;
  double solutions = 0.0;
  double best = 1e9;  ///< [ns] for one.
};

template <typename T>
void keep(const T& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

/// The second of two runs: the caches and the branch predictor know it.
double nanoseconds(const std::function<void()>& run) {
  run();
  const auto begin = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
}

std::vector<Pose> targetsOf(const SerialChain& chain, const std::vector<VectorX>& configurations) {
  std::vector<Pose> targets;
  for (const VectorX& q : configurations) targets.push_back(forwardKinematics(chain, q));
  return targets;
}

Item unitOf(const Robot& robot) {
  Item item{"KDL forward kinematics, 6 joints", static_cast<int>(robot.configurations.size()), nullptr};
  item.run = [&robot] {
    KDL::ChainFkSolverPos_recursive solver(robot.kdl);
    KDL::JntArray q(6);
    KDL::Frame frame;
    for (const VectorX& configuration : robot.configurations) {
      q.data = configuration;
      solver.JntToCart(q, frame);
      keep(frame);
    }
  };
  return item;
}

Item forwardOf(const Robot& robot, bool with_jacobian) {
  Item item{with_jacobian ? "forward kinematics and Jacobian, 6 joints" : "forward kinematics, 6 joints",
            static_cast<int>(robot.configurations.size()), nullptr};
  item.run = [&robot, with_jacobian] {
    Matrix6X J(6, robot.chain.size());
    for (const VectorX& q : robot.configurations) {
      const Pose X = with_jacobian ? geometricJacobian(robot.chain, q, J) : forwardKinematics(robot.chain, q);
      keep(X);
    }
  };
  return item;
}

/// Of a ClosedFormPlan or a ParallelPlan.
template <typename Plan, typename Solutions>
Item planItem(const std::string& name, const Plan& plan, const std::vector<Pose>& targets, Solutions solutions) {
  Item item{name + ": plan", static_cast<int>(targets.size()), nullptr};
  const std::array<double, kMaxPlanJoints> preferred{};
  for (const Pose& target : targets) {
    plan.solve(target, preferred.data(), solutions);
    item.solutions += solutions.count / static_cast<double>(targets.size());
  }
  item.run = [plan, targets, preferred] {
    Solutions found;
    for (const Pose& target : targets) {
      plan.solve(target, preferred.data(), found);
      keep(found);
    }
  };
  return item;
}

Item solveItem(const Robot& robot, const std::vector<Pose>& targets, double solutions) {
  Item item{robot.chain.name() + ": InverseKinematics", static_cast<int>(targets.size()), nullptr, solutions};
  const auto solver = std::make_shared<const InverseKinematics>(robot.chain, robot.task);
  item.run = [solver, targets] {
    IkRequest request;
    request.ignore_limits = true;
    for (const Pose& target : targets) {
      request.target = target;
      const IkResult result = solver->solve(request);
      keep(result);
    }
  };
  return item;
}

Item redundantItem(const std::string& name, const SerialChain& chain) {
  const RedundantSolver solver = *RedundantSolver::compile(chain);
  test::ArmMaker maker(kSeed);
  std::vector<VectorX> configurations;
  for (int i = 0; i < 256; ++i) configurations.push_back(test::randomWithin(maker, chain));
  const std::vector<Pose> targets = targetsOf(chain, configurations);
  Item item{name + ": one redundancy value", 256, nullptr};
  item.run = [solver, targets, configurations] {
    RedundantSolutions found;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      solver.solveAt(targets[i], configurations[i][solver.parameterJoint()], Vector7::Zero(), found);
      keep(found);
    }
  };
  return item;
}

void report(const std::vector<Item>& items) {
  std::printf("%-52s %9s %7s %10s\n", "", "ns", "unit", "solutions");
  for (const Item& item : items) {
    std::printf("%-52s %9.1f %7.3f", item.name.c_str(), item.best, item.best / items.front().best);
    if (item.solutions > 0.0) std::printf(" %10.2f", item.solutions);
    std::printf("\n");
  }
}

}  // namespace
}  // namespace benchmark_support
}  // namespace screwline

int main() {
  using namespace screwline;
  using namespace screwline::benchmark_support;
  std::vector<std::string> names = robotNames();
  for (const char* name :
       {"puma560", "kr6_r900", "irb6640", "m10ia", "stanford_arm", "scara_600", "youbot_arm", "ur5", "ur10e"}) {
    names.emplace_back(name);
  }
  const Robot six("rrprrr");
  std::vector<Item> items = {unitOf(six), forwardOf(six, false), forwardOf(six, true)};
  for (const std::string& name : names) {
    const Robot robot(name);
    const std::vector<Pose> targets = targetsOf(robot.chain, robot.configurations);
    if (const auto plan = ClosedFormPlan::compile(robot.chain, robot.task)) {
      items.push_back(planItem(name, *plan, targets, PlanSolutions()));
    } else if (const auto parallel = ParallelPlan::compile(robot.chain)) {
      items.push_back(planItem(name, *parallel, targets, ParallelSolutions()));
    } else {
      continue;
    }
    items.push_back(solveItem(robot, targets, items.back().solutions));
  }
  items.push_back(redundantItem("iiwa14", test::iiwa14()));
  items.push_back(redundantItem("panda", test::panda()));
  for (int round = 0; round < kRounds; ++round) {
    for (Item& item : items) item.best = std::min(item.best, nanoseconds(item.run) / item.count);
  }
  report(items);
  return 0;
}
