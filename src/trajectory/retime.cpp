#include "screwline/trajectory/retime.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retime_grid.h"
#include "retime_jerk.h"
#include "screwline/exception.h"
#include "screwline/trajectory/format.h"

namespace screwline {
namespace {

/// [per s] A rate beyond this is bounded by nothing; [s] a duration beyond it is none.
constexpr double kUnbounded = 1e90;

[[noreturn]] void refuse(const std::string& message) {
  throw InputError(AnswerCode::kInvalidGoal, message);
}

void validate(const JointPath& path, const Limits& limits, const RetimeOptions& options) {
  if (path.joints() == 0) refuse("the path has no joints");
  validateLimits(limits, path.joints());
  if (options.grid_points < 0 || options.grid_points > 1000000)
    refuse("grid_points is " + std::to_string(options.grid_points) + ", it must lie in [0, 1000000]");
  for (double rate : {options.start_rate, options.end_rate}) {
    if (!(rate >= 0.0) || !std::isfinite(rate))
      refuse("a rate at an end is " + number(rate) + ", it must be at least 0");
  }
  for (int j = 0; j < path.joints(); ++j) {
    if (path.curve().extrema(j).travel > 0.0) return;
  }
  refuse("no joint moves along the path");
}

/// [point] the speeds from which the end can be reached within the limits; empty from where on (backwards) none is.
std::vector<Range> controllableSets(const RetimeGrid& grid, double end) {
  std::vector<Range> sets(grid.u.size(), Range{1.0, 0.0});
  sets.back() = {end, end};
  for (std::size_t i = grid.intervals(); i-- > 0;) {
    sets[i] = controllableSpeeds(grid, i, sets[i + 1]);
    if (sets[i].upper < sets[i].lower) break;
  }
  return sets;
}

/// The fastest way through the sets from x at the first point.
std::vector<double> fastestSpeeds(const RetimeGrid& grid, const std::vector<Range>& sets, double x) {
  std::vector<double> speeds{x};
  speeds.reserve(grid.u.size());
  for (std::size_t i = 0; i < grid.intervals(); ++i) {
    const RateInterval rates = feasibleRates(grid, i, sets[i + 1], x);
    const double w = rates.upper >= rates.lower ? rates.upper : 0.5 * (rates.upper + rates.lower);  // Rounding.
    x = std::min(std::max(x + 2.0 * w * grid.length(i), std::max(0.0, sets[i + 1].lower)), sets[i + 1].upper);
    speeds.push_back(x);
  }
  return speeds;
}

/// The greatest speed at the end that can be had from x at the start, stopping nowhere on purpose.
double greatestEnd(const RetimeGrid& grid, double x) {
  for (std::size_t i = 0; i < grid.intervals(); ++i) {
    const RateInterval rates = feasibleRates(grid, i, {0.0, grid.ceiling[i + 1]}, x);
    if (rates.upper < rates.lower) return 0.0;
    x = std::max(0.0, x + 2.0 * rates.upper * grid.length(i));
  }
  return x;
}

/// The slowest way through the sets, which may stop on the way.
std::vector<double> slowestSpeeds(const RetimeGrid& grid, const std::vector<Range>& sets, double x) {
  std::vector<double> speeds{x};
  speeds.reserve(grid.u.size());
  for (std::size_t i = 0; i < grid.intervals(); ++i) {
    const double w = feasibleRates(grid, i, sets[i + 1], x).lower;
    x = std::min(std::max(x + 2.0 * w * grid.length(i), std::max(0.0, sets[i + 1].lower)), sets[i + 1].upper);
    speeds.push_back(x);
  }
  return speeds;
}

/// [s] of an interval. Its ends are never both at rest, but for speeds too small for a double.
double timeOf(const RetimeGrid& grid, const std::vector<double>& rates, std::size_t interval) {
  return 2.0 * grid.length(interval) / (rates[interval] + rates[interval + 1]);
}

double durationOf(const RetimeGrid& grid, const std::vector<double>& rates) {
  double duration = 0.0;
  for (std::size_t i = 0; i < grid.intervals(); ++i) duration += timeOf(grid, rates, i);
  return duration;
}

/// The rates of a motion that takes `wanted`: between the fastest and the slowest, whose squares may be mixed since all
/// limits are linear in them.
std::vector<double> ratesFor(double wanted, const RetimeGrid& grid, const std::vector<double>& fastest,
                             const std::vector<double>& slowest) {
  std::vector<double> rates(fastest.size());
  const auto mix = [&](double share) {
    for (std::size_t i = 0; i < rates.size(); ++i)
      rates[i] = std::sqrt((1.0 - share) * fastest[i] + share * slowest[i]);
  };
  double low = 0.0;
  double high = 1.0;
  mix(high);
  if (durationOf(grid, rates) <= wanted) return rates;
  for (int k = 0; k < 60; ++k) {
    mix(0.5 * (low + high));
    (durationOf(grid, rates) < wanted ? low : high) = 0.5 * (low + high);
  }
  return rates;
}

/// d^2u/dt^2 is constant between grid points: s(tau) is a chain of parabolas.
TimeLaw parabolas(const RetimeGrid& grid, const std::vector<double>& rates) {
  std::vector<double> times{0.0};
  times.reserve(grid.u.size());
  for (std::size_t i = 0; i < grid.intervals(); ++i) times.push_back(times.back() + timeOf(grid, rates, i));
  const double duration = times.back();
  const double length = grid.u.back();
  std::vector<double> breaks;
  breaks.reserve(times.size());
  for (double t : times) breaks.push_back(t / duration);
  PiecewisePolynomial s(1, 2, std::move(breaks), 1);
  s.starts_at_rest = rates.front() == 0.0;
  s.ends_at_rest = rates.back() == 0.0;
  for (std::size_t i = 0; i < grid.intervals(); ++i) {
    const double start = rates[i] * (times[i + 1] - times[i]) / length;
    s.setPiece(i, 0, {{grid.u[i] / length, start, grid.length(i) / length - start}});
  }
  return TimeLaw(std::move(s));
}

}  // namespace

RetimeResult retime(const JointPath& path, const Limits& limits, const RetimeOptions& options) {
  validate(path, limits, options);
  if (options.hold_jerk) return retimeWithJerk(path, limits, options);
  const RetimeGrid grid = makeGrid(path, limits, options);
  RetimeResult result;
  result.start_rate = options.start_rate;
  result.end_rate = options.end_rate;
  const double start = options.start_rate * options.start_rate;
  const double end = options.end_rate * options.end_rate;
  if (end > grid.ceiling.back()) {
    result.status = RetimeStatus::kEndTooFast;
    result.end_rate = std::sqrt(grid.ceiling.back());
    return result;
  }
  const std::vector<Range> sets = controllableSets(grid, end);
  if (start > sets.front().upper || sets.front().upper < sets.front().lower) {
    result.status = RetimeStatus::kStartTooFast;
    result.start_rate = std::sqrt(std::max(0.0, sets.front().upper));
    return result;
  }
  if (start < sets.front().lower) {
    result.status = RetimeStatus::kEndTooFast;
    result.end_rate = std::sqrt(std::min(end, greatestEnd(grid, start)));
    return result;
  }
  const std::vector<double> fastest = fastestSpeeds(grid, sets, start);
  std::vector<double> rates = fastest;
  for (double& rate : rates) rate = std::sqrt(rate);
  if (options.duration > durationOf(grid, rates)) {
    rates = ratesFor(options.duration, grid, fastest, slowestSpeeds(grid, sets, start));
  }
  if (*std::max_element(rates.begin(), rates.end()) > kUnbounded) refuse("no finite limit bounds the motion");
  result.duration = durationOf(grid, rates);
  if (!(result.duration < kUnbounded)) {
    throw InputError(AnswerCode::kLimitsInfeasible, "the limits leave the path no finite duration");
  }
  result.law = parabolas(grid, rates);
  for (std::size_t i = 0; i < rates.size(); ++i)
    result.points.push_back({grid.u[i], rates[i], std::sqrt(grid.ceiling[i])});
  return result;
}

}  // namespace screwline
