#include "retime_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace screwline {
namespace {

constexpr int kDefaultIntervals = 1000;
constexpr int kLeastPerSegment = 4;  // Two turns of the path need a speed between them.
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Of the largest |q'| of a joint: a coefficient of w below it counts as that, so that nothing is divided by zero. What
/// it adds to an acceleration is rounding.
constexpr double kTiny = 1e-13;

/// The control points of q' and q'' w.r.t. s in [0, 1] on one grid interval, all joints at once, as [point][joint].
class IntervalShape {
 public:
  IntervalShape(const JointPath& path)
      : joints_(static_cast<std::size_t>(path.joints())),
        powers_(static_cast<std::size_t>(path.curve().degree) + 1),
        points_(std::max<std::size_t>(1, powers_ - 1)),
        position_(powers_ * joints_),
        by_rate_(points_ * joints_),
        by_speed_(points_ * joints_),
        slope_(points_ * joints_) {
    double binomial = 1.0;
    for (std::size_t k = 0; k < points_; ++k) {
      inverse_binomials_.push_back(1.0 / binomial);
      binomial *= static_cast<double>(points_ - 1 - k) / static_cast<double>(k + 1);
    }
  }

  std::size_t points() const { return points_; }

  /// @param x0, width: the interval in the segment's own [0, 1].
  void set(const SegmentCoefficients& segment, double x0, double width) {
    expand(segment, x0, width);
    for (std::size_t m = 0; m < points_; ++m) {
      const double k = static_cast<double>(m) + 1.0;  // The term of s^m is that of k in the position.
      const bool has_first = m + 1 < powers_;
      const bool has_second = m + 2 < powers_;
      for (std::size_t j = 0; j < joints_; ++j) {
        const double first = has_first ? k * position_[(m + 1) * joints_ + j] : 0.0;
        const double second = has_second ? k * (k + 1.0) * position_[(m + 2) * joints_ + j] : 0.0;
        slope_[m * joints_ + j] = first * inverse_binomials_[m];
        by_rate_[m * joints_ + j] = (2.0 * k - 1.0) * first * inverse_binomials_[m];
        by_speed_[m * joints_ + j] = second * inverse_binomials_[m];
      }
    }
    for (auto* values : {&slope_, &by_rate_, &by_speed_}) toBernstein(*values);
  }

  double slope(std::size_t point, std::size_t joint) const { return slope_[point * joints_ + joint]; }  ///< dq/ds
  double byRate(std::size_t point, std::size_t joint) const {
    return by_rate_[point * joints_ + joint];
  }  ///< q' + 2 s q''
  double bySpeed(std::size_t point, std::size_t joint) const { return by_speed_[point * joints_ + joint]; }  ///< q''

 private:
  /// Taylor's expansion of the position about x0, in s: repeated synthetic division.
  void expand(const SegmentCoefficients& segment, double x0, double width) {
    std::copy_n(segment.c, powers_ * joints_, position_.begin());
    for (std::size_t i = 0; i + 1 < powers_; ++i) {
      for (std::size_t k = powers_ - 1; k > i; --k) {
        for (std::size_t j = 0; j < joints_; ++j) position_[(k - 1) * joints_ + j] += x0 * position_[k * joints_ + j];
      }
    }
    double scale = 1.0;
    for (std::size_t k = 1; k < powers_; ++k) {
      scale *= width;
      for (std::size_t j = 0; j < joints_; ++j) position_[k * joints_ + j] *= scale;
    }
  }

  /// From powers over binomials to control points.
  void toBernstein(std::vector<double>& values) const {
    for (std::size_t pass = 1; pass < points_; ++pass) {
      for (std::size_t i = points_ - 1; i >= pass; --i) {
        for (std::size_t j = 0; j < joints_; ++j) values[i * joints_ + j] += values[(i - 1) * joints_ + j];
      }
    }
  }

  std::size_t joints_, powers_, points_;
  std::vector<double> position_, by_rate_, by_speed_, slope_;
  std::vector<double> inverse_binomials_;
};

std::vector<double> gridPoints(const JointPath& path, int wanted) {
  const int segments = static_cast<int>(path.breaks().size()) - 1;
  const int intervals = wanted > 0 ? wanted : kDefaultIntervals;
  const int each = std::max(kLeastPerSegment, (intervals + segments - 1) / segments);
  std::vector<double> u{0.0};
  u.reserve(static_cast<std::size_t>(each) * static_cast<std::size_t>(segments) + 1);
  for (std::size_t k = 1; k < path.breaks().size(); ++k) {
    const double from = path.breaks()[k - 1];
    const double step = (path.breaks()[k] - from) / each;
    for (int i = 1; i < each; ++i) u.push_back(from + i * step);
    u.push_back(path.breaks()[k]);
  }
  return u;
}

/// Ceilings of x at both ends of an interval from one joint's velocity limit. With p the control points of |q'| and p0
/// any positive number, v^2 / p^2 >= (v / p0)^2 (3 - 2 p / p0): below that line x(u) is low enough everywhere.
Range velocityCeilings(const IntervalShape& shape, std::size_t joint, double limit) {
  const std::size_t last = shape.points() - 1;
  double largest = 0.0;
  for (std::size_t k = 0; k <= last; ++k) largest = std::max(largest, std::abs(shape.slope(k, joint)));
  if (!(largest > 0.0) || !(limit < kInfinity)) return {kInfinity, kInfinity};
  const double middle = 0.5 * (std::abs(shape.slope(0, joint)) + std::abs(shape.slope(last, joint)));
  const double p0 = std::max(middle, 0.75 * largest);
  const double f = limit / p0 * (limit / p0);
  const auto bound = [&](std::size_t k) { return f * (3.0 - 2.0 * std::abs(shape.slope(k, joint)) / p0); };
  Range ends{bound(0), bound(last)};
  double excess = 0.0;
  for (std::size_t k = 1; k < last; ++k) {
    const double along = static_cast<double>(k) / static_cast<double>(last);
    excess = std::max(excess, (1.0 - along) * ends.lower + along * ends.upper - bound(k));
  }
  return {std::max(0.0, ends.lower - excess), std::max(0.0, ends.upper - excess)};
}

/// For each joint the size below which a coefficient of w is rounding.
VectorX leastCoefficients(const JointPath& path) {
  VectorX least(path.joints());
  for (int j = 0; j < path.joints(); ++j) least[j] = kTiny * path.curve().extrema(j).velocity + 1e-290;
  return least;
}

}  // namespace

RetimeGrid makeGrid(const JointPath& path, const Limits& limits, const RetimeOptions& options) {
  RetimeGrid grid;
  grid.u = gridPoints(path, options.grid_points);
  IntervalShape shape(path);
  const std::size_t joints = static_cast<std::size_t>(path.joints());
  const std::size_t rows = (shape.points() * joints + 3) / 4 * 4;
  grid.rows = static_cast<int>(rows);
  grid.slope.assign(grid.intervals() * rows, 0.0);
  grid.reach.assign(grid.intervals() * rows, kInfinity);
  grid.ceiling.assign(grid.u.size(), kInfinity);
  const VectorX least = leastCoefficients(path);
  std::size_t segment = 0;
  for (std::size_t i = 0; i < grid.intervals(); ++i) {
    const double step = grid.length(i);
    if (grid.u[i] >= path.breaks()[segment + 1]) {
      ++segment;
      if (path.turnsAt(segment)) grid.ceiling[i] = 0.0;
    }
    const double r = path.inverseLength(segment);
    shape.set(path.segment(segment), (grid.u[i] - path.breaks()[segment]) * r, step * r);
    double* slope = grid.slope.data() + i * rows;
    double* reach = grid.reach.data() + i * rows;
    const double bound = options.rate_bound ? options.rate_bound(grid.u[i], grid.u[i + 1]) : kInfinity;
    Range ceilings{bound * bound, bound * bound};
    for (std::size_t j = 0; j < joints; ++j) {
      const Eigen::Index joint = static_cast<Eigen::Index>(j);
      const double floor = least[joint] * step;
      for (std::size_t k = 0; k < shape.points(); ++k, ++slope, ++reach) {
        const double by_rate = shape.byRate(k, j);
        const double inverse = 1.0 / (std::abs(by_rate) > floor ? by_rate : std::copysign(floor, by_rate));
        *slope = shape.bySpeed(k, j) / step * inverse;
        *reach = limits.acceleration[joint] * step * std::abs(inverse);
      }
      const Range velocity = velocityCeilings(shape, j, limits.velocity[joint] * step);
      ceilings = {std::min(ceilings.lower, velocity.lower), std::min(ceilings.upper, velocity.upper)};
    }
    grid.ceiling[i] = std::min(grid.ceiling[i], ceilings.lower);
    grid.ceiling[i + 1] = ceilings.upper;
  }
  return grid;
}

}  // namespace screwline
