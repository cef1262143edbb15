#include "screwline/trajectory/enclosure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace screwline {
namespace {

using Coefficients = std::array<double, Polynomial::kMaxDegree + 1>;

Polynomial differentiated(Polynomial polynomial, int order) {
  for (int k = 0; k < order; ++k) polynomial = polynomial.derivative();
  return polynomial;
}

/// Coefficients of p(from + length w) in w: repeated synthetic division, then powers of the length.
Coefficients substituted(const Polynomial& p, int degree, double from, double length) {
  Coefficients c = p.c;
  for (int k = 0; k < degree; ++k) {
    for (int i = degree - 1; i >= k; --i) c[static_cast<std::size_t>(i)] += from * c[static_cast<std::size_t>(i) + 1];
  }
  double power = 1.0;
  for (int k = 0; k <= degree; ++k, power *= length) c[static_cast<std::size_t>(k)] *= power;
  return c;
}

/// Range of sin over [from, to] in radians.
Range sineOver(double from, double to) {
  Range range{std::min(std::sin(from), std::sin(to)), std::max(std::sin(from), std::sin(to))};
  const auto holds = [&](double crest) { return crest + kTwoPi * std::ceil((from - crest) / kTwoPi) <= to; };
  if (holds(0.5 * kPi)) range.upper = 1.0;
  if (holds(-0.5 * kPi)) range.lower = -1.0;
  return range;
}

Range times(double factor, const Range& range) {
  const double ends[] = {factor * range.lower, factor * range.upper};
  return {std::min(ends[0], ends[1]), std::max(ends[0], ends[1])};
}

/// The order-th derivative of sin(omega t + phase), times an amplitude.
Range sinusoidOver(double amplitude, double omega, double phase, int order, double from, double to) {
  const double angles[] = {omega * from + phase, omega * to + phase};
  const double turn = 0.5 * kPi * order;
  const Range sine = sineOver(std::min(angles[0], angles[1]) + turn, std::max(angles[0], angles[1]) + turn);
  return times(amplitude * std::pow(omega, order), sine);
}

/// Of the pieces that have more than an end in common with [from, to]; where `from` is `to`, of the one that holds it.
Range piecesOver(const PiecewisePolynomial& pieces, int joint, int order, double from, double to) {
  const auto& breaks = pieces.breaks;
  std::optional<Range> range;
  for (std::size_t k = pieces.segmentAt(from); k < pieces.segments(); ++k) {
    if (range && breaks[k] >= to) break;
    const double length = pieces.length(k);
    if (length <= kNoTime && order > 0) continue;
    const double r = length > kNoTime ? 1.0 / length : 0.0;
    const double low = std::min(std::max((from - breaks[k]) * r, 0.0), 1.0);
    const double high = std::min(std::max((to - breaks[k]) * r, low), 1.0);
    const Range part = times(std::pow(r, order), enclosure(differentiated(pieces.piece(k, joint), order), low, high));
    range = range ? hull(*range, part) : part;
  }
  return range.value_or(Range{});
}

/// s of a scaling over [from, to] within [0, 1].
Range scalingOver(const TimeLaw& scaling, int order, double from, double to) {
  if (!scaling.isCycloidal()) return piecesOver(scaling.pieces(), 0, order, from, to);
  if (order == 0) return {scaling.at(from).s, scaling.at(to).s};
  const Range wave = sinusoidOver(-1.0 / kTwoPi, kTwoPi, 0.0, order, from, to);
  return order == 1 ? Range{1.0 + wave.lower, 1.0 + wave.upper} : wave;
}

Range shifted(const Range& range, double by) {
  return {range.lower + by, range.upper + by};
}

/// Along a path the composed polynomials are not kept, but their extrema are.
Range alongPath(const JointExtrema& extrema, int order) {
  if (order == 0) return extrema.position;
  const double peak = order == 1 ? extrema.velocity : order == 2 ? extrema.acceleration : extrema.jerk;
  return {-peak, peak};
}

Range inside(const JointTrajectory& trajectory, int joint, int order, double from, double to) {
  if (trajectory.path() != nullptr) return alongPath(trajectory.extrema(joint), order);
  if (const PiecewisePolynomial* pieces = trajectory.pieces()) {
    return pieces->segments() > 0 ? piecesOver(*pieces, joint, order, from, to) : Range{};
  }
  if (const Sinusoid* motion = trajectory.sinusoid()) {
    const Range wave =
        sinusoidOver(motion->amplitude[joint], motion->omega[joint], motion->phase[joint], order, from, to);
    return order == 0 ? shifted(wave, motion->offset[joint]) : wave;
  }
  const double r = trajectory.duration() > kNoTime ? 1.0 / trajectory.duration() : 0.0;
  const double low = std::min(from * r, 1.0);
  const double high = to >= trajectory.duration() ? (r > 0.0 ? 1.0 : 0.0) : to * r;
  const Range s = scalingOver(*trajectory.scaling(), order, low, std::max(low, high));
  const Range moved = times(trajectory.delta()[joint] * std::pow(r, order), s);
  return order == 0 ? shifted(moved, trajectory.start()[joint]) : moved;
}

}  // namespace

Range hull(const Range& a, const Range& b) {
  return {std::min(a.lower, b.lower), std::max(a.upper, b.upper)};
}

Range enclosure(const Polynomial& polynomial, double from, double to) {
  const int degree = polynomial.degree();
  const Coefficients c = substituted(polynomial, degree, from, to - from);
  // Bernstein coefficient i is the sum over j <= i of C(i, j) / C(degree, j) c_j.
  Range range{c[0], c[0]};
  for (int i = 1; i <= degree; ++i) {
    double sum = 0.0;
    double weight = 1.0;
    for (int j = 0; j <= i; ++j) {
      sum += weight * c[static_cast<std::size_t>(j)];
      if (j < i) weight *= double(i - j) / double(degree - j);
    }
    range = hull(range, {sum, sum});
  }
  return range;
}

Range enclosure(const JointTrajectory& trajectory, int joint, int order, double from, double to) {
  const double duration = trajectory.duration();
  const double low = std::min(std::max(from, 0.0), duration);
  const double high = std::min(std::max(to, low), duration);
  const Range range = inside(trajectory, joint, order, low, high);
  const bool held = from < 0.0 || to > duration;
  return held && order > 0 ? hull(range, {0.0, 0.0}) : range;
}

}  // namespace screwline
