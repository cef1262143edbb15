#include "solution_loop.h"

#include <algorithm>
#include <cmath>

#include "screwline/spatial/rotation.h"
#include "solution_curve.h"

namespace screwline {
namespace {

constexpr double kOffFolds = 0.0137;  // Of the way round: no sample at a place where arcs meet.

/// From stretch to stretch, one elbow after the other, until it closes.
std::vector<LoopArc> traced(const std::vector<SheetStretch>& stretches, std::size_t first, int elbow,
                            std::vector<std::array<bool, 2>>& seen) {
  std::vector<LoopArc> arcs;
  const std::size_t count = stretches.size();
  std::size_t i = first;
  bool upwards = true;
  while (!seen[i][elbow > 0 ? 0 : 1]) {
    const SheetStretch& stretch = stretches[i];
    seen[i][elbow > 0 ? 0 : 1] = true;
    arcs.push_back({upwards ? stretch.from : stretch.to, upwards ? stretch.to : stretch.from, {0, elbow, 0}});
    if (stretch.whole) break;
    if (upwards ? stretch.passes_to : stretch.passes_from) {
      i = (i + (upwards ? 1 : count - 1)) % count;
    } else {
      upwards = !upwards;
    }
    elbow = -elbow;
  }
  return arcs;
}

}  // namespace

SolutionLoops loopsOfPair(const ParallelPlan& plan, const SerialChain& chain, const Pose& target) {
  SolutionLoops found;
  for (const ParallelSheet& sheet : plan.sheets(target)) {
    const auto member = [sheet](const LoopArc& arc, double value, const MemberVector&) {
      const PlanSolution solution = sheet.member(value, arc.sign[1]);
      return MemberVector(Eigen::Map<const Vector6>(solution.q.data()));
    };
    const std::vector<SheetStretch> stretches = sheet.stretches();
    std::vector<std::array<bool, 2>> seen(stretches.size());
    for (std::size_t i = 0; i < stretches.size(); ++i) {
      const SheetStretch& stretch = stretches[i];
      PlanSolution some = sheet.member(stretch.from, 1);
      if (stretch.isPoint()) {
        some.free = 0;
        found.points.push_back(some);
        continue;
      }
      for (int elbow : {1, -1}) {
        if (stretch.straight && elbow < 0) break;
        std::vector<LoopArc> arcs =
            stretch.straight ? std::vector<LoopArc>{{stretch.from, stretch.to, {}}} : traced(stretches, i, elbow, seen);
        for (LoopArc& arc : arcs) arc.sign = {some.sign[0], arc.sign[1], some.sign[2]};
        if (!arcs.empty()) found.loops.emplace_back(chain, sheet.joint(), std::move(arcs), member);
      }
    }
  }
  return found;
}

SolutionLoop::SolutionLoop(const SerialChain& chain, int joint, std::vector<LoopArc> arcs, ArcMember member)
    : chain_(&chain), joint_(joint), arcs_(std::move(arcs)), member_(std::move(member)) {}

std::array<int, 3> SolutionLoop::sign() const {
  std::array<int, 3> sign = arcs_.front().sign;
  for (const LoopArc& arc : arcs_) {
    for (std::size_t i = 0; i < 3; ++i) sign[i] = arc.sign[i] == sign[i] ? sign[i] : 0;
  }
  return sign;
}

MemberVector SolutionLoop::at(double u, const MemberVector& near) const {
  const double way = (u - std::floor(u)) * static_cast<double>(arcs_.size());
  const auto index = std::min(static_cast<std::size_t>(way), arcs_.size() - 1);
  const LoopArc& arc = arcs_[index];
  const double share = way - static_cast<double>(index);
  // Towards a fold the branches meet as a square root does; by the cosine the way runs through it evenly.
  const double value = arcs_.size() == 1
                           ? arc.from + share * (arc.to - arc.from)
                           : 0.5 * (arc.from + arc.to) + 0.5 * (arc.from - arc.to) * std::cos(kPi * share);
  MemberVector member = member_(arc, value, near);
  bringNear(*chain_, near, member);
  return member;
}

WayRound SolutionLoop::round() const {
  const auto member = [loop = *this](double u, const MemberVector& near, MemberVector& q) {
    q = loop.at(u, near);
    return true;
  };
  // In a fold itself members are known to the root of rounding only: too little for a tangent.
  return {member, kOffFolds, 1.0};
}

}  // namespace screwline
