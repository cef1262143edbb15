// What the program is made of, and what is measured on it; the steps are in dilation.cpp.
#include "dilation_program.h"

#include <cmath>
#include <limits>

namespace screwline {

DilationProgram::DilationProgram(const Dilation& problem)
    : joints_(problem.joints),
      cells_(problem.cells),
      step_(problem.step),
      points_(problem.cells + 3, 0.0),
      change_(problem.cells + 3, 0.0),
      fixed_(problem.cells + 3, false),
      nodes_(problem.cells + 1),
      rows_((problem.cells + 1) * kKinds * problem.joints),
      matrix_(problem.cells + 3) {
  for (std::size_t i = 0; i <= cells_; ++i) {
    nodes_[i].bounded = std::isfinite(problem.ceiling[i]);
    if (nodes_[i].bounded) nodes_[i].ceiling = problem.ceiling[i];
  }
  fixed_.back() = true;                          // Beyond the last: there so that every node has three points.
  fixed_[0] = fixed_[problem.cells + 1] = true;  // Tied to their neighbours.
  ends_ = {End{1, 0, problem.first}, End{cells_, cells_, problem.last}};
  fillRows(problem);
  placeStart();
}

void DilationProgram::fillRows(const Dilation& problem) {
  const double h = step_;
  for (std::size_t i = 0; i <= cells_; ++i) {
    for (std::size_t j = 0; j < joints_; ++j) {
      const std::size_t k = i * joints_ + j;
      const double bend = 0.5 * problem.second_by_accel[k];
      const double rate = problem.first_by_accel[k] / (2.0 * h);
      row(i, 0, j) = {{bend - rate, bend + rate, 0.0}};
      for (std::size_t end = 0; end < 2 && i < cells_; ++end) {
        const double third = 0.5 * problem.third_by_jerk[(2 * i + end) * joints_ + j];
        const double second = 1.5 * problem.second_by_jerk[k + end * joints_] / h;
        const double first = problem.first_by_jerk[k + end * joints_] / (2.0 * h * h);
        DilationRow& r = row(i, 1 + end, j);
        r = {{first, -2.0 * first, first}};
        r.c[end] += third - second;
        r.c[end + 1] += third + second;
      }
    }
  }
}

/// One r for all: the greatest that keeps some distance to the limits and to given ends.
void DilationProgram::placeStart() {
  constexpr double kDistance = 0.8;
  double r = std::numeric_limits<double>::infinity();
  for (const Node& node : nodes_) {
    if (node.bounded) r = std::min(r, node.ceiling);
  }
  double largest = 0.0;
  double largest_jerk = 0.0;
  eachRow([&](std::size_t, std::size_t kind, DilationRow& each) {
    const double at_one = std::abs(each.c[0] + each.c[1] + each.c[2]);
    (kind == 0 ? largest : largest_jerk) = std::max(kind == 0 ? largest : largest_jerk, at_one);
  });
  if (largest > 0.0) r = std::min(r, 1.0 / largest);
  if (largest_jerk > 0.0) r = std::min(r, std::pow(largest_jerk, -2.0 / 3.0));
  r *= kDistance;
  for (const End& end : ends_) {
    if (end.wanted) r = std::min(r, kDistance * *end.wanted);
  }
  std::fill(points_.begin(), points_.end(), r);
}

DilationTop DilationProgram::topOf(const double* b, std::size_t kind) const {
  if (kind == 0) return {1.0, 0.0, 0};
  const std::size_t first = kind - 1;
  const double r = 0.5 * (b[first] + b[first + 1]);
  const double root = 1.0 / std::sqrt(r);
  return {root, -0.25 * root / r, first};
}

void DilationProgram::startMultipliers(double each_product) {
  eachSlack([&](double slack, double, double& multiplier) { multiplier = each_product / slack; });
}

/// The mean product of a slack and its multiplier.
double DilationProgram::complementarity() {
  double sum = 0.0;
  double count = 0.0;
  eachSlack([&](double slack, double, double& multiplier) {
    sum += multiplier * slack;
    count += 1.0;
  });
  return sum / count;
}

double DilationProgram::duration() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < cells_; ++i) sum += step_ / std::sqrt(points_[i + 1]);
  return sum;
}

}  // namespace screwline
