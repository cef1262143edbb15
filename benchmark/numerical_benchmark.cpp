// One solution within limits, by numerical search and by KDL, for arms of published dimensions: reachable poses at
// random, seeds at random within limits, the same for all. numerical_benchmark [POSES] [TIMEOUT in s]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>

#include "published_arms.h"
#include "screwline/ik/numerical/numerical_solver.h"

namespace screwline {
namespace {

using Clock = std::chrono::steady_clock;

constexpr unsigned kSeed = 20261122;
constexpr double kAccepted = 1e-9;

struct Question {
  Pose target;
  VectorX seed;
};

/// Whether it found one, which is put into q.
using Solver = std::function<bool(const Question&, VectorX& q)>;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool isAnswer(const SerialChain& chain, const Task& task, const Pose& target, const VectorX& q) {
  const TaskError error = taskError(task, target, forwardKinematics(chain, q));
  return error.position < kAccepted && error.orientation < kAccepted &&
         (chain.clamped(q) - q).cwiseAbs().maxCoeff() == 0.0;
}

void measure(const char* who, const SerialChain& chain, const Task& task, const std::vector<Question>& questions,
             const Solver& solver) {
  std::vector<double> times;
  int solved = 0;
  int wrong = 0;
  double sum = 0.0;
  VectorX q;
  for (const Question& question : questions) {
    const Clock::time_point start = Clock::now();
    const bool found = solver(question, q);
    times.push_back(1e6 * since(start));
    sum += times.back();
    if (found) ++(isAnswer(chain, task, question.target, q) ? solved : wrong);
  }
  std::sort(times.begin(), times.end());
  const std::size_t count = times.size();
  std::printf("%-18s %d rows  %-22s %9.4f %%  wrong %d  mean %8.1f us  p50 %8.1f  p99 %8.1f  max %8.1f\n",
              chain.name().c_str(), task.size(), who, 100.0 * solved / static_cast<double>(count), wrong,
              sum / static_cast<double>(count), times[count / 2], times[count * 99 / 100], times.back());
  std::fflush(stdout);
}

KDL::Chain kdlChain(const test::PublishedArm& arm) {
  KDL::Chain chain;
  // KDL's DH_Craig1989 segments turn before they go on: the joint's frame first, then the joint.
  for (const test::ArmJoint& row : arm.joints) {
    chain.addSegment(
        KDL::Segment(KDL::Joint(KDL::Joint::None), KDL::Frame::DH_Craig1989(row.a, row.alpha, row.d, row.theta)));
    chain.addSegment(KDL::Segment(KDL::Joint(row.prismatic ? KDL::Joint::TransZ : KDL::Joint::RotZ)));
  }
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), KDL::Frame(KDL::Vector(0, 0, arm.tool))));
  return chain;
}

KDL::Frame toKdl(const Pose& X) {
  KDL::Frame frame;
  for (int i = 0; i < 3; ++i) {
    frame.p[i] = X.p[i];
    for (int j = 0; j < 3; ++j) frame.M(i, j) = X.R(i, j);
  }
  return frame;
}

/// A KDL solver from the seed, then from random starts within limits, until time is up.
template <typename KdlSolver>
Solver withRestarts(const SerialChain& chain, KdlSolver& solver, double timeout) {
  return [&chain, &solver, timeout, random = std::mt19937(kSeed)](const Question& question, VectorX& q) mutable {
    const Clock::time_point begin = Clock::now();
    const auto n = static_cast<unsigned>(chain.size());
    KDL::JntArray start(n);
    KDL::JntArray end(n);
    const KDL::Frame target = toKdl(question.target);
    start.data = question.seed;
    do {
      if (solver.CartToJnt(start, target, end) >= 0) {
        q = end.data;
        for (int i = 0; i < chain.size(); ++i) {
          const JointLimits& limits = chain.joint(i).limits;
          if (!chain.joint(i).isRevolute()) continue;
          while (q[i] > limits.upper) q[i] -= kTwoPi;
          while (q[i] < limits.lower) q[i] += kTwoPi;
        }
        if (isAnswer(chain, Task(), question.target, q)) return true;
      }
      start.data = test::randomWithinLimits(chain, random);
    } while (since(begin) < timeout);
    return false;
  };
}

void compareKdl(const test::PublishedArm& arm, const SerialChain& chain, const std::vector<Question>& questions,
                double timeout) {
  const KDL::Chain kdl = kdlChain(arm);
  const auto n = static_cast<unsigned>(chain.size());
  // Metres and radians alike, to what is asked for.
  const Eigen::Matrix<double, 6, 1> weights = Eigen::Matrix<double, 6, 1>::Ones();
  KDL::ChainIkSolverPos_LMA lma(kdl, weights, 1e-10, 100, 1e-15);
  measure("KDL LMA + restarts", chain, Task(), questions, withRestarts(chain, lma, timeout));
  KDL::JntArray lower(n);
  KDL::JntArray upper(n);
  lower.data = chain.lower();
  upper.data = chain.upper();
  KDL::ChainFkSolverPos_recursive forward(kdl);
  KDL::ChainIkSolverVel_pinv velocity(kdl);
  KDL::ChainIkSolverPos_NR_JL newton(kdl, lower, upper, forward, velocity, 100, 1e-10);
  measure("KDL NR_JL + restarts", chain, Task(), questions, withRestarts(chain, newton, timeout));
}

void run(const test::PublishedArm& arm, const Task& task, int poses, double timeout) {
  const SerialChain chain = chainOf(arm);
  std::mt19937 random(kSeed);
  std::vector<Question> questions;
  for (int k = 0; k < poses; ++k) {
    const Pose target = forwardKinematics(chain, test::randomWithinLimits(chain, random));
    questions.push_back({target, test::randomWithinLimits(chain, random)});
  }
  SearchOptions options;
  options.max_solutions = 1;
  options.timeout = timeout;
  options.restarts = 1 << 20;
  measure("screwline", chain, task, questions, [&](const Question& question, VectorX& q) {
    const SearchResult result = search(chain, task, question.target, {question.seed}, options);
    if (result.solutions.empty()) return false;
    q = result.solutions.front();
    return true;
  });
  if (task.size() < 6) return;  // KDL knows no task rows.
  questions.resize(std::min(questions.size(), static_cast<std::size_t>(std::max(1, poses / 10))));
  compareKdl(arm, chain, questions, timeout);
}

}  // namespace
}  // namespace screwline

int main(int argc, char** argv) {
  using namespace screwline;
  const int poses = argc > 1 ? std::atoi(argv[1]) : 100000;
  const double timeout = argc > 2 ? std::atof(argv[2]) : 0.005;
  for (const test::PublishedArm& arm : {test::puma560(), test::ur5(), test::panda(), test::iiwa14(), test::general6(),
                                        test::iiwaOnRail(), test::pandaOnPlatform()}) {
    run(arm, Task(), poses, timeout);
  }
  run(test::youbot(), Task::fromRows({0, 1, 2}), poses, timeout);
  run(test::youbot(), Task::fromRows({0, 1, 2, 3, 4}), poses, timeout);
  run(test::panda(), Task::fromRows({0, 1, 2}), poses, timeout);
  return 0;
}
