// Whether inverse kinematics finds what it is asked for: of random configurations, the one that made the pose has to be
// among the solutions of that pose, no solution twice, none wrong. Prints a Markdown table (doc/coverage.md).
//
//     coverage [POSES] [ROBOT...]
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "ik_gate.h"
#include "shipped_robots.h"
#include "singular_poses.h"

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261127;
constexpr double kSame = 1e-6;         // [rad, m]
constexpr double kWrong = 1e-9;        // [m, rad] of forward kinematics.
constexpr int kRedundantShare = 1000;  // So many times fewer poses where a pose has curves, not points, of solutions.

struct Count {
  int poses = 0;
  int lost = 0;
  int lost_as_complete = 0;
  int repeated = 0;
  int wrong = 0;
  int incomplete = 0;
  long solutions = 0;
  double worst_error = 0.0;
};

/// `given`: of a redundant chain, the joint whose value is given; -1: none.
void examine(const InverseKinematics& ik, const VectorX& q, int given, Count& count) {
  const SerialChain& chain = ik.chain();
  const test::IkGate gate(ik, q, true);
  IkRequest request = gate.request();
  if (given >= 0) request.redundancy = {q[given]};
  const IkResult result = ik.solve(request);
  ++count.poses;
  count.solutions += static_cast<long>(result.solutions.size());
  count.incomplete += result.complete ? 0 : 1;
  const bool known = gate.isKnown(q, result, test::placeTolerance(chain, ik.task(), q));
  count.lost += known ? 0 : 1;
  count.lost_as_complete += !known && result.complete ? 1 : 0;
  for (std::size_t i = 0; i < result.solutions.size(); ++i) {
    const VectorX& position = result.solutions[i].position;
    const double error = taskError(ik.task(), request.target, forwardByExponentials(chain, position)).norm();
    count.worst_error = std::max(count.worst_error, error);
    count.wrong += error <= kWrong ? 0 : 1;
    for (std::size_t k = 0; k < i; ++k) {
      if (test::jointDifference(chain, position, result.solutions[k].position) <= kSame) ++count.repeated;
    }
  }
}

void run(const std::string& name, int poses) {
  const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, name);
  const InverseKinematics ik(robot.chain, robot.task);
  test::SingularPoses maker(robot.chain, kSeed);
  Count count;
  const std::optional<InverseOutline> outline = ik.outline();
  const int given = outline ? outline->given : -1;
  if (robot.chain.size() > robot.task.size() && given < 0) poses = std::max(1, poses / kRedundantShare);
  for (int k = 0; k < poses; ++k) examine(ik, maker.regular(), given, count);
  const std::string label = given < 0 ? name : name + ", " + robot.chain.joint(given).name + " given";
  std::printf("| %s | %d | %d | %d | %d | %d | %d | %.2f | %.1e |\n", label.c_str(), count.poses, count.lost,
              count.lost_as_complete, count.repeated, count.wrong, count.incomplete,
              static_cast<double>(count.solutions) / count.poses, count.worst_error);
  std::fflush(stdout);
}

}  // namespace
}  // namespace screwline

int main(int argc, char** argv) {
  const int poses = argc > 1 ? std::atoi(argv[1]) : 10000;
  std::vector<std::string> names(argv + std::min(argc, 2), argv + argc);
  if (names.empty()) names = screwline::test::shippedRobotNames();
  std::printf(
      "| robot | poses | lost | of these, said complete | repeated | wrong | not complete | solutions of a pose | "
      "worst "
      "error |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const std::string& name : names) screwline::run(name, poses);
  return 0;
}
