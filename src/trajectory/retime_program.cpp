// The linear program of one grid interval: two variables, x = (du/dt)^2 and w = d^2u/dt^2.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "retime_grid.h"

namespace screwline {
namespace {

using Four = double __attribute__((vector_size(32)));

constexpr double kRounding = 1e-14;

/// w = offset - slope x: the row that binds.
struct Line {
  double value = 0.0;
  double slope = 0.0;
  double offset = 0.0;
};

struct Binding {
  Line lower;
  Line upper;

  double gap() const { return upper.value - lower.value; }
  double rounding() const { return kRounding * (std::abs(upper.value) + std::abs(lower.value)); }
  /// The x at which the two lines meet.
  double meet() const { return (upper.offset - lower.offset) / (upper.slope - lower.slope); }
};

/// The rows that bind at x, four at a time.
Binding bindingRows(const RetimeGrid& grid, std::size_t interval, double x) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::size_t rows = static_cast<std::size_t>(grid.rows);
  const double* slopes = grid.slope.data() + interval * rows;
  const double* reaches = grid.reach.data() + interval * rows;
  Four lower{-kInfinity, -kInfinity, -kInfinity, -kInfinity};
  Four upper = -lower;
  Four lower_slope{}, lower_reach{}, upper_slope{}, upper_reach{};
  for (std::size_t row = 0; row < rows; row += 4) {
    Four slope, reach;
    std::memcpy(&slope, slopes + row, sizeof(slope));
    std::memcpy(&reach, reaches + row, sizeof(reach));
    const Four shift = slope * x;
    const Four low = -reach - shift;
    const Four high = reach - shift;
    lower_slope = low > lower ? slope : lower_slope;
    lower_reach = low > lower ? reach : lower_reach;
    lower = low > lower ? low : lower;
    upper_slope = high < upper ? slope : upper_slope;
    upper_reach = high < upper ? reach : upper_reach;
    upper = high < upper ? high : upper;
  }
  Binding binding{{lower[0], lower_slope[0], -lower_reach[0]}, {upper[0], upper_slope[0], upper_reach[0]}};
  for (int k = 1; k < 4; ++k) {
    if (lower[k] > binding.lower.value) binding.lower = {lower[k], lower_slope[k], -lower_reach[k]};
    if (upper[k] < binding.upper.value) binding.upper = {upper[k], upper_slope[k], upper_reach[k]};
  }
  return binding;
}

/// The same, with the end of the interval in `next`: next.lower <= x + 2 w step <= next.upper.
Binding bindingAt(const RetimeGrid& grid, std::size_t interval, const Range& next, double x) {
  Binding binding = bindingRows(grid, interval, x);
  const double r = 0.5 / grid.length(interval);
  const double least = (next.lower - x) * r;
  const double most = (next.upper - x) * r;
  if (least > binding.lower.value) binding.lower = {least, r, next.lower * r};
  if (most < binding.upper.value) binding.upper = {most, r, next.upper * r};
  return binding;
}

constexpr int kMostSteps = 200;

}  // namespace

RateInterval feasibleRates(const RetimeGrid& grid, std::size_t interval, const Range& next, double x) {
  const Binding binding = bindingAt(grid, interval, next, x);
  return {binding.lower.value, binding.upper.value};
}

Range controllableSpeeds(const RetimeGrid& grid, std::size_t interval, const Range& next) {
  constexpr Range kNone{1.0, 0.0};
  constexpr double kLargest = 1e200;
  // From above: where the gap is negative its slope has to be too, or no smaller x helps.
  double x = std::min(grid.ceiling[interval], kLargest);
  for (int step = 0; step < kMostSteps; ++step) {
    const Binding binding = bindingAt(grid, interval, next, x);
    if (binding.gap() >= -binding.rounding()) break;
    if (!(binding.upper.slope > binding.lower.slope)) return kNone;
    const double nearer = binding.meet();
    if (!(nearer < x)) break;
    if (nearer < 0.0) return kNone;
    x = nearer;
  }
  const double most = x;
  if (next.lower <= 0.0) return {0.0, most};  // At rest it may stay.
  x = 0.0;
  for (int step = 0; step < kMostSteps; ++step) {
    const Binding binding = bindingAt(grid, interval, next, x);
    if (binding.gap() >= -binding.rounding()) break;
    if (!(binding.upper.slope < binding.lower.slope)) return kNone;
    const double nearer = binding.meet();
    if (!(nearer > x)) break;
    if (nearer > most * (1.0 + kRounding)) return kNone;
    x = nearer;
  }
  return {std::min(x, most), most};
}

}  // namespace screwline
