// Loops of which the plan gives single solutions only.
#include <algorithm>
#include <cmath>
#include <limits>

#include "screwline/spatial/rotation.h"
#include "solution_loop.h"

namespace screwline {
namespace {

constexpr int kSamples = 180;      // Of the free joint's turn, where branches are looked for.
constexpr double kPoint = 1e-9;    // [rad] An arc that is shorter is a point.
constexpr double kSameEnd = 1e-5;  // [rad] Ends of arcs are folds, known to the square root of rounding.

/// Solutions with only `joint` free and set to `value`.
class Sheets {
 public:
  Sheets(const ParallelPlan& plan, const Pose& target, const VectorX& seed, int joint)
      : plan_(&plan), target_(target), preferred_(seed), joint_(joint) {}

  const std::vector<PlanSolution>& at(double value) {
    preferred_[joint_] = value;
    ParallelSolutions solutions;
    plan_->solve(target_, preferred_.data(), solutions);
    found_.clear();
    for (int k = 0; k < solutions.count; ++k) {
      const PlanSolution& solution = solutions.solutions[static_cast<std::size_t>(k)];
      const bool clamped = (solutions.clamped >> k & 1U) != 0U;
      if (solution.free == 1U << joint_ && !clamped) found_.push_back(solution);
    }
    return found_;
  }

  bool exists(double value, const std::array<int, 3>& sign, PlanSolution& solution) {
    for (const PlanSolution& one : at(value)) {
      if (one.sign != sign) continue;
      solution = one;
      return true;
    }
    return false;
  }

  /// The last value towards `outside` where the branch exists.
  double end(double inside, double outside, const std::array<int, 3>& sign) {
    PlanSolution solution;
    for (int i = 0; i < 60 && inside != outside; ++i) {
      const double middle = 0.5 * (inside + outside);
      if (middle == inside || middle == outside) break;
      (exists(middle, sign, solution) ? inside : outside) = middle;
    }
    return inside;
  }

 private:
  const ParallelPlan* plan_;
  Pose target_;
  VectorX preferred_;
  int joint_;
  std::vector<PlanSolution> found_;
};

std::vector<double> sampledValues(const VectorX& seed, int joint) {
  std::vector<double> values;
  const double first = wrapAngle(seed[joint]);
  for (int i = 0; i < kSamples; ++i) values.push_back(wrapAngle(first + kTwoPi * i / kSamples));
  std::sort(values.begin(), values.end());
  return values;
}

/// Runs of neighbouring samples that have the branch, their ends refined.
std::vector<LoopArc> arcsOf(Sheets& sheets, const std::vector<double>& values, const std::vector<bool>& present,
                            const std::array<int, 3>& sign) {
  std::vector<LoopArc> arcs;
  const std::size_t count = values.size();
  const auto absent = std::find(present.begin(), present.end(), false);
  if (absent == present.end()) return {{values.front(), values.front() + kTwoPi, sign}};
  const auto start = static_cast<std::size_t>(absent - present.begin());
  const auto valueAt = [&](std::size_t i) { return values[i % count] + (i >= count ? kTwoPi : 0.0); };
  for (std::size_t i = start; i < start + count; ++i) {
    if (present[i % count] || !present[(i + 1) % count]) continue;
    std::size_t last = i + 1;
    while (present[(last + 1) % count]) ++last;
    arcs.push_back(
        {sheets.end(valueAt(i + 1), valueAt(i), sign), sheets.end(valueAt(last), valueAt(last + 1), sign), sign});
    i = last;
  }
  return arcs;
}

/// Arcs put end to end where they meet.
std::vector<std::vector<LoopArc>> chained(Sheets& sheets, const SerialChain& chain, std::vector<LoopArc> arcs) {
  const auto endOf = [&](const LoopArc& arc, double value) {
    PlanSolution solution;
    sheets.exists(value, arc.sign, solution);
    return jointsOf(solution, 6);
  };
  std::vector<std::vector<LoopArc>> loops;
  while (!arcs.empty()) {
    std::vector<LoopArc> loop = {arcs.back()};
    arcs.pop_back();
    for (bool grown = std::abs(loop.front().to - loop.front().from) < kTwoPi - kPoint; grown;) {
      grown = false;
      const VectorX open = endOf(loop.back(), loop.back().to);
      for (std::size_t i = 0; i < arcs.size() && !grown; ++i) {
        LoopArc next = arcs[i];
        if (largestDifference(chain, endOf(next, next.from), open) > kSameEnd) std::swap(next.from, next.to);
        if (largestDifference(chain, endOf(next, next.from), open) > kSameEnd) continue;
        loop.push_back(next);
        arcs.erase(arcs.begin() + static_cast<std::ptrdiff_t>(i));
        grown = true;
      }
    }
    loops.push_back(loop);
  }
  return loops;
}

/// Where there is none, which rounding can leave at an end, the one next to `near`: in a fold itself the branch has its
/// neutral sign.
MemberVector memberNear(Sheets& sheets, const SerialChain& chain, const LoopArc& arc, double value,
                        const MemberVector& near) {
  PlanSolution solution;
  if (sheets.exists(value, arc.sign, solution)) return jointsOf(solution, 6);
  MemberVector nearest = near;
  double least = std::numeric_limits<double>::infinity();
  for (const PlanSolution& one : sheets.at(value)) {
    const VectorX q = jointsOf(one, 6);
    const double distance = largestDifference(chain, q, near);
    if (distance >= least) continue;
    least = distance;
    nearest = q;
  }
  return nearest;
}

}  // namespace

SolutionLoops sampledLoops(const ParallelPlan& plan, const SerialChain& chain, const Pose& target, const VectorX& seed,
                           int joint) {
  Sheets sheets(plan, target, seed, joint);
  const std::vector<double> values = sampledValues(seed, joint);
  std::vector<std::pair<std::array<int, 3>, std::vector<bool>>> presence;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (const PlanSolution& solution : sheets.at(values[i])) {
      auto known = std::find_if(presence.begin(), presence.end(),
                                [&](const auto& entry) { return entry.first == solution.sign; });
      if (known == presence.end())
        known = presence.insert(presence.end(), {solution.sign, std::vector<bool>(values.size(), false)});
      known->second[i] = true;
    }
  }
  std::vector<LoopArc> arcs;
  std::vector<PlanSolution> single;
  for (const auto& [sign, present] : presence) {
    for (const LoopArc& arc : arcsOf(sheets, values, present, sign)) {
      PlanSolution point;
      if (arc.to - arc.from > kPoint) {
        arcs.push_back(arc);
      } else if (sheets.exists(arc.from, sign, point)) {
        single.push_back(point);
      }
    }
  }
  SolutionLoops found;
  for (std::vector<LoopArc>& loop : chained(sheets, chain, arcs)) {
    found.loops.emplace_back(chain, joint, std::move(loop),
                             [sheets, &chain](const LoopArc& arc, double value, const MemberVector& near) mutable {
                               return memberNear(sheets, chain, arc, value, near);
                             });
  }
  // A fold that was hit exactly is no solution of its own.
  for (PlanSolution& point : single) {
    const VectorX q = jointsOf(point, 6);
    const bool is_fold = std::any_of(arcs.begin(), arcs.end(), [&](const LoopArc& arc) {
      PlanSolution end;
      return (sheets.exists(arc.from, arc.sign, end) && largestDifference(chain, jointsOf(end, 6), q) <= kSameEnd) ||
             (sheets.exists(arc.to, arc.sign, end) && largestDifference(chain, jointsOf(end, 6), q) <= kSameEnd);
    });
    point.free = 0;
    if (!is_fold) found.points.push_back(point);
  }
  return found;
}

}  // namespace screwline
