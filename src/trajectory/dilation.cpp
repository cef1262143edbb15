#include "dilation_program.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace screwline {
namespace {

constexpr int kMostSteps = 100;
constexpr double kGap = 2e-6;         ///< Of the duration: what is left to gain.
constexpr double kToBoundary = 0.95;  ///< Of the way to the nearest limit that a step may take.
constexpr double kLeastShare = 0.3;   ///< Of r that a step leaves.

}  // namespace

/// The rows of one kind at one node into the matrix and the right side. With the tops' derivative d and the sums over
/// the joints, the two sides of a row give (d -+ c)(d -+ c)^T each.
void DilationProgram::addRows(std::size_t node, std::size_t kind, double target) {
  const double* b = at(node);
  const DilationTop top = topOf(b, kind);
  double cc[6] = {}, wc[3] = {}, tc[3] = {};
  double weight = 0.0;
  double pull = 0.0;
  for (std::size_t j = 0; j < joints_; ++j) {
    const DilationRow& r = row(node, kind, j);
    const double value = valueOf(r, b);
    const double above = 1.0 / (top.value - value);
    const double below = 1.0 / (top.value + value);
    const double w = r.above * above + r.below * below;
    const double difference = r.below * below - r.above * above;
    const double t = below - above;
    weight += w;
    pull += above + below;
    for (int k = 0; k < 3; ++k) {
      wc[k] += difference * r.c[k];
      tc[k] += t * r.c[k];
    }
    cc[0] += w * r.c[0] * r.c[0];
    cc[1] += w * r.c[0] * r.c[1];
    cc[2] += w * r.c[0] * r.c[2];
    cc[3] += w * r.c[1] * r.c[1];
    cc[4] += w * r.c[1] * r.c[2];
    cc[5] += w * r.c[2] * r.c[2];
  }
  double d[3] = {};
  d[top.first] = top.slope;
  d[top.first + 1] = top.slope;
  int entry = 0;
  for (std::size_t p = 0; p < 3; ++p) {
    change_[node + p] += target * (pull * d[p] + tc[p]);
    for (std::size_t q = p; q < 3; ++q, ++entry) {
      matrix_.at(node + p, q - p) += cc[entry] + weight * d[p] * d[q] + wc[q] * d[p] + wc[p] * d[q];
    }
  }
}

/// Matrix and right side of the step towards products of `target`.
void DilationProgram::assemble(double target) {
  matrix_.clear();
  std::fill(change_.begin(), change_.end(), 0.0);
  for (std::size_t i = 0; i <= cells_; ++i) {
    const Node& node = nodes_[i];
    if (node.bounded && node.free) {
      const double slack = 1.0 - 0.5 * (at(i)[0] + at(i)[1]) / node.ceiling;
      const double d = -0.5 / node.ceiling;
      const double w = node.multiplier / slack * d * d;
      matrix_.at(i, 0) += w;
      matrix_.at(i, 1) += w;
      matrix_.at(i + 1, 0) += w;
      change_[i] += target / slack * d;
      change_[i + 1] += target / slack * d;
    }
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
      if (holds(i, kind)) addRows(i, kind, target);
    }
    if (i == cells_) break;
    const double b = points_[i + 1];
    const double slope = step_ / (b * std::sqrt(b));
    change_[i + 1] += 0.5 * slope;
    matrix_.at(i + 1, 0) += 0.75 * slope / b;
  }
  if (isReaching()) addReach();
  tieEnds();
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (!fixed_[k]) continue;
    matrix_.fix(k);
    change_[k] = 0.0;
  }
}

/// Before given ends are met, to come nearer to them is what is sought, a hundred times before time.
void DilationProgram::addReach() {
  const double weight = 100.0 * duration();
  for (const End& end : ends_) {
    if (end.wanted && !end.met) change_[end.point] += weight / *end.wanted;
  }
}

/// As much of a step as leads no given end past its value.
double DilationProgram::untilMet(double along) const {
  for (const End& end : ends_) {
    const double by = change_[end.point];
    if (end.wanted && !end.met && by > 0.0) along = std::min(along, (*end.wanted - points_[end.point]) / by);
  }
  return along;
}

/// An end that has reached its value stays there.
void DilationProgram::meetEnds() {
  for (End& end : ends_) {
    if (!end.wanted || end.met || points_[end.point] < *end.wanted * (1.0 - 1e-12)) continue;
    end.met = true;
    fixed_[end.point] = true;
    nodes_[end.node].free = false;
    points_[end.point] = *end.wanted;
    points_[end.point == 1 ? 0 : cells_ + 1] = *end.wanted;
  }
}

/// r' is zero at both ends: the outermost points are the same as their neighbours, whose equations take theirs in.
void DilationProgram::tieEnds() {
  const std::size_t last = cells_ + 1;
  matrix_.at(1, 0) += matrix_.at(0, 0) + 2.0 * matrix_.at(0, 1);
  matrix_.at(1, 1) += matrix_.at(0, 2);
  matrix_.at(last - 1, 0) += matrix_.at(last, 0) + 2.0 * matrix_.at(last - 1, 1);
  matrix_.at(last - 2, 1) += matrix_.at(last - 2, 2);
  change_[1] += change_[0];
  change_[last - 1] += change_[last];
}

/// How far the points and the multipliers may go. Tops are convex, so what the tangent allows is allowed.
std::array<double, 2> DilationProgram::stepLengths(double target) {
  double primal = 1.0 / kToBoundary;
  double dual = 1.0 / kToBoundary;
  const auto take = [&](double slack, double by, double& multiplier) {
    if (by < 0.0) primal = std::min(primal, -slack / by);
    const double change = (target - multiplier * by) / slack - multiplier;
    if (change < 0.0) dual = std::min(dual, -multiplier / change);
  };
  for (std::size_t i = 0; i <= cells_; ++i) {
    const double* db = change_.data() + i;
    const double by = 0.5 * (db[0] + db[1]);
    if (by < 0.0) primal = std::min(primal, (1.0 - kLeastShare) * 0.5 * (at(i)[0] + at(i)[1]) / -by);
    if (i < cells_ && db[1] < 0.0) primal = std::min(primal, (1.0 - kLeastShare) * at(i)[1] / -db[1]);
  }
  eachSlack(take);
  return {std::min(1.0, kToBoundary * primal), std::min(1.0, kToBoundary * dual)};
}

void DilationProgram::takeStep(double target) {
  assemble(target);
  matrix_.solve(change_);
  change_[0] = change_[1];
  change_[cells_ + 1] = change_[cells_];
  const auto [primal, dual] = stepLengths(target);
  const auto move = [&, along = dual](double slack, double by, double& multiplier) {
    multiplier += along * ((target - multiplier * by) / slack - multiplier);
  };
  eachSlack(move);
  const double along = untilMet(primal);
  for (std::size_t k = 0; k < points_.size(); ++k) points_[k] += along * change_[k];
  meetEnds();
}

DilationResult DilationProgram::solve() {
  const double rows = 2.0 * static_cast<double>(rows_.size());
  startMultipliers(0.1 * (isReaching() ? 100.0 : 1.0) * duration() / rows);
  for (int step = 0; step < kMostSteps; ++step) {
    const bool reaches = isReaching();
    const double product = complementarity();
    if (product * rows < (reaches ? 1e-2 : kGap) * duration()) break;
    takeStep(0.2 * product);
    if (reaches && !isReaching()) startMultipliers(0.1 * duration() / rows);
  }
  DilationResult result;
  const bool finite = std::all_of(points_.begin(), points_.end(), [](double p) { return std::isfinite(p); });
  result.found = finite && !isReaching();
  for (const End& end : ends_) {
    if (finite && end.wanted) result.reached = std::min(result.reached, std::sqrt(points_[end.point] / *end.wanted));
  }
  points_.pop_back();
  result.r.points = std::move(points_);
  return result;
}

DilationResult fastestDilation(const Dilation& problem) {
  return DilationProgram(problem).solve();
}

}  // namespace screwline
