// Inverse kinematics at singular poses of every kind and beside them, for all robots: what is answered, what is lost,
// and how long it takes. Prints Markdown (doc/singular_sweep.md); with a second argument, every cell as CSV to that
// file.
//
//     singular_sweep [POSES] [CSV]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "ik_gate.h"
#include "shipped_robots.h"
#include "singular_poses.h"
#include "singular_search.h"

namespace screwline {
namespace {

constexpr unsigned kSeed = 20261125;
constexpr int kRegularPoses = 200;
constexpr int kTimings = 5;     // Of each pose; the least counts.
constexpr int kRestarts = 200;  // Of the search that counts solutions, at one pose of each cell.

/// Sums over poses.
struct Cell {
  int poses = 0;
  int answered = 0;
  int lost = 0;
  int lied = 0;  ///< Lost although the list is said to be complete.
  int searched = 0;
  int missed = 0;
  int merged = 0;
  int repeated = 0;
  int complete = 0;
  int continua = 0;
  int not_nearest = 0;
  int seed_not_first = 0;
  double worst_error = 0.0;
  double time = 0.0;     ///< [s], all poses.
  double longest = 0.0;  ///< [s] of one pose.

  void add(const Cell& other) {
    poses += other.poses;
    answered += other.answered;
    lost += other.lost;
    lied += other.lied;
    searched += other.searched;
    missed += other.missed;
    merged += other.merged;
    repeated += other.repeated;
    complete += other.complete;
    continua += other.continua;
    not_nearest += other.not_nearest;
    seed_not_first += other.seed_not_first;
    worst_error = std::max(worst_error, other.worst_error);
    time += other.time;
    longest = std::max(longest, other.longest);
  }
};

double secondsOf(const InverseKinematics& ik, const VectorX& q) {
  const IkRequest request = test::IkGate(ik, q, true).request();
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kTimings && (k == 0 || least < 5e-3); ++k) {
    timespec begin{};
    timespec end{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
    ik.solve(request);
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
    least = std::min(least, static_cast<double>(end.tv_sec - begin.tv_sec) +
                                1e-9 * static_cast<double>(end.tv_nsec - begin.tv_nsec));
  }
  return least;
}

void examine(const InverseKinematics& ik, const VectorX& q, bool search, Cell& cell) {
  const test::GateVerdict verdict = test::IkGate(ik, q, true).judge(VectorX::LinSpaced(ik.chain().size(), 8e-4, -5e-4));
  ++cell.poses;
  cell.answered += verdict.answered && verdict.finite ? 1 : 0;
  cell.lost += verdict.lost ? 1 : 0;
  cell.lied += verdict.lost && verdict.complete ? 1 : 0;
  cell.merged += verdict.merged ? 1 : 0;
  cell.repeated += verdict.repeated ? 1 : 0;
  cell.complete += verdict.complete ? 1 : 0;
  cell.continua += verdict.continua > 0 ? 1 : 0;
  cell.not_nearest += verdict.seed_value_kept ? 0 : 1;
  cell.seed_not_first += verdict.seed_first ? 0 : 1;
  cell.worst_error = std::max(cell.worst_error, verdict.worst_error);
  const double time = secondsOf(ik, q);
  cell.time += time;
  cell.longest = std::max(cell.longest, time);
  if (!search) return;
  ++cell.searched;
  cell.missed += test::missedSolutions(ik, q, kRestarts);
}

const char* const kColumns =
    "| poses | answered | lost | lost, said complete | missed by a search's count (of poses) | merged | repeated | "
    "seed not first | not the nearest member | complete | with continua | worst FK error | time / regular |";

void printRow(const std::string& name, const Cell& cell, double regular) {
  std::printf("| %s | %d | %d | %d | %d | %d (%d) | %d | %d | %d | %d | %d | %d | %.1e | %.2f |\n", name.c_str(),
              cell.poses, cell.answered, cell.lost, cell.lied, cell.missed, cell.searched, cell.merged, cell.repeated,
              cell.seed_not_first, cell.not_nearest, cell.complete, cell.continua, cell.worst_error,
              cell.time / std::max(cell.poses, 1) / regular);
}

void printHead(const std::string& first) {
  std::printf("\n| %s %s\n|---|", first.c_str(), kColumns);
  for (int i = 0; i < 13; ++i) std::printf("---|");
  std::printf("\n");
}

class Sweep {
 public:
  Sweep(int poses, const std::string& csv) : poses_(poses) {
    if (csv.empty()) return;
    csv_.open(csv);
    csv_ << "robot,kind,offset,poses,answered,lost,said_complete,searched,missed,merged,repeated,seed_not_first,"
            "not_nearest,complete,continua,worst_error,time_over_regular,longest_over_regular\n";
  }

  void run(const std::string& name) {
    const test::ShippedRobot robot = test::shippedRobot(SCREWLINE_SOURCE_DIR, name);
    const InverseKinematics ik(robot.chain, robot.task);
    test::SingularPoses maker(robot.chain, kSeed);
    Cell regular;
    const int count = robot.chain.size() > robot.task.size() ? kRegularPoses / 10 : kRegularPoses;
    for (int k = 0; k < count; ++k) examine(ik, maker.regular(), k == 0, regular);
    const double usual = regular.time / regular.poses;
    std::printf("\n### %s\n\n%s: %s. Regular: %.1f us.\n", name.c_str(), name.c_str(), ik.method().c_str(),
                1e6 * usual);
    printHead("kind");
    printRow("regular", regular, usual);
    for (const test::SingularKind& kind : test::singularKindsOf(robot.chain, robot.task)) {
      Cell row;
      for (double offset : test::singularOffsets()) {
        Cell cell;
        for (int k = 0; k < poses_; ++k) {
          const std::optional<VectorX> q = maker.make(kind, offset);
          if (q) examine(ik, *q, k == 0, cell);
        }
        note(name, kind.name, offset, cell, usual);
        row.add(cell);
        Cell relative = cell;
        relative.time /= usual;
        by_offset_[offset].add(relative);
      }
      if (row.poses > 0) printRow(kind.name, row, usual);
      Cell relative = row;
      relative.time /= usual;
      relative.longest /= usual;
      all_.add(relative);
    }
    std::fflush(stdout);
  }

  void summarize() {
    std::printf("\n## All robots, by offset\n");
    printHead("offset [rad, m]");
    for (const auto& [offset, cell] : by_offset_) {
      char text[32];
      std::snprintf(text, sizeof(text), "%g", offset);
      printRow(text, cell, 1.0);
    }
    printRow("all", all_, 1.0);
  }

 private:
  void note(const std::string& robot, const std::string& kind, double offset, const Cell& cell, double usual) {
    if (!csv_.is_open() || cell.poses == 0) return;
    csv_ << robot << ',' << kind << ',' << offset << ',' << cell.poses << ',' << cell.answered << ',' << cell.lost
         << ',' << cell.lied << ',' << cell.searched << ',' << cell.missed << ',' << cell.merged << ',' << cell.repeated
         << ',' << cell.seed_not_first << ',' << cell.not_nearest << ',' << cell.complete << ',' << cell.continua << ','
         << cell.worst_error << ',' << cell.time / cell.poses / usual << ',' << cell.longest / usual << '\n';
  }

  int poses_;
  std::ofstream csv_;
  std::map<double, Cell> by_offset_;
  Cell all_;
};

}  // namespace
}  // namespace screwline

int main(int argc, char** argv) {
  using screwline::Sweep;
  const int poses = argc > 1 ? std::atoi(argv[1]) : 10;
  Sweep sweep(poses, argc > 2 ? argv[2] : "");
  std::printf(
      "# Singular poses\n\n"
      "Made by `benchmark/singular_sweep %d`. For every robot of `urdf/`, poses of random configurations that are\n"
      "singular in one way, two ways or all ways at once, and beside that by 0, 1e-12, 1e-11, ... 1e-3 of the joints\n"
      "that make them so; limits are ignored. How they are made from the chain's geometry: `test/singular_poses.h`;\n"
      "what is asked of each: `test/ik_gate.h`.\n\n"
      "- answered: without a seed, with the configuration as the seed, and with a seed beside it.\n"
      "- lost: the configuration that made the pose is neither among the solutions nor on one of the continua.\n"
      "- missed: a search from %d starts found a solution that is in no answer (one pose of each robot, kind, "
      "offset).\n"
      "  Solutions are refined to rounding first: beside a continuum all of its members come near to the pose, and are "
      "none.\n"
      "- merged: two roots farther apart than 4e-6 have one answer. Repeated: one root has two.\n"
      "- not the nearest member: of a continuum, another member is nearer to the seed.\n"
      "- time: mean over the poses, over the mean of the same robot's regular poses.\n",
      poses, screwline::kRestarts);
  for (const std::string& name : screwline::test::shippedRobotNames()) sweep.run(name);
  sweep.summarize();
  return 0;
}
