#include "screwline/ik/closed_form/planar_problem.h"

#include <algorithm>

#include "screwline/model/structure.h"

namespace screwline {

std::optional<PlanarProblem> PlanarProblem::compile(const Turn& first_link, const Turn& second_link, double length) {
  PlanarProblem problem;
  problem.first_link_ = first_link;
  problem.second_link_ = second_link;
  problem.first_length_ = std::hypot(first_link.c, first_link.s);
  problem.second_length_ = std::hypot(second_link.c, second_link.s);
  problem.length_ = length;
  if (std::min(problem.first_length_, problem.second_length_) <= kStructureLengthTolerance * length)
    return std::nullopt;
  const Turn bend = second_link * first_link.inverse();
  problem.bend_ = normalized(bend);
  return problem;
}

void PlanarProblem::solve(double x, double y, const Turn& heading, double error, double preferred,
                          PlanarSolutions& solutions) const {
  solutions.count = 0;
  const double distance = std::sqrt(x * x + y * y);
  const double beyond = most() - distance;
  const double within = distance - least();
  const double exact = kNoSlack * length_;
  const double slack = std::min(beyond, within);
  if (slack < -(exact + error)) return;
  const bool free = distance <= exact && least() <= exact;
  const bool one = free || slack <= exact;
  const double product = 2.0 * first_length_ * second_length_;
  // Both factors as products of sums: near a straight or folded elbow their digits are kept.
  const double sine = one ? 0.0 : std::sqrt(beyond * (most() + distance) * within * (distance + least())) / product;
  const double middle = distance * distance - first_length_ * first_length_ - second_length_ * second_length_;
  const double cosine = one ? std::copysign(1.0, middle) : middle / product;
  const Turn place{x, y};
  for (int sign : {1, -1}) {
    if (one && sign < 0) break;
    PlanarSolution solution;
    solution.sign = one ? 0 : sign;
    solution.free = free;
    solution.clamped = slack < -exact;
    const Turn elbow = normalized({cosine, sign * sine}) * bend_.inverse();
    const Turn second_link = second_link_ * elbow;
    const Turn reach{first_link_.c + second_link.c, first_link_.s + second_link.s};
    const Turn first = place * reach.inverse();
    const bool undirected = free || (first.c == 0.0 && first.s == 0.0);
    solution.turns[0] = undirected ? turnBy(preferred) : normalized(first);
    solution.turns[1] = elbow;
    solution.turns[2] = heading * (solution.turns[0] * elbow).inverse();
    solutions.solutions[static_cast<std::size_t>(solutions.count++)] = solution;
  }
}

}  // namespace screwline
