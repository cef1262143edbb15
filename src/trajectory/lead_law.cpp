#include "lead_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace screwline {
namespace {

/// du/dt at equal steps over the whole motion, the ends' rates `before` cells before and after it.
std::vector<double> ratesOf(const RetimeResult& timed, double length, int cells, int around) {
  std::vector<double> rates(static_cast<std::size_t>(around), timed.start_rate);
  for (int k = 0; k <= cells; ++k) {
    const double rate = timed.law.at(static_cast<double>(k) / cells).ds * length / timed.duration;
    rates.push_back(k == 0 ? timed.start_rate : k == cells ? timed.end_rate : std::max(0.0, rate));
  }
  rates.insert(rates.end(), static_cast<std::size_t>(around), timed.end_rate);
  return rates;
}

/// Half of a law, from one end up to `nodes` nodes: sums of positive terms, so that small values near the end are
/// exact.
void sumFromEnd(const std::vector<double>& rates, std::size_t width, double step, std::size_t nodes,
                std::vector<double>& u, std::vector<double>& rate) {
  const double share = 1.0 / static_cast<double>(width);
  double way = 0.0;
  for (std::size_t k = 0; k < nodes; ++k) {
    double sum = 0.0;
    for (std::size_t m = k; m < k + width; ++m) sum += 0.5 * (rates[m] + rates[m + 1]);
    const double now = sum * share;
    if (k > 0) {
      // Acceleration is linear over a cell, from the differences over the window.
      const double before = (rates[k - 1 + width] - rates[k - 1]) * share / step;
      const double after = (rates[k + width] - rates[k]) * share / step;
      way += 0.5 * step * (rate[k - 1] + now) + step * step * (before - after) / 12.0;
    }
    u.push_back(way);
    rate.push_back(now);
  }
}

}  // namespace

LeadLaw leadLaw(const RetimeResult& timed, double length, double ramp, int cells) {
  const double share = ramp / (timed.duration + ramp);
  const int width = std::min(std::max(2, static_cast<int>(std::lround(share * cells))), cells / 2);
  const int moving = cells - width;
  LeadLaw law;
  law.step = timed.duration / moving;
  std::vector<double> rates = ratesOf(timed, length, moving, width);
  const std::size_t window = static_cast<std::size_t>(width);
  const std::size_t nodes = static_cast<std::size_t>(cells) + 1;
  const std::size_t middle = nodes / 2;
  sumFromEnd(rates, window, law.step, middle, law.u, law.rate);
  std::vector<double> mirrored(rates.rbegin(), rates.rend());
  std::vector<double> u_left, rate_left;
  sumFromEnd(mirrored, window, law.step, nodes - middle, u_left, rate_left);
  // The halves join: what is between them is one cell.
  const auto changeAt = [&](std::size_t k) {
    return (rates[k + window] - rates[k]) / (ramp > 0.0 ? law.step * width : 1.0);
  };
  const double gap = 0.5 * law.step * (law.rate.back() + rate_left.back()) +
                     law.step * law.step * (changeAt(middle - 1) - changeAt(middle)) / 12.0;
  const double whole = law.u.back() + gap + u_left.back();
  const double factor = length / whole;
  for (std::size_t k = nodes - middle; k-- > 0;) {
    law.u.push_back(whole - u_left[k]);
    law.rate.push_back(rate_left[k]);
  }
  for (std::size_t k = 0; k < nodes; ++k) {
    law.u[k] *= factor;
    law.rate[k] *= factor;
    law.change.push_back(changeAt(k) * factor);
  }
  law.u.back() = length;
  return law;
}

RateBound steadyRate(const JointPath& path, const Limits& limits, const RateBound& asked) {
  return [&path, &limits, &asked](double from, double to) {
    const Eigen::Index n = path.joints();
    VectorX q(n), first(n), second(n), third(n);
    double rate = asked ? asked(from, to) : std::numeric_limits<double>::infinity();
    for (const double share : {0.001, 0.5, 0.999}) {  // Beside the breakpoints, where it steps.
      path.at(from + share * (to - from), q.data(), first.data(), second.data(), third.data());
      rate = std::min(rate, std::cbrt(1.0 / (third.array().abs() / limits.jerk.array()).maxCoeff()));
    }
    return rate;
  };
}

}  // namespace screwline
