#include "screwline/ik/closed_form/direction_problem.h"

#include <algorithm>

#include "screwline/model/structure.h"

namespace screwline {
namespace {

constexpr double kNoSlack = 1e-14;     // Of a direction's reach, where two turns meet.
constexpr double kRounding = 2e-15;    // [rad] of a direction that came through a few rotations.
constexpr double kMostInLine = 1e-13;  // What errors of the inputs may add to that.
constexpr double kInLine = 1e-14;      // Sine below which a direction counts as in line with an axis.

}  // namespace

std::optional<DirectionProblem> DirectionProblem::compile(const Vector3& first, const Vector3& second) {
  DirectionProblem problem;
  const Vector3 normal = first.cross(second);
  problem.sine_ = normal.norm();
  if (problem.sine_ <= kStructureAngleTolerance) return std::nullopt;
  problem.first_ = first;
  problem.second_ = second;
  problem.cosine_ = first.dot(second);
  problem.across_ = normal / problem.sine_;
  problem.first_side_ = problem.across_.cross(first);
  problem.second_side_ = second.cross(problem.across_);
  return problem;
}

void DirectionProblem::solve(const Vector3& start, const Vector3& goal, double error, double preferred_first,
                             double preferred_second, DirectionSolutions& solutions) const {
  solutions.count = 0;
  const double along_first = first_.dot(goal);
  const double along_second = second_.dot(start);
  const double goal_sine = first_.cross(goal).norm();
  const double start_sine = second_.cross(start).norm();
  // Between the turns the direction has these components, from its axes, to the side within the axes' plane.
  const double side_first = (along_second - cosine_ * along_first) / sine_;
  const double side_second = (along_first - cosine_ * along_second) / sine_;
  // What is left is across the plane; taken from the smaller of the two sines it keeps its digits near alignment.
  const bool by_first = goal_sine < start_sine;
  const double whole = by_first ? goal_sine : start_sine;
  const double part = std::abs(by_first ? side_first : side_second);
  const double slack = whole - part;
  const double uncertain = kNoSlack + 4.0 * error / sine_;
  if (slack < -uncertain) return;
  const bool free = whole <= kInLine + std::min(4.0 * error, kMostInLine);
  const bool one = free || slack <= kNoSlack;
  const double height = one ? 0.0 : std::sqrt(slack * (whole + part));
  // Near a double root the turns move by the square root of what moves the direction.
  const double least_height = std::max(height, std::sqrt((kNoSlack + error) * (whole + kInLine)));
  for (int sign : {1, -1}) {
    if (one && sign < 0) break;
    DirectionSolution solution;
    solution.sign = one ? 0 : sign;
    solution.first_loose = by_first;
    solution.clamped = !free && slack < -kNoSlack;
    solution.first_free = free && by_first;
    solution.second_free = free && !by_first;
    solution.error = (kRounding + error) / least_height;
    // One that stands for two is off by as much as they may be apart.
    if (one && !free) solution.error = std::max(solution.error, std::sqrt((kNoSlack + error) * (whole + part)) / whole);
    solution.tight_error = std::max(solution.error * whole, kRounding + error) / std::max(goal_sine, start_sine);
    const Vector3 high = (sign * height) * across_;
    // Across each axis: where the direction stands between the turns, and where it comes from or goes to.
    const Vector3 at_first = high + side_first * first_side_;
    const Vector3 at_second = high + side_second * second_side_;
    if (solution.first_free) {
      solution.first = turnBy(preferred_first);
    } else {
      solution.first = normalized({at_first.dot(goal), first_.dot(at_first.cross(goal))});
    }
    if (solution.second_free) {
      solution.second = turnBy(preferred_second);
    } else {
      solution.second = normalized({start.dot(at_second), second_.dot(start.cross(at_second))});
    }
    solutions.solutions[static_cast<std::size_t>(solutions.count++)] = solution;
  }
}

}  // namespace screwline
